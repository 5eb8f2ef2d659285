#include "declared_law.hpp"

#include <filesystem>

#include "description/text_file.hpp"
#include "idim/input_error.hpp"
#include "idim/user_law.hpp"
#include "resources.hpp"

namespace idim::cli {

namespace {

compiled_law compile_header(const generator::control_description& control) {
    constexpr std::size_t largest = 1'000'000;
    const input_location where = {control.where.file, control.where.line, "control.law"};
    const std::filesystem::path file = std::filesystem::path(control.where.file).parent_path() / control.law;
    if (!std::filesystem::is_regular_file(file)) {
        throw input_error(where, control.law + " is not there, expected a header beside the description");
    }
    return compile_user_law({control.law, generator::read_text_file(file.string(), largest)},
                            {interface_header("idim/law_interface.h"), interface_header("idim/law_adapter.hpp")},
                            where);
}

}  // namespace

law_declaration law_declaration_of(const generator::control_description& control) {
    law_declaration declaration = {control.law, control.rate, control.delay, control.values, control.where};
    if (generator::is_header(control)) {
        declaration.own = std::make_shared<const compiled_law>(compile_header(control));
    }
    return declaration;
}

std::unique_ptr<control_law> declared_law(const std::string& robot_file, const loaded_robot& robot,
                                          const Eigen::VectorXd& chi) {
    const generator::robot_description description = generator::read_robot(robot_file);
    if (!description.control) {
        throw input_error({description.file, 0, "control"},
                          "missing, expected a control law to simulate the closed loop");
    }
    return make_control_law(law_declaration_of(*description.control), robot.model(), chi);
}

}  // namespace idim::cli
