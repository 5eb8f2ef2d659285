#include <cmath>
#include <stdexcept>

#include "idim/estimate.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// |residual| / |Y|; where nothing was to be predicted, 0 for a residual of zero and 1 for any other.
double relative(double residual_squared, double Y_squared) {
    if (Y_squared == 0.0) {
        return residual_squared == 0.0 ? 0.0 : 1.0;
    }
    return std::sqrt(residual_squared / Y_squared);
}

/// What one joint's rows leave.
struct joint_squares {
    double residual = 0.0;
    double Y = 0.0;
    Eigen::Index rows = 0;
};

error_summary summary_of(const std::vector<joint_squares>& joints) {
    error_summary summary;
    double residual = 0.0;
    double Y = 0.0;
    for (const joint_squares& joint : joints) {
        const double rms = joint.rows > 0 ? std::sqrt(joint.residual / static_cast<double>(joint.rows)) : 0.0;
        summary.joints.push_back({rms, relative(joint.residual, joint.Y)});
        residual += joint.residual;
        Y += joint.Y;
    }
    summary.relative_error = relative(residual, Y);
    return summary;
}

}  // namespace

error_summary errors(const joint_triangles& joints, const Eigen::VectorXd& chi) {
    std::vector<joint_squares> squares;
    for (int j = 0; j < joints.joints(); ++j) {
        squares.push_back({joints.residual_square(j, chi), joints.torque_square(j), joints.rows(j)});
    }
    return summary_of(squares);
}

error_summary errors(const observation& rows, const Eigen::VectorXd& chi) {
    if (chi.size() != rows.n_base) {
        throw std::invalid_argument("errors: chi has " + std::to_string(chi.size()) + " entries, the rows have " +
                                    std::to_string(rows.n_base) + " columns");
    }
    std::vector<joint_squares> squares;
    for (int j = 0; j < rows.dof; ++j) {
        joint_squares joint{0.0, 0.0, rows.rows(j)};
        for (const observation_block& block : rows.blocks) {
            joint.residual += (block.Y[j] - block.W[j] * chi).squaredNorm();
            joint.Y += block.Y[j].squaredNorm();
        }
        squares.push_back(joint);
    }
    return summary_of(squares);
}

double error_ratio(const error_summary& before, const error_summary& after) {
    double parts = 0.0;
    for (std::size_t j = 0; j < before.joints.size(); ++j) {
        const double ratio = before.joints[j].rms > 0.0 ? after.joints[j].rms / before.joints[j].rms : 1.0;
        parts += ratio * ratio;
    }
    return std::sqrt(parts / static_cast<double>(before.joints.size()));
}

}  // namespace idim
