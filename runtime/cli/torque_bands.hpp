#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identified_parameters.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

/// How often the confidence bands of one joint's torque hold on rows that were not identified from.
struct joint_band {
    double from_parameters = 0.0;  ///< rms over the rows of the deviation that the parameters' covariance makes
    double half_width = 0.0;       ///< mean over the rows of 1.96 deviations of the torque
    double covered = 0.0;          ///< share of the rows within
    double independent = 1.0;      ///< rows over the correlation length of their errors
};

/// Bands of 95 % about the torque that a model predicts.
struct torque_bands {
    std::vector<std::vector<Eigen::VectorXd>> deviation;  ///< [joint][block] of every row
    std::vector<joint_band> joints;
};

inline constexpr double band_quantile = 1.959964;  ///< of the normal distribution, for 95 %
inline constexpr double band_level = 0.95;

/// The deviation of the torque of joint j at a row x is sqrt(x' C x + s_j^2): C the covariance of the parameters, s_j
/// the deviation of the rows they were identified from (unaveraged). Nominal for errors that are independent of the
/// motion and as large as there; what the model leaves unexplained is neither.
torque_bands bands_of(const observation& rows, const Eigen::VectorXd& chi, const prediction_spread& spread);

/// Adds `band` to the joints of the JSON of validate.
void add_bands(json& joints, const torque_bands& bands, const prediction_spread& spread);
void print(const torque_bands& bands, const loaded_robot& robot);

/// CSV, one line per row: log, joint, t, tau, predicted, low, high; low and high empty without bands.
std::string series_text(const observation& rows, const Eigen::VectorXd& chi, const loaded_robot& robot,
                        const std::optional<torque_bands>& bands);

}  // namespace idim::cli
