#include "declared_law.hpp"

#include "description/robot_description.hpp"
#include "idim/input_error.hpp"
#include "idim/law_declaration.hpp"

namespace idim::cli {

std::unique_ptr<control_law> declared_law(const std::string& robot_file, const loaded_robot& robot,
                                          const Eigen::VectorXd& chi) {
    const generator::robot_description description = generator::read_robot(robot_file);
    if (!description.control) {
        throw input_error({description.file, 0, "control"},
                          "missing, expected a control law to simulate the closed loop");
    }
    const generator::control_description& control = *description.control;
    return make_control_law({control.law, control.rate, control.delay, control.values, control.where}, robot.model(),
                            chi);
}

}  // namespace idim::cli
