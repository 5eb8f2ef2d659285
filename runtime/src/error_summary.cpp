#include <cmath>
#include <stdexcept>

#include "idim/estimate.hpp"

namespace idim {

namespace {

/// |residual| / |Y|; where nothing was to be predicted, 0 for a residual of zero and 1 for any other.
double relative(double residual_squared, double Y_squared) {
    if (Y_squared == 0.0) {
        return residual_squared == 0.0 ? 0.0 : 1.0;
    }
    return std::sqrt(residual_squared / Y_squared);
}

}  // namespace

error_summary errors(const observation& rows, const Eigen::VectorXd& chi) {
    if (chi.size() != rows.n_base) {
        throw std::invalid_argument("errors: chi has " + std::to_string(chi.size()) + " entries, the rows have " +
                                    std::to_string(rows.n_base) + " columns");
    }
    error_summary summary;
    double all_residual = 0.0;
    double all_Y = 0.0;
    for (int j = 0; j < rows.dof; ++j) {
        double residual = 0.0;
        double Y = 0.0;
        for (const observation_block& block : rows.blocks) {
            residual += (block.Y[j] - block.W[j] * chi).squaredNorm();
            Y += block.Y[j].squaredNorm();
        }
        const double samples = static_cast<double>(rows.rows(j));
        summary.joints.push_back({samples > 0.0 ? std::sqrt(residual / samples) : 0.0, relative(residual, Y)});
        all_residual += residual;
        all_Y += Y;
    }
    summary.relative_error = relative(all_residual, all_Y);
    return summary;
}

}  // namespace idim
