#include <fmt/format.h>

#include "command.hpp"
#include "generator.hpp"
#include "resources.hpp"

namespace idim::cli {

namespace {

struct base_options {
    std::string robot;
    std::string json_file;
};

json base_json(const generator::base_report& base) {
    json parameters = json::array();
    for (const auto& parameter : base.parameters) {
        parameters.push_back({{"name", parameter.name}, {"regroups", parameter.regroups}, {"unit", parameter.unit}});
    }
    return {{"robot", base.robot},
            {"parameters", parameters},
            {"rank", base.qr_rank},
            {"standard", base.standard},
            {"without_effect", base.without_effect},
            {"rank_evidence",
             {{"qr_rank", base.qr_rank},
              {"smallest_kept_pivot", base.smallest_kept_pivot},
              {"largest_dropped_pivot", base.largest_dropped_pivot},
              {"exact_rank", base.exact_rank},
              {"exact_points", base.exact_points},
              {"modulo_prime_only", base.modulo_prime_only}}}};
}

void print(const generator::base_report& base) {
    fmt::print("{}: {} base parameters of {} standard ones\n", base.robot, base.parameters.size(), base.standard);
    for (const auto& parameter : base.parameters) {
        if (parameter.name == parameter.regroups) {
            fmt::print("  {} [{}]\n", parameter.name, parameter.unit);
        } else {
            fmt::print("  {} = {} [{}]\n", parameter.name, parameter.regroups, parameter.unit);
        }
    }
    if (!base.without_effect.empty()) {
        fmt::print("without effect:");
        for (const std::string& name : base.without_effect) {
            fmt::print(" {}", name);
        }
        fmt::print("\n");
    }
    fmt::print("rank {} by QR (smallest kept pivot {:.1e}, largest dropped {:.1e}), {} {} at {} {}\n", base.qr_rank,
               base.smallest_kept_pivot, base.largest_dropped_pivot, base.exact_rank,
               base.has_loops ? "modulo a prime" : "in exact arithmetic", base.exact_points,
               base.has_loops ? "points where the loops close" : "rational points");
    if (base.modulo_prime_only > 0 && !base.has_loops) {
        fmt::print(
            "  ({} columns have coefficients that are no short formula: printed as numbers, shown modulo a prime)\n",
            base.modulo_prime_only);
    }
}

}  // namespace

void add_base_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<base_options>();
    CLI::App* command =
        app.add_subcommand("base", "base parameters and how each regroups the standard ones, in symbols");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] {
        chosen = [options]() -> int {
            const generator::base_report base = generator::find_base(options->robot, templates_folder());
            print_notes(options->robot, base.notes);
            write_json(options->json_file, base_json(base));
            if (prints_text(options->json_file)) {
                print(base);
            }
            return exit_done;
        };
    });
}

}  // namespace idim::cli
