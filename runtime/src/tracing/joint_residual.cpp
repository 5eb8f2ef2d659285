#include "joint_residual.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace idim {

namespace {

constexpr double least_range = 1e-6;  ///< a signal that moves less over all rows cannot be told from a constant

Eigen::VectorXd signal_of(const traced_log& log, const signal_source& source) {
    switch (source.what) {
        case signal_source::kind::q:
            return log.samples.q.col(source.joint);
        case signal_source::kind::qd:
            return log.samples.qd.col(source.joint);
        case signal_source::kind::qdd:
            return log.samples.qdd.col(source.joint);
        case signal_source::kind::tau:
            return log.tau_rigid.col(source.joint);
        case signal_source::kind::temp:
            return log.samples.temp.col(source.joint);
        default:
            return log.samples.t;
    }
}

bool varies(const trace_fit& fit, const signal_source& source) {
    double low = 1e300;
    double high = -1e300;
    for (const traced_log& log : fit.logs()) {
        if (source.what == signal_source::kind::temp && log.samples.temp.size() == 0) {
            return false;
        }
        const Eigen::VectorXd signal = signal_of(log, source);
        low = std::min(low, signal.minCoeff());
        high = std::max(high, signal.maxCoeff());
    }
    return high - low > least_range;
}

/// Rows of the joint in one log that are away from reversals, and the samples they stand at.
struct separated_rows {
    std::vector<Eigen::Index> row;
    std::vector<Eigen::Index> sample;
};

separated_rows separated_rows_of(const traced_log& log, int joint) {
    const auto j = static_cast<std::size_t>(joint);
    const std::vector<Eigen::Index>& kept = log.rows.kept[j];
    separated_rows rows;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        if (!log.reversal[j][static_cast<Eigen::Index>(k)]) {
            rows.row.push_back(static_cast<Eigen::Index>(k));
            rows.sample.push_back(std::min(kept[k] * log.decimation, log.samples.samples() - 1));
        }
    }
    return rows;
}

}  // namespace

std::string signal_source::name() const {
    constexpr const char* names[] = {"q", "qd", "qdd", "tau", "temp"};
    return what == kind::t ? "t" : fmt::format("{}{}", names[static_cast<int>(what)], joint + 1);
}

std::vector<signal_source> sources_for(const trace_fit& fit, int joint) {
    using kind = signal_source::kind;
    const auto joints = static_cast<int>(fit.residual().front().size());
    std::vector<signal_source> all;
    for (int step = 0; step < joints; ++step) {
        const int k = step == 0 ? joint : (step <= joint ? step - 1 : step);
        for (const kind what : {kind::q, kind::qd, kind::qdd}) {
            all.push_back({what, k});
        }
    }
    all.push_back({kind::tau, joint});
    all.push_back({kind::temp, joint});
    all.push_back({kind::t, 0});
    all.erase(std::remove_if(all.begin(), all.end(), [&](const signal_source& s) { return !varies(fit, s); }),
              all.end());
    return all;
}

joint_residual residual_of(const trace_fit& fit, int joint, const std::vector<signal_source>& sources, bool held_back) {
    const auto j = static_cast<std::size_t>(joint);
    const Eigen::MatrixXd& combined = fit.combinations();
    std::vector<separated_rows> rows;
    Eigen::Index count = 0;
    for (const traced_log& log : fit.logs()) {
        rows.push_back(log.held_back == held_back ? separated_rows_of(log, joint) : separated_rows{});
        count += static_cast<Eigen::Index>(rows.back().row.size());
    }
    joint_residual all{Eigen::VectorXd(count), Eigen::MatrixXd(count, combined.cols()), Eigen::VectorXd(count),
                       Eigen::MatrixXd(count, static_cast<Eigen::Index>(sources.size()))};
    Eigen::Index first = 0;
    for (std::size_t l = 0; l < rows.size(); ++l) {
        const auto n = static_cast<Eigen::Index>(rows[l].row.size());
        if (n == 0) {
            continue;
        }
        const Eigen::VectorXd weight = fit.weight()[l][j](rows[l].row);
        all.weight.segment(first, n) = weight;
        all.left.segment(first, n) = weight.cwiseProduct(fit.residual()[l][j](rows[l].row));
        all.model.middleRows(first, n) =
            weight.asDiagonal() * (fit.columns(l, joint)(rows[l].row, Eigen::all) * combined);
        for (std::size_t s = 0; s < sources.size(); ++s) {
            all.signals.col(static_cast<Eigen::Index>(s)).segment(first, n) =
                signal_of(fit.logs()[l], sources[s])(rows[l].sample);
        }
        first += n;
    }
    return all;
}

}  // namespace idim
