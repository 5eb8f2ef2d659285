// Blind bench of idim refine: see README.md beside this file.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "undeclared/score_table.hpp"

namespace idim::undeclared {

namespace {

constexpr std::uint64_t first_evaluation_seed = 1000;

struct bench_options {
    tool under_test;
    std::vector<std::string> classes;
    std::uint64_t seed = 0;
    int count = 0;
    double scale = 1.0;
    bool evaluation = false, make_only = false, check = false;
    std::string keep, json_file;
    int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

struct planned_case {
    std::string class_name;
    std::uint64_t seed;
};

/// How many cases of a class make the whole bench.
int usual_count(const std::string& class_name) {
    static const std::map<std::string, int> counts = {{"nothing", 200}, {"sticking", 60}, {"near", 45},
                                                      {"outside", 30},  {"span", 24},     {"two", 40}};
    const auto found = counts.find(class_name);
    return found == counts.end() ? 15 : found->second;
}

std::vector<planned_case> planned(const bench_options& options) {
    std::vector<planned_case> plan;
    const std::uint64_t usual_first = options.evaluation ? first_evaluation_seed : 1;
    const std::uint64_t first = options.seed > 0 ? options.seed : usual_first;
    for (const std::string& name : options.classes.empty() ? case_classes() : options.classes) {
        const int usual =
            options.seed > 0 ? 1 : std::max(1, static_cast<int>(std::lround(options.scale * usual_count(name))));
        const int count = options.count > 0 ? options.count : usual;
        for (int i = 0; i < count; ++i) {
            plan.push_back({name, first + static_cast<std::uint64_t>(i)});
        }
    }
    return plan;
}

std::string folder_of(const bench_options& options, const planned_case& one) {
    const std::filesystem::path parent =
        options.keep.empty() ? std::filesystem::temp_directory_path() / fmt::format("undeclared-{}", getpid())
                             : std::filesystem::path(options.keep);
    const std::filesystem::path folder = parent / fmt::format("{}-{}", one.class_name, one.seed);
    std::filesystem::create_directories(folder);
    return folder;
}

case_result made_only(const planned_case& one, const std::string& folder) {
    case_result result;
    try {
        result.made = make_case(one.class_name, one.seed);
        write_case(result.made, folder);
        write_truth(result.made, folder);
        result.problem = "only made, in " + folder;
    } catch (const std::exception& problem) {
        result.problem = problem.what();
    }
    return result;
}

/// Cases side by side, their lines as they end; results in the order of the plan.
std::vector<case_result> run_all(const bench_options& options, const std::vector<planned_case>& plan) {
    std::vector<case_result> results(plan.size());
    std::atomic<std::size_t> next = 0;
    std::mutex printing;
    const auto work = [&] {
        for (std::size_t i = next++; i < plan.size(); i = next++) {
            const std::string folder = folder_of(options, plan[i]);
            results[i] = options.make_only ? made_only(plan[i], folder)
                                           : run_case(options.under_test, plan[i].class_name, plan[i].seed, folder);
            if (options.keep.empty()) {
                std::filesystem::remove_all(folder);
            }
            const std::lock_guard guard(printing);
            fmt::print("{}\n", line_of(results[i]));
            std::fflush(stdout);
        }
    };
    std::vector<std::thread> workers;
    for (int i = 0; i < options.jobs; ++i) {
        workers.emplace_back(work);
    }
    for (std::thread& worker : workers) {
        worker.join();
    }
    return results;
}

/// A clear word before hundreds of cases fail for one reason. The list of commands decides: help alone succeeds
/// for any word.
void check_command(const bench_options& options) {
    const std::string& command = options.under_test.command;
    const std::string list = fmt::format("'{}' --help 2>&1 | grep -q '^ *refine '", command);
    if (!options.make_only && std::system(list.c_str()) != 0) {
        throw std::runtime_error(fmt::format("{} is not there, or has no command refine yet", command));
    }
}

int run(bench_options options) {
    options.under_test.command = std::filesystem::absolute(options.under_test.command);
    check_command(options);
    for (const std::string& name : options.classes) {
        if (std::find(case_classes().begin(), case_classes().end(), name) == case_classes().end()) {
            throw std::runtime_error(fmt::format("no class {}; there are: {}", name, fmt::join(case_classes(), " ")));
        }
    }
    const std::vector<case_result> results = run_all(options, planned(options));
    if (!options.make_only) {
        fmt::print("\n{}", report_text(results));
    }
    if (!options.json_file.empty()) {
        std::ofstream(options.json_file) << report_json(results).dump(2) << '\n';
    }
    const std::vector<table_row> rows = score_table(results);
    const bool kept = std::all_of(rows.begin(), rows.end(), [](const table_row& row) { return row.kept(); });
    return options.check && !kept ? 1 : 0;
}

}  // namespace

}  // namespace idim::undeclared

int main(int argc, char** argv) {
    idim::undeclared::bench_options options;
    CLI::App app("blind bench of idim refine on simulated robots whose description lacks something");
    app.add_option("--idim", options.under_test.command, "the command under test")->required();
    app.add_option("--class", options.classes, "classes of cases; all of them if not given");
    app.add_option("--seed", options.seed, "seed of the first case of each class; one case each without --count");
    app.add_option("--count", options.count, "cases of each class");
    app.add_option("--scale", options.scale, "times the usual number of cases");
    app.add_flag("--evaluation,!--development", options.evaluation,
                 "seeds from 1000 (for figures that are reported) or from 1 (may be looked at)");
    app.add_option("--keep", options.keep, "folder in which the cases stay");
    app.add_option("--jobs", options.jobs, "cases at once")->check(CLI::PositiveNumber);
    app.add_option("--time-limit", options.under_test.time_limit, "for one run of the command [s]");
    app.add_option("--options", options.under_test.options, "further options of refine");
    app.add_option("--json", options.json_file, "results as JSON");
    app.add_flag("--check", options.check, "exit 1 where a bound is not kept");
    app.add_flag("--make-only", options.make_only, "write the cases and their truth, run nothing");
    CLI11_PARSE(app, argc, argv);
    try {
        return idim::undeclared::run(options);
    } catch (const std::exception& problem) {
        fmt::print(stderr, "undeclared_bench: {}\n", problem.what());
        return 2;
    }
}
