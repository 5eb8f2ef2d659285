#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "idim/motion_distance.hpp"
#include "idim/observation.hpp"

namespace idim {

enum class least_squares_method { ols, wls, irls };

/// Errors of one joint: rms of Y - W chi [N*m or N], and |Y - W chi| / |Y|.
struct joint_error {
    double rms = 0.0;
    double relative_error = 0.0;
};

/// E of FORMATS.md: over all rows and joint by joint.
struct error_summary {
    double relative_error = 0.0;
    std::vector<joint_error> joints;
};

/// What one step of an iterative method left. The methods that simulate (loop_identification.hpp) fill all of it, IRLS
/// the first two entries.
struct iteration {
    Eigen::VectorXd chi;
    double relative_error = 0.0;                     ///< |Y - W chi| / |Y|
    std::vector<joint_error> joint_errors = {};      ///< of every joint
    double simulated_error = 0.0;                    ///< |Y - W_s chi| / |Y|, W_s along the motion simulated with chi
    std::vector<motion_distance> to_measured = {};   ///< per joint: simulated motion against the filtered measured one
    std::vector<motion_distance> to_reference = {};  ///< per joint: against the reference; empty if there is none
};

/// Result of an identification; a numeric failure is a result that explains itself, never a NaN that passes for a
/// value.
struct estimate {
    Eigen::VectorXd chi;         ///< [b]
    Eigen::MatrixXd covariance;  ///< [b x b], robust to the autocorrelation of the residual
    Eigen::VectorXd std_white;   ///< [b] deviations if the residual were white [IV 17-18], for comparison
    bool converged = false;
    int rank = 0;                   ///< numerical rank of the weighted, column-scaled W
    double condition_number = 0.0;  ///< of the weighted W as [IV] uses it, columns not scaled
    double scaled_condition_number = 0.0;
    Eigen::Index samples = 0;  ///< rows used
    std::vector<double> joint_deviation;
    std::vector<double>
        correlation_length;  ///< per joint: integrated autocorrelation time of the residual [rows], >= 1
    std::vector<iteration> iterations;
    error_summary residual;
    std::vector<int> not_excited;  ///< columns in the null space of W when rank < b; then chi is empty
    std::string message;           ///< what happened, one sentence

    Eigen::VectorXd deviations() const { return covariance.diagonal().cwiseSqrt(); }
};

/// Least squares of the stacked rows through QR [IV 15-20, METHODS.md IDIM-LS 4].
///  - ols: every row alike;
///  - wls: rows of joint j divided by the deviation of that joint's own OLS error [IV 20];
///  - irls: wls, then row weights from a robust loss, iterated.
/// Deviations come from a sandwich with the residual's own autocorrelation, joint by joint and block by block.
estimate least_squares(const observation& rows, least_squares_method method);

/// Errors of chi on the rows of `rows`, all blocks together.
error_summary errors(const observation& rows, const Eigen::VectorXd& chi);

/// Root of the mean over joints of their squared errors, each over what it was before (of the same joints, no rows of
/// which changed): added up as they are, the joint with the largest torque would decide alone.
double error_ratio(const error_summary& before, const error_summary& after);

/// One parameter's part in a reduced model.
struct essential_parameters {
    std::vector<int> kept;     ///< columns, in order
    std::vector<int> dropped;  ///< columns in the order of their elimination
    Eigen::VectorXd chi;       ///< [b], zero where dropped
    Eigen::VectorXd std;       ///< [b], zero where dropped
    error_summary residual;
    double f_statistic = 0.0;  ///< of the dropped ones together against the full model, on effective samples
    double p_value = 1.0;
};

/// Backward elimination with an F test: drops the parameter with the largest relative deviation as long as the F test
/// of all the dropped ones against the full model stays above `significance`, its degrees of freedom those of the
/// effective (autocorrelation-corrected) number of samples.
essential_parameters find_essential(const observation& rows, const estimate& full, double significance = 0.05);

}  // namespace idim
