#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "idim/compiled_model.hpp"
#include "idim/control_law.hpp"
#include "idim/input_error.hpp"

namespace idim {

/// The `control:` entry of a robot description.
struct law_declaration {
    std::string law;     ///< pd_cascade, pid, p_position, computed_torque, emps, or the header of a user's own
    double rate = 0.0;   ///< [Hz]
    double delay = 0.0;  ///< [s], a whole number of samples
    std::map<std::string, std::vector<double>> values;  ///< gains, saturation: one for each of the n joints
    input_location where;
    std::shared_ptr<const compiled_law> own = {};  ///< the user's own law; null for the others
};

/// The declared law. Gains from wn and zeta are tuned to the largest inertia under `chi` [b], which is also what
/// computed_torque believes in; a drive gain that the model does not have is 1, so that the command is the torque.
/// Throws input_error for an unknown law or value, a missing gain, a gain that is not positive, or a delay between
/// samples. `model` outlives the law.
std::unique_ptr<control_law> make_control_law(const law_declaration& declaration, const idim_model_interface& model,
                                              const Eigen::VectorXd& chi);

}  // namespace idim
