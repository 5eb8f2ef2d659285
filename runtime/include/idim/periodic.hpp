#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "idim/estimate.hpp"
#include "idim/filtered_samples.hpp"
#include "idim/motion_source.hpp"
#include "idim/observation.hpp"

namespace idim {

/// The whole periods of one log that are averaged.
struct periodic_part {
    Eigen::Index period = 0;   ///< [samples]
    Eigen::Index periods = 0;  ///< P, at least 2
    Eigen::Index first = 0;    ///< sample where they begin; what stands before is the transient
    Eigen::Index after = 0;    ///< samples behind them
    /// How far one period is from the next: rms of the difference of the positions over sqrt(2), as a part of their rms
    /// about the mean; median over tenths of a period, so that a transient does not count.
    double mismatch = 0.0;
};

/// The periods of a log, or one phrase that says why there are none.
struct period_search {
    std::optional<periodic_part> part = {};
    std::string obstacle = {};
};

/// Finds the period of the positions of the joints that move, to the sample, or takes the given one [s]. Candidates are
/// the local minima of sum (x_{k+L} - x_k)^2 over the lag L, from the autocorrelation; the shortest lag wins whose
/// median mismatch is within twice that of the best. Averaged are the last whole periods of the longest stretch over
/// which the mismatch stays within three times its median (or 0.1 % of the motion): transients, rests and connections
/// at both ends stay out. There is no part where less than two periods are left, where the mismatch is above 5 %, or
/// where the given period is no whole number of samples. A period is searched for in the first 2^20 samples.
period_search find_period(const motion_source& motion, std::optional<double> period);
period_search find_period(const filtered_samples& samples, std::optional<double> period);

/// The average over the periods [CWLS 5], repeated at both ends as far as the decimation reaches.
filtered_samples average_periods(const motion_source& motion, const periodic_part& part, const filter_choice& choice);
filtered_samples average_periods(const filtered_samples& samples, const periodic_part& part,
                                 const filter_choice& choice);

/// The rows of one period out of those of logs that average_periods made; parts[i] belongs to log i.
observation rows_of_period(observation rows, const std::vector<periodic_part>& parts, const filter_choice& choice);

/// How the torque scatters about its average in one log.
struct torque_scatter {
    std::vector<Eigen::MatrixXd> deviations;  ///< per period: torque less its average, decimated [rows x n]
    std::vector<Eigen::MatrixXd> covariance;  ///< per row: Sigma_k of the torque of one period [n x n]
    Eigen::VectorXd rms;                      ///< [n] deviation of the torque of one period, over all rows
    double pooled_share = 1.0;                ///< lambda: 1 where Sigma_k is the same for all rows

    /// Whether a joint's torque scatters by more than 1e-9 of its size: there is something to weight by.
    bool scatters = false;
};

/// Covariance between the joints of the torque at every sample of the period, from its deviation S_k over P periods
/// [CWLS 11], shrunk towards its mean over the period,
///     Sigma_k = (1 - lambda) S_k + lambda mean(S).
/// lambda is the part of the spread of S_k about the mean that P periods of normal noise make by themselves (Ledoit and
/// Wolf 2004, here with the mean as target and in its metric), and at least (n + 2) / (P + n + 1), the weight of the
/// weakest inverse Wishart prior that has a mean: S_k is singular with P <= n and hardly worth inverting with few more.
torque_scatter scatter_of(const motion_source& motion, const periodic_part& part, const filter_choice& choice);
torque_scatter scatter_of(const filtered_samples& samples, const periodic_part& part, const filter_choice& choice);

/// The rows of one period, each sample's block multiplied by the inverse of the Cholesky factor of the covariance of
/// the averaged torque, Sigma_k / P: rows without a unit, of deviation 1 where nothing but noise is left. A sample at
/// which joints have no row takes the block of those that have.
observation whiten(observation rows, const std::vector<torque_scatter>& scatter);

/// Weighted least squares [CWLS 10] of whitened rows; `rows` are the same before, for the errors in units of torque.
estimate fit_whitened(const observation& rows, const observation& whitened);

/// Puts the errors in units of torque into an estimate that was made from whitened rows.
void restore_units(const observation& rows, estimate& fit);

/// Deviations that the scatter of the periods alone gives the parameters [b]: every period's own estimate is one draw,
/// and the variance of their mean is sum_p |chi_p - mean|^2 / (P (P - 1)), whatever the correlation within a period and
/// between joints. Each draw is weighted by the scatter of the other periods: weights that come from a draw itself make
/// it look smaller than it is. With few periods they are rough: 1 / sqrt(2 (P - 1)) of themselves. They know nothing of
/// what the model leaves unexplained in every period alike, which those of fit_whitened do. `rows` are not whitened, of
/// full rank.
Eigen::VectorXd scatter_deviations(const observation& rows, const std::vector<torque_scatter>& scatter);

}  // namespace idim
