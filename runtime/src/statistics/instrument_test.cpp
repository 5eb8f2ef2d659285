#include "idim/instrument_test.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <stdexcept>

#include "statistics/thinned_rows.hpp"
#include "weighted_fit.hpp"

namespace idim {

namespace {

/// The system of the test: thinned, weighted, joints and blocks below one another.
struct thinned_system {
    Eigen::MatrixXd W, V;
    Eigen::VectorXd Y;
};

thinned_system thin(const observation& rows, const observation& instruments, const estimate& iv) {
    const std::vector<double> weight = weights_of(iv.joint_deviation);
    thinned_system system{Eigen::MatrixXd(rows.rows(), rows.n_base), Eigen::MatrixXd(rows.rows(), rows.n_base),
                          Eigen::VectorXd(rows.rows())};
    Eigen::Index filled = 0;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        for (std::size_t j = 0; j < weight.size(); ++j) {
            const observation_block& block = rows.blocks[i];
            const std::vector<Eigen::Index> kept = thinned_rows(block.kept[j], iv.correlation_length[j]);
            const auto count = static_cast<Eigen::Index>(kept.size());
            system.W.middleRows(filled, count) = weight[j] * block.W[j](kept, Eigen::all);
            system.V.middleRows(filled, count) = weight[j] * instruments.blocks[i].W[j](kept, Eigen::all);
            system.Y.segment(filled, count) = weight[j] * block.Y[j](kept);
            filled += count;
        }
    }
    system.W.conservativeResize(filled, Eigen::NoChange);
    system.V.conservativeResize(filled, Eigen::NoChange);
    system.Y.conservativeResize(filled);
    return system;
}

/// F test that the columns of E add nothing to those of W.
void test_columns(const thinned_system& system, instrument_test& result) {
    const Eigen::Index r = system.Y.size();
    const Eigen::Index b = system.W.cols();
    result.rows = r;
    if (r <= 2 * b) {
        return;
    }
    const Eigen::VectorXd scale = system.W.colwise().norm().cwiseMax(1e-300).cwiseInverse();
    const Eigen::MatrixXd W = system.W * scale.asDiagonal();
    const Eigen::MatrixXd E = W - system.V * system.V.colPivHouseholderQr().solve(W);
    const Eigen::HouseholderQR<Eigen::MatrixXd> base(W);
    const auto without_W = [&](const Eigen::MatrixXd& X) {
        Eigen::MatrixXd rotated = base.householderQ().transpose() * X;
        return Eigen::MatrixXd(rotated.bottomRows(r - b));
    };
    // A column of W that the instruments explain to 1e-6 of its size carries no noise that could be tested.
    constexpr double no_noise = 1e-6;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> added(without_W(E));
    const Eigen::VectorXd pivots = added.matrixQR().diagonal().cwiseAbs();
    result.tested = static_cast<int>((pivots.array() > no_noise).count());
    const Eigen::Index freedom = r - b - result.tested;
    if (result.tested == 0) {
        return;
    }
    const Eigen::VectorXd y = without_W(system.Y);
    const Eigen::VectorXd rotated = added.householderQ().transpose() * y;
    const double explained = rotated.head(result.tested).squaredNorm();
    const double left = rotated.tail(y.size() - result.tested).squaredNorm();
    if (left == 0.0) {
        return;
    }
    result.f_statistic = explained / result.tested / (left / static_cast<double>(freedom));
    const boost::math::fisher_f law(result.tested, static_cast<double>(freedom));
    result.p_value = boost::math::cdf(boost::math::complement(law, result.f_statistic));
}

}  // namespace

instrument_test durbin_wu_hausman(const observation& rows, const observation& instruments, const estimate& ls,
                                  const estimate& iv) {
    if (ls.chi.size() != rows.n_base || iv.chi.size() != rows.n_base) {
        throw std::invalid_argument("durbin_wu_hausman: both estimates must have parameters");
    }
    instrument_test result;
    const Eigen::VectorXd bias = ls.chi - iv.chi;
    result.bias_percent = 100.0 * bias.cwiseQuotient(iv.chi.cwiseAbs());
    result.bias_in_deviations = bias.cwiseQuotient(iv.deviations());
    test_columns(thin(rows, instruments, iv), result);
    if (result.tested == 0) {
        result.message = fmt::format("{} independent rows do not suffice to test the measured regressor", result.rows);
        return result;
    }
    Eigen::Index most = 0;
    const double largest = result.bias_in_deviations.cwiseAbs().maxCoeff(&most);
    const bool correlated = result.p_value < 0.05;
    result.message = fmt::format(
        "the measured regressor is {}correlated with the error (p = {:.2g} on {} independent rows){}; the largest bias "
        "of least squares is {:.1f} deviations, {:.2f} %",
        correlated ? "" : "not seen to be ", result.p_value, result.rows,
        correlated && largest < 1.0 ? ", to no effect" : "", largest, result.bias_percent[most]);
    return result;
}

}  // namespace idim
