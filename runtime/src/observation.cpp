#include "idim/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "idim/input_error.hpp"
#include "idim/zero_phase_filter.hpp"
#include "uniform_time.hpp"

namespace idim {
namespace {

using row_major_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void check_log(const idim_model_interface& model, const filtered_samples& samples, const filter_choice& choice) {
    if (samples.q.cols() != model.dof) {
        throw input_error({samples.file, 0, ""}, fmt::format("has {} joints, the model of {} has {}", samples.q.cols(),
                                                             model.robot, model.dof));
    }
    if (model.needs_temperature != 0 && samples.temp.size() == 0) {
        throw input_error(
            {samples.file, 0, "temp1"},
            fmt::format("this column is missing, the model of {} depends on the temperature", model.robot));
    }
    if (choice.decimation > 1) {
        const Eigen::Index needed = padding(decimation_filter(choice.decimation)) + 1;
        if (samples.samples() < needed) {
            throw input_error({samples.file, 0, ""},
                              fmt::format("{} samples are left by the filter, the decimation needs at least {}",
                                          samples.samples(), needed));
        }
    }
}

void check_finite(const idim_model_interface& model, const Eigen::RowVectorXd& W, const std::string& file, double t) {
    for (Eigen::Index k = 0; k < W.size(); ++k) {
        if (!std::isfinite(W[k])) {
            throw data_error(fmt::format("{}: the regressor of parameter {} at joint {} is {} at t = {:.6g} s", file,
                                         model.parameter_names[k % model.n_base], model.joint_names[k / model.n_base],
                                         W[k], t));
        }
    }
}

/// Regressor rows of joints first..first+count-1 at every sample: samples x (count b).
row_major_matrix sample_regressor(const idim_model_interface& model, const filtered_samples& samples, int first,
                                  int count) {
    const row_major_matrix q = samples.q;
    const row_major_matrix qd = samples.qd;
    const row_major_matrix qdd = samples.qdd;
    const row_major_matrix temp = samples.temp.size() > 0
                                      ? row_major_matrix(samples.temp)
                                      : row_major_matrix(row_major_matrix::Zero(samples.samples(), model.dof));
    const Eigen::Index b = model.n_base;
    row_major_matrix sampled(samples.samples(), count * b);
    Eigen::RowVectorXd W(model.dof * b);
    for (Eigen::Index k = 0; k < samples.samples(); ++k) {
        model.regressor(q.row(k).data(), qd.row(k).data(), qdd.row(k).data(), samples.t[k], temp.row(k).data(),
                        W.data());
        if (!W.allFinite()) {
            check_finite(model, W, samples.file, samples.t[k]);
        }
        sampled.row(k) = W.segment(first * b, count * b);
    }
    return sampled;
}

/// Joints whose full-rate rows are held at once: as many as fit in 256 MiB, so that a long log costs repeated
/// evaluations of the regressor instead of memory.
int joints_at_once(const idim_model_interface& model, Eigen::Index samples) {
    constexpr double budget = 256.0 * 1024.0 * 1024.0;
    const double one_joint = static_cast<double>(samples) * model.n_base * sizeof(double);
    return static_cast<int>(std::clamp(budget / one_joint, 1.0, static_cast<double>(model.dof)));
}

observation_block observe_log(const idim_model_interface& model, const filtered_samples& samples,
                              const filter_choice& choice) {
    observation_block block;
    block.file = samples.file;
    block.rate = samples.rate / choice.decimation;
    const Eigen::Index rows = (samples.samples() + choice.decimation - 1) / choice.decimation;
    block.t = samples.t(Eigen::seqN(0, rows, choice.decimation));
    const int step = joints_at_once(model, samples.samples());
    for (int first = 0; first < model.dof; first += step) {
        const int count = std::min(step, model.dof - first);
        const Eigen::MatrixXd W = decimate(sample_regressor(model, samples, first, count), choice.decimation);
        for (int joint = 0; joint < count; ++joint) {
            block.W.emplace_back(W.middleCols(Eigen::Index{joint} * model.n_base, model.n_base));
        }
    }
    const Eigen::MatrixXd Y =
        samples.tau.size() > 0 ? decimate(samples.tau, choice.decimation) : Eigen::MatrixXd(0, model.dof);
    for (int joint = 0; joint < model.dof; ++joint) {
        block.Y.emplace_back(Y.col(joint));
    }
    return block;
}

}  // namespace

Eigen::Index observation::rows(int joint) const {
    Eigen::Index count = 0;
    for (const observation_block& block : blocks) {
        count += block.W[joint].rows();
    }
    return count;
}

Eigen::Index observation::rows() const {
    Eigen::Index count = 0;
    for (int joint = 0; joint < dof; ++joint) {
        count += rows(joint);
    }
    return count;
}

observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                    const filter_choice& choice) {
    std::vector<named_rate> rates;
    rates.reserve(logs.size());
    for (const filtered_samples& samples : logs) {
        rates.push_back({samples.file, samples.rate});
    }
    require_common_rate(rates);
    observation rows;
    rows.dof = model.dof;
    rows.n_base = model.n_base;
    for (const filtered_samples& samples : logs) {
        check_log(model, samples, choice);
        rows.blocks.push_back(observe_log(model, samples, choice));
    }
    return rows;
}

}  // namespace idim
