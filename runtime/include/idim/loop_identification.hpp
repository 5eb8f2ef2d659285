#pragma once

#include <vector>

#include "idim/closed_loop.hpp"
#include "idim/estimate.hpp"

namespace idim {

/// Methods that simulate the closed loop with the present parameters in every iteration.
///  - iv: instrumental variable, chi = (V'W)^-1 V'Y, V the regressor along the simulated motion [Janot, Vandanjon and
///    Gautier 2010, equations 22-34]: unbiased however noisy the measured regressor W;
///  - didim: output error on the torque, chi = (V'V)^-1 V'Y, which uses no measured motion but for the rows [Gautier,
///    Janot and Vandanjon 2013, "A new closed-loop output error method for parameter identification of robot dynamics",
///    IEEE Trans. Control Systems Technology 21(2)];
///  - cloe: output error on the position by Gauss-Newton with numeric sensitivities [Landau and Karimi 1997, "Recursive
///    algorithms for identification in closed loop", Automatica 33(8); in robotics Brunot, Janot, Carrillo and Gautier
///    2017]. Its loop must have the robot's own gains, whatever chi.
enum class loop_method { iv, didim, cloe };

struct loop_options {
    int most_iterations = 20;
    /// Stop when |Y - W_s chi_k| changes by less than this part from one iteration to the next [IV 27].
    double tolerance = 0.01;
    /// Instruments are weak, and the result is refused, when r cos^2 / sin^2 of the largest angle between the spans of
    /// instruments and regressor is below this, r the number of rows: what F is of the first stage along the direction
    /// that they explain least; 10 by the rule of Staiger and Stock 1997, Econometrica 65(3).
    double weakest_instruments = 10.0;
    /// Takes from the measured torque what sampling, differences and filters make of the simulated torque beside its
    /// own model, Y_s - W_s chi_k: the jumps of friction, smeared otherwise in qdd than in sign(qd), bias the paper's
    /// estimate by some 0.1 %, more than its deviation in long records. Needs a simulation that logs the torque as the
    /// robot does.
    bool corrects_processing = false;
};

/// What was recorded, with the filter that regressor, instruments and torque share.
struct loop_experiment {
    const idim_model_interface& model;
    const std::vector<log>& logs;  ///< with qr, unless the loop follows something else
    filter_choice filter;
};

/// Rows of the measured motion without rests (select_rows) and without the transient of the simulated loop: the rows
/// that every method is to be compared on.
observation observe_steady(const loop_experiment& experiment, const closed_loop& loop);

/// Parameters with which M is regular everywhere whatever the robot: of the standard parameters Ia_j = 1 [IV 48], where
/// a joint has no rotor inertia ZZ_j = 1 [IV 51], or M_j = 1 of a prismatic one; all others 0; then regrouped. The
/// kinetic energy is then a sum of squares, one for every joint, that vanish together only at rest. Throws data_error
/// for a joint that has none of the three.
Eigen::VectorXd regular_start(const idim_model_interface& model);

/// An identification with the regressor along the motion simulated with its parameters, on the measured rows and with
/// the measured torque; without blocks if there are no parameters.
struct loop_estimate {
    estimate fit;
    observation along;
};

/// Identifies from `rows` (observe_steady) and simulated motions, starting with `start` [b]. The logs are simulated
/// side by side on all cores. Rows of joint j are divided by the deviation of that joint's own residual [IV 20].
///
/// The result has the iterations, a covariance robust to autocorrelation (sandwich.hpp: around the instruments), ranks
/// and errors on the measured rows. A loop that cannot be simulated, instruments that lose rank and iterations that do
/// not settle are results: chi empty, the message naming iteration, joint and what to try.
loop_estimate identify_in_loop(const loop_experiment& experiment, const closed_loop& loop, const observation& rows,
                               loop_method method, const Eigen::VectorXd& start, const loop_options& options = {});

/// A model judged by simulating it against a log, which should have no part in its identification.
struct loop_validation {
    iteration judged;         ///< distances of the motion, errors of the torque along the measured motion
    error_summary simulated;  ///< errors of the torque along the simulated one
    std::string failure;      ///< why there is no simulation; then the rest is empty
};

/// Simulates the logs of `experiment` with chi. rows: observe_steady.
loop_validation validate_in_loop(const loop_experiment& experiment, const closed_loop& loop, const observation& rows,
                                 const Eigen::VectorXd& chi);

}  // namespace idim
