#include <fmt/format.h>

#include "command.hpp"
#include "emit/model_folder.hpp"
#include "generator.hpp"
#include "idim/unified_diff.hpp"
#include "resources.hpp"

namespace idim::cli {

namespace {

struct generate_options {
    std::string robot;
    std::string folder;
    generator::generation_options wanted;
    bool check = false;
    std::string json_file;
};

json table_json(const generator::operation_table& table) {
    const auto count = [](const generator::operation_count& c) {
        return json{{"mul", c.mul}, {"add", c.add}, {"div", c.div}};
    };
    return {{"inverse_dynamics", count(table.inverse_dynamics)},
            {"regressor", count(table.regressor)},
            {"mass_matrix", count(table.mass_matrix)},
            {"forward_dynamics", count(table.forward_dynamics)}};
}

json model_json(const generator::generated_model& model) {
    json files = json::array();
    for (const generator::rendered_file& file : model.files) {
        files.push_back(file.name);
    }
    json operations = table_json(model.operations);
    operations["rigid"] = table_json(model.rigid_operations);
    return {{"robot", model.robot},           {"target", model.target}, {"cost", model.cost},
            {"input_hash", model.input_hash}, {"files", files},         {"seconds", model.seconds},
            {"operations", operations}};
}

void print_operations(const char* name, const generator::operation_count& all,
                      const generator::operation_count& rigid) {
    fmt::print("  {:<17} {:>4} mul {:>4} add {:>2} div   (rigid links alone: {} mul {} add {} div)\n", name, all.mul,
               all.add, all.div, rigid.mul, rigid.add, rigid.div);
}

void print(const generator::generated_model& model) {
    fmt::print("{}: {} joints, {} base parameters, input {}\n", model.robot, model.joints.size(),
               model.base.parameters.size(), model.input_hash);
    print_operations("inverse dynamics", model.operations.inverse_dynamics, model.rigid_operations.inverse_dynamics);
    print_operations("regressor", model.operations.regressor, model.rigid_operations.regressor);
    print_operations("mass matrix", model.operations.mass_matrix, model.rigid_operations.mass_matrix);
    print_operations("forward dynamics", model.operations.forward_dynamics, model.rigid_operations.forward_dynamics);
}

int check_folder(const generator::generated_model& model, const generate_options& options) {
    const auto differences = generator::compare_model(model.files, options.folder);
    std::vector<file_change> changes;
    json files = json::array();
    for (const generator::folder_difference& difference : differences) {
        changes.push_back({difference.name, difference.present, difference.wanted});
        files.push_back({{"file", difference.name}, {"state", difference.state()}});
    }
    const std::string diff = unified_diff(changes);
    write_json(options.json_file, {{"robot", model.robot},
                                   {"target", model.target},
                                   {"folder", options.folder},
                                   {"current", differences.empty()},
                                   {"differences", files},
                                   {"diff", diff}});
    if (prints_text(options.json_file)) {
        for (const generator::folder_difference& difference : differences) {
            fmt::print("{}/{}: {}\n", options.folder, difference.name, difference.state());
        }
        fmt::print("{}", diff);
    }
    return differences.empty() ? exit_done : exit_check_said_no;
}

int run(const generate_options& options) {
    const generator::generated_model model = generator::generate(options.robot, templates_folder(), options.wanted);
    print_notes(options.robot, model.base.notes);
    if (options.check) {
        return check_folder(model, options);
    }
    const std::vector<std::string> changed = generator::write_model(model.files, options.folder);
    write_json(options.json_file, model_json(model));
    if (prints_text(options.json_file)) {
        print(model);
        fmt::print("{} files in {}, {} changed\n", model.files.size(), options.folder, changed.size());
    }
    return exit_done;
}

}  // namespace

void add_generate_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<generate_options>();
    CLI::App* command = app.add_subcommand("generate", "code of the robot's models");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("-o,--output", options->folder, "folder for the code")->required();
    command->add_option("--target", options->wanted.target, "language of the code")
        ->check(CLI::IsMember(generator::target_names()))
        ->capture_default_str();
    command
        ->add_option("--cost", options->wanted.cost,
                     "what the code is made cheap for: the fewest operations, an x86 processor or a Cortex-M4F")
        ->check(CLI::IsMember(generator::cost_target_names()))
        ->capture_default_str();
    command->add_flag("--derivatives", options->wanted.derivatives,
                      "also derivatives of the inverse dynamics by positions and velocities");
    command->add_flag("--check", options->check,
                      "write nothing; exit 1 and a diff where the folder is not what would be written");
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
