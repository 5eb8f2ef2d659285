#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "idim/log.hpp"

namespace idim {

/// What the user may fix of the filtering; what is left empty is chosen from the data by choose_filter.
struct filter_request {
    std::optional<double> cutoff = {};   ///< Butterworth cut-off of the position filter [Hz]; 0 leaves it out
    std::optional<int> order = {};       ///< its order (applied forward and backward), default 4
    std::optional<int> decimation = {};  ///< one sample in n_d of the parallel decimation
    /// Part of a joint's top speed below which its rows are left out, 0 to below 1, default 0.01.
    std::optional<double> minimum_speed = {};
};

/// A joint whose position stays within this part of the largest range of any joint of a log is held in that log.
inline constexpr double held_range = 1e-3;

/// The filtering that is applied, the same for every log of one identification, and why.
struct filter_choice {
    double cutoff = 0.0;  ///< [Hz]; 0: the position is differentiated as it was measured
    int order = 4;
    int decimation = 1;
    /// One sentence for the report: what was given, what was chosen from the data and by which figure.
    std::string reason;
    double minimum_speed =
        0.0;  ///< part of a joint's top speed in a log, see select_rows (observation.hpp); 0 keeps all rows

    /// Upper edge of the band that the decimated rows keep [Hz], 0.8 f_m / (2 n_d) (METHODS.md, IDIM-LS 3).
    double band(double rate) const;
};

/// Uniform, zero-phase filtered motion of one log at the full rate, edges of the filter removed.
struct filtered_samples {
    std::string file;
    double rate = 0.0;    ///< [Hz]
    Eigen::VectorXd t;    ///< [s]
    Eigen::MatrixXd q;    ///< samples x dof, low-passed
    Eigen::MatrixXd qd;   ///< central differences of q
    Eigen::MatrixXd qdd;  ///< central differences of q
    Eigen::MatrixXd
        tau;  ///< as measured, resampled only: the parallel decimation filters it together with the regressor
    Eigen::MatrixXd temp;  ///< empty if not recorded

    Eigen::Index samples() const { return t.size(); }
    /// `count` samples from the `first` on.
    filtered_samples part(Eigen::Index first, Eigen::Index count) const;
};

/// Resamples a log on a uniform grid at its median rate if its time stamps are not uniform (relative to
/// `jitter_tolerance` of a period); returns it as it is otherwise.
log resample_uniform(const log& data, double jitter_tolerance = 1e-3);

/// Chooses what `request` leaves open from the spectra of all logs together.
filter_choice choose_filter(const std::vector<log>& logs, const filter_request& request);

/// Zero-phase low-pass of q, then central differences (METHODS.md, IDIM-LS 1; [IV section 2]). Throws input_error if
/// the log is shorter than the filter needs, naming both lengths.
filtered_samples filter_log(const log& data, const filter_choice& choice);

}  // namespace idim
