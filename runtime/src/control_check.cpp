#include "idim/control_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "idim/input_error.hpp"

namespace idim {

namespace {

constexpr int longest_delay = 20;  // samples, either way

/// Rows: samples; columns: joints.
Eigen::MatrixXd difference(const Eigen::MatrixXd& signal, double rate) {
    const Eigen::Index rows = signal.rows();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, signal.cols());
    result.bottomRows(rows - 1) = rate * (signal.bottomRows(rows - 1) - signal.topRows(rows - 1));
    return result;
}

Eigen::MatrixXd computed_command(const control_law& declared, const log& recorded) {
    const std::unique_ptr<control_law> law = declared.clone();
    law->reset();
    const Eigen::MatrixXd qd = recorded.qd.size() > 0 ? recorded.qd : difference(recorded.q, law->rate);
    const Eigen::MatrixXd qdr = difference(recorded.qr, law->rate);
    const Eigen::MatrixXd qddr = difference(qdr, law->rate);
    Eigen::MatrixXd command(recorded.q.rows(), recorded.q.cols());
    control_sample sample;
    for (Eigen::Index k = 0; k < recorded.samples(); ++k) {
        sample.t = recorded.t[k];
        sample.qr = recorded.qr.row(k);
        sample.qdr = qdr.row(k);
        sample.qddr = qddr.row(k);
        sample.q = recorded.q.row(k);
        sample.qd = qd.row(k);
        command.row(k) = law->command(sample);
    }
    return command;
}

/// Of recorded[k] - computed[k - delay], over the same samples for every delay.
double rms_at(const Eigen::VectorXd& recorded, const Eigen::VectorXd& computed, int delay, int settling) {
    const Eigen::Index first = settling + longest_delay;
    const Eigen::Index count = recorded.size() - first - longest_delay;
    return std::sqrt((recorded.segment(first, count) - computed.segment(first - delay, count)).squaredNorm() /
                     static_cast<double>(count));
}

joint_control_check check_joint(const Eigen::VectorXd& recorded, const Eigen::VectorXd& computed, int settling) {
    const Eigen::Index count = recorded.size() - settling;
    joint_control_check result;
    result.recorded_rms = std::sqrt(recorded.tail(count).squaredNorm() / static_cast<double>(count));
    result.rms = std::sqrt((recorded - computed).tail(count).squaredNorm() / static_cast<double>(count));
    result.share = result.recorded_rms > 0.0 ? result.rms / result.recorded_rms : 0.0;
    result.best_rms = rms_at(recorded, computed, 0, settling);
    for (int delay = -longest_delay; delay <= longest_delay; ++delay) {
        const double rms = rms_at(recorded, computed, delay, settling);
        if (rms < result.best_rms) {
            result.best_rms = rms;
            result.best_delay = delay;
        }
    }
    return result;
}

void require_usable(const control_law& law, const log& recorded, int settling) {
    if (recorded.qr.size() == 0) {
        throw input_error({recorded.file, 1, "qr1"}, "missing, expected the reference that the law followed");
    }
    const Eigen::Index least = settling + 4 * longest_delay;
    if (recorded.samples() < least) {
        throw input_error({recorded.file, 0, ""},
                          fmt::format("{} samples, expected at least {}", recorded.samples(), least));
    }
    const double rate = static_cast<double>(recorded.samples() - 1) / recorded.duration();
    if (std::abs(rate / law.rate - 1.0) > 0.01) {
        throw input_error({recorded.file, 0, "t"},
                          fmt::format("{:.6g} Hz, expected the rate of the control law, {} Hz", rate, law.rate));
    }
}

}  // namespace

std::vector<joint_control_check> check_control(const control_law& law, const log& recorded, int settling) {
    require_usable(law, recorded, settling);
    const Eigen::MatrixXd computed = computed_command(law, recorded);
    std::vector<joint_control_check> joints;
    for (Eigen::Index j = 0; j < computed.cols(); ++j) {
        const Eigen::VectorXd command = recorded.v.size() > 0
                                            ? Eigen::VectorXd(recorded.v.col(j))
                                            : Eigen::VectorXd(recorded.tau.col(j) / law.drive_gain[j]);
        joints.push_back(check_joint(command, computed.col(j), settling));
    }
    return joints;
}

}  // namespace idim
