#include <fmt/format.h>

#include "description/robot_description.hpp"
#include "description/text_file.hpp"
#include "emit/urdf_file.hpp"
#include "exported_result.hpp"
#include "idim/input_error.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::cli {

namespace {

constexpr std::size_t largest_urdf = 10'000'000;

struct export_options {
    std::string result;
    std::string format;
    std::string robot;
    std::string output;
};

std::string as_urdf(const exported_result& result, const std::string& file) {
    if (result.standard.empty()) {
        throw input_error({file, 0, "consistency"},
                          "missing, expected a result of identify --method cwls: links need all their inertial "
                          "parameters, other methods "
                          "find the base parameters alone");
    }
    const generator::robot_description robot = generator::read_robot(result.robot_file);
    std::map<std::string, double> parameters;
    for (const named_value& value : result.standard) {
        parameters[value.name] = value.value;
    }
    const std::string& source = robot.urdf_file;
    const generator::urdf_file urdf =
        source.empty()
            ? generator::to_urdf(robot, generator::build_kinematic_tree(robot), parameters)
            : generator::with_parameters(generator::read_text_file(source, largest_urdf), source, robot, parameters);
    print_notes(result.robot_file, urdf.notes);
    return urdf.text;
}

void write(const std::string& file, const std::string& text) {
    if (file.empty() || file == "-") {
        fmt::print("{}", text);
        return;
    }
    write_text(file, text);
}

int run(const export_options& options) {
    exported_result result = read_result(options.result);
    if (!options.robot.empty()) {
        result.robot_file = options.robot;
    }
    const std::string text = options.format == "urdf"   ? as_urdf(result, options.result)
                             : options.format == "yaml" ? as_yaml(result)
                                                        : as_header(result);
    write(options.output, text);
    return exit_done;
}

}  // namespace

void add_export_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<export_options>();
    CLI::App* command = app.add_subcommand("export", "identified parameters for others to use");
    command->add_option("result", options->result, "result of identify --json")->required();
    command
        ->add_option("--format", options->format,
                     "urdf (inertias of a result of cwls put into the robot's URDF, or into one of its frames), yaml, "
                     "or header (constants "
                     "for C and C++)")
        ->check(CLI::IsMember({"urdf", "yaml", "header"}))
        ->required();
    command->add_option("--robot", options->robot, "robot description, default: the one that the result names");
    command->add_option("-o,--output", options->output, "file, default: standard output");
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
