#include "undeclared/tool_run.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace idim::undeclared {

namespace {

using nlohmann::json;

constexpr int status_of_timeout = 124;  // of timeout(1)

struct outcome {
    int status;
    double seconds;
};

outcome run(const std::string& folder, double limit, const std::string& command, const std::string& log) {
    const std::string line = fmt::format("cd '{}' && timeout {} {} > {} 2>&1", folder, limit, command, log);
    const auto start = std::chrono::steady_clock::now();
    const int status = std::system(line.c_str());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, seconds};
}

std::string last_line(const std::string& file) {
    std::ifstream text(file);
    std::string line, last;
    while (std::getline(text, line)) {
        last = line.empty() ? last : line;
    }
    return last;
}

std::string logs(const char* name, std::size_t count) {
    std::string list;
    for (std::size_t i = 1; i <= count; ++i) {
        list += fmt::format(" {}{}.csv", name, i);
    }
    return list;
}

json read_json(const std::string& file) {
    std::ifstream text(file);
    return json::parse(text);
}

/// Options that give identify the rows that refine judged by; none where it does not say which.
std::string filter_options(const std::string& refined) {
    const json filter = read_json(refined).value("filter", json());
    return filter.is_object() ? fmt::format("--cutoff {} --order {} --decimation {}", filter.at("cutoff").get<double>(),
                                            filter.at("order").get<int>(), filter.at("decimation").get<int>())
                              : "";
}

}  // namespace

finding run_refine(const tool& under_test, const bench_case& made, const std::string& folder) {
    finding result;
    const std::string command = fmt::format("'{}' refine robot.yaml{} --validation{} -o refined --json refined.json {}",
                                            under_test.command, logs("ident", made.identification.size()),
                                            logs("valid", made.validation.size()), under_test.options);
    const outcome done = run(folder, under_test.time_limit, command, "refine.log");
    result.exit_status = done.status;
    result.seconds = done.seconds;
    result.timed_out = done.status == status_of_timeout;
    if (done.status != 0) {
        result.message = last_line(folder + "/refine.log");
        return result;
    }
    try {
        read_refinement(read_json(folder + "/refined.json"), result);
    } catch (const json::exception& problem) {
        result.message = problem.what();
        result.verdict.clear();
    }
    return result;
}

model_errors true_model_errors(const tool& under_test, const bench_case& made, const std::string& folder) {
    const auto must = [&](const std::string& command, const std::string& log) {
        if (run(folder, under_test.time_limit, command, log).status != 0) {
            throw std::runtime_error(last_line(folder + "/" + log));
        }
    };
    must(fmt::format("'{}' identify robot.yaml{} {} --json twin.json", under_test.command,
                     logs("twin_ident", made.identification.size()), filter_options(folder + "/refined.json")),
         "twin_identify.log");
    must(fmt::format("'{}' validate robot.yaml twin.json{} --json twin_valid.json", under_test.command,
                     logs("twin_valid", made.validation.size())),
         "twin_validate.log");
    return errors_in(read_json(folder + "/twin_valid.json"));
}

}  // namespace idim::undeclared
