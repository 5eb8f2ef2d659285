#include "measured_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catalogue/effect_library.hpp"
#include "idim/input_error.hpp"
#include "idim/joint_space.hpp"
#include "resources.hpp"

namespace idim::cli {

compiled_model compile_files(const std::vector<generator::rendered_file>& files, const std::string& input_hash) {
    std::vector<model_source> sources;
    for (const generator::rendered_file& file : files) {
        sources.push_back({file.name, file.text});
    }
    sources.push_back(interface_header("idim/model_interface.h"));
    return compile_model(sources, input_hash);
}

loaded_robot load_robot(const std::string& robot_file) {
    generator::generated_model generated = generator::generate(robot_file, templates_folder());
    print_notes(robot_file, generated.base.notes);
    compiled_model compiled = compile_files(generated.files, generated.input_hash);
    return {std::move(generated), std::move(compiled)};
}

compiled_model load_variant(const std::string& robot_file) {
    const generator::generated_model generated = generator::generate(robot_file, templates_folder());
    return compile_files(generated.files, generated.input_hash);
}

compiled_effects load_effects(const std::string& robot_file) {
    const generator::effect_library library = generator::generate_effects(robot_file, templates_folder());
    std::vector<model_source> sources;
    for (const generator::rendered_file& file : library.files) {
        sources.push_back({file.name, file.text});
    }
    sources.push_back(interface_header("idim/effect_interface.h"));
    return compile_effects(sources);
}

log_columns columns_of(const loaded_robot& robot) {
    log_columns columns;
    for (const auto& joint : robot.generated.joints) {
        columns.joint_names.push_back(joint.name);
        columns.drive_gain.push_back(joint.drive_gain);
    }
    return columns;
}

namespace {

void check_that_loops_close(const idim_model_interface& model, const idim::log& log) {
    for (Eigen::Index k = 0; model.n_closures > 0 && k < log.samples(); ++k) {
        const Eigen::VectorXd q = log.q.row(k);
        if (!loops_close(model, q.data())) {
            throw input_error({log.file, 0, "q"},
                              fmt::format("at t = {} s the loops of {} do not close, expected positions where they do",
                                          log.t[k], model.robot));
        }
    }
}

}  // namespace

std::vector<idim::log> read_logs(const loaded_robot& robot, const std::vector<std::string>& files) {
    std::vector<idim::log> logs;
    for (const std::string& file : files) {
        logs.push_back(read_log(file, columns_of(robot)));
        check_that_loops_close(robot.model(), logs.back());
    }
    return logs;
}

std::vector<stored_log> store_logs(const loaded_robot& robot, const std::vector<std::string>& files) {
    std::vector<stored_log> logs;
    for (const std::string& file : files) {
        logs.emplace_back(file, columns_of(robot),
                          [&](const idim::log& block) { check_that_loops_close(robot.model(), block); });
    }
    return logs;
}

namespace {

/// `ranges`: of the positions in every log [n].
std::vector<std::string> joints_without(const loaded_robot& robot, const std::vector<Eigen::VectorXd>& ranges) {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < robot.generated.joints.size(); ++j) {
        const bool moves = std::any_of(ranges.begin(), ranges.end(), [&](const Eigen::VectorXd& range) {
            return range[static_cast<Eigen::Index>(j)] > 0.0;
        });
        if (!moves) {
            names.push_back(robot.generated.joints[j].name);
        }
    }
    return names;
}

}  // namespace

std::vector<std::string> joints_at_rest(const loaded_robot& robot, const std::vector<idim::log>& logs) {
    std::vector<Eigen::VectorXd> ranges;
    for (const idim::log& log : logs) {
        ranges.emplace_back(log.q.colwise().maxCoeff() - log.q.colwise().minCoeff());
    }
    return joints_without(robot, ranges);
}

std::vector<std::string> joints_at_rest(const loaded_robot& robot, const std::vector<stored_log>& logs) {
    std::vector<Eigen::VectorXd> ranges;
    for (const stored_log& log : logs) {
        ranges.push_back(log.range());
    }
    return joints_without(robot, ranges);
}

observation observe_logs(const loaded_robot& robot, const std::vector<idim::log>& logs, const filter_choice& choice,
                         const Eigen::VectorXd& chi) {
    std::vector<filtered_samples> samples;
    for (const idim::log& log : logs) {
        samples.push_back(filter_log(log, choice));
    }
    return observe(robot.model(), samples, choice, chi);
}

const generator::parameter_context& parameter_of(const loaded_robot& robot, const observation& rows,
                                                 Eigen::Index column) {
    const int parameter = column_of(rows, static_cast<int>(column)).parameter;
    return robot.generated.base.parameters[static_cast<std::size_t>(parameter)];
}

std::string name_of(const loaded_robot& robot, const observation& rows, Eigen::Index column) {
    const int log = column_of(rows, static_cast<int>(column)).log;
    return parameter_of(robot, rows, column).name + (log >= 0 ? fmt::format("@{}", log + 1) : "");
}

void add_filter_options(CLI::App& command, filter_request& request) {
    command.add_option("--cutoff", request.cutoff,
                       "cut-off of the position filter [Hz], 0: no filter; default: chosen from the data");
    command.add_option("--order", request.order,
                       "order of its Butterworth filter, applied forward and backward; default 4");
    command.add_option("--decimation", request.decimation, "keep one row in so many; default: chosen from the data");
    command.add_option(
        "--minimum-speed", request.minimum_speed,
        "leave out rests of a joint: rows slower than this part of its top speed; 0 keeps all; default 0.01");
}

json finite(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json(const error_summary& errors, const loaded_robot& robot) {
    json joints = json::array();
    for (std::size_t j = 0; j < errors.joints.size(); ++j) {
        joints.push_back({{"joint", robot.generated.joints[j].name},
                          {"rms", finite(errors.joints[j].rms)},
                          {"relative_error", finite(errors.joints[j].relative_error)}});
    }
    return {{"relative_error", finite(errors.relative_error)}, {"joints", joints}};
}

json to_json(const filter_choice& choice) {
    return {{"cutoff", choice.cutoff},
            {"order", choice.order},
            {"decimation", choice.decimation},
            {"minimum_speed", choice.minimum_speed},
            {"reason", choice.reason}};
}

void print(const error_summary& errors, const loaded_robot& robot) {
    fmt::print("  relative error {:.2f} %;", 100.0 * errors.relative_error);
    for (std::size_t j = 0; j < errors.joints.size(); ++j) {
        const auto& joint = robot.generated.joints[j];
        fmt::print("{} {} {:.1f} % ({:.3g} {})", j == 0 ? "" : ",", joint.name, 100.0 * errors.joints[j].relative_error,
                   errors.joints[j].rms, joint.prismatic ? "N" : "N*m");
    }
    fmt::print("\n");
}

}  // namespace idim::cli
