#pragma once

#include <Eigen/Core>
#include <optional>

#include "consistency/cone_program.hpp"

namespace idim::test {

/// What the solver CSDP (Borchers 1999, Debian package coinor-csdp) says of a program without priors: least squares as
/// a matrix inequality [E, A x - b; (A x - b)', 2 t] >= 0 with t minimised. `size`: what the objective
/// is about, for CSDP's tolerances are absolute where its numbers are small. Nothing if it cannot be run.
struct csdp_optimum {
    Eigen::VectorXd x;       ///< outside of constraints by what CSDP tolerates
    double objective = 0.0;  ///< as CSDP has it, constant included
};

std::optional<csdp_optimum> solve_with_csdp(const cone_program& program, double size);

}  // namespace idim::test
