#pragma once

#include "consistency/cone_program.hpp"
#include "idim/consistent_fit.hpp"

namespace idim {

/// Sizes that the data suggests, for references and scales.
struct parameter_scale {
    double inertial = 1.0;     ///< largest of the standard parameters of bodies
    double coefficient = 1.0;  ///< largest of the others
};

/// The problem without its objective, and a point strictly inside.
struct consistency_program {
    cone_program program;  ///< A and b empty
    Eigen::VectorXd start;
    double floor = 0.0;
};

/// One matrix constraint for each body, the bounds of masses, of their sum and of the centres of mass, then those of
/// coefficients. `names` [s] for messages. Throws input_error where the bounds contradict each other or the prior is
/// not consistent: bodies are independent of one another but for the sum of their masses, so that a point inside is
/// found, or a contradiction shown, directly.
consistency_program constrain(const physical_parameters& known, const consistency_request& request,
                              const parameter_scale& scale, const std::vector<std::string>& names);

}  // namespace idim
