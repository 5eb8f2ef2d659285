#include "idim/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "idim/input_error.hpp"
#include "idim/recorded_states.hpp"
#include "idim/zero_phase_filter.hpp"
#include "motion_filter.hpp"
#include "rest_search.hpp"
#include "uniform_time.hpp"

namespace idim {
namespace {

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
    check_decimation(samples.file, samples.samples(), choice);
}

/// Names the first element of a block of regressors that is no number; column = joint * b + parameter.
void check_finite(const idim_model_interface& model, const Eigen::MatrixXd& W, const filtered_samples& samples,
                  Eigen::Index first) {
    if (W.allFinite()) {
        return;
    }
    for (Eigen::Index k = 0; k < W.rows(); ++k) {
        for (Eigen::Index i = 0; i < W.cols(); ++i) {
            if (!std::isfinite(W(k, i))) {
                throw data_error(fmt::format("{}: the regressor of parameter {} at joint {} is {} at t = {:.6g} s",
                                             samples.file, model.parameter_names[i % model.n_base],
                                             model.joint_names[i / model.n_base], W(k, i), samples.t[first + k]));
            }
        }
    }
}

/// Of a model without a batch form.
void evaluate_one_by_one(const idim_model_interface& model, const idim_samples& samples, Eigen::MatrixXd& W) {
    using strided = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>;
    Eigen::VectorXd row = Eigen::VectorXd::Zero(W.cols());
    for (Eigen::Index k = 0; k < W.rows(); ++k) {
        const auto values = [&](const double* signal, int count) -> Eigen::VectorXd {
            return signal == nullptr ? Eigen::VectorXd::Zero(count)
                                     : Eigen::VectorXd(strided(signal + k, count,
                                                               Eigen::InnerStride<>(static_cast<int>(samples.stride))));
        };
        const auto at = [&](const double* signal) { return values(signal, model.dof); };
        model.regressor(at(samples.q).data(), at(samples.qd).data(), at(samples.qdd).data(), samples.t[k],
                        values(samples.temp, std::max(model.dof, model.n_signals)).data(), row.data());
        W.row(k) = row;
    }
}

/// Regressors of samples first..first+count-1: count x (n b).
Eigen::MatrixXd evaluate_block(const idim_model_interface& model, const filtered_samples& samples, Eigen::Index first,
                               Eigen::Index count) {
    const double* const temp = samples.temp.size() > 0 ? samples.temp.data() + first : nullptr;
    const idim_samples block = {static_cast<size_t>(count),
                                static_cast<size_t>(samples.samples()),
                                samples.q.data() + first,
                                samples.qd.data() + first,
                                samples.qdd.data() + first,
                                samples.t.data() + first,
                                temp};
    Eigen::MatrixXd W(count, Eigen::Index{model.dof} * model.n_base);
    if (model.regressor_batch != nullptr) {
        model.regressor_batch(&block, W.data(), static_cast<size_t>(count));
    } else {
        evaluate_one_by_one(model, block, W);
    }
    check_finite(model, W, samples, first);
    return W;
}

/// Regressor rows of joints first..first+count-1 at every sample: samples x (count b).
Eigen::MatrixXd sample_regressor(const idim_model_interface& model, const filtered_samples& samples, int first,
                                 int count) {
    constexpr Eigen::Index samples_at_once = 64;  // whose regressors stay in the cache
    const Eigen::Index b = model.n_base;
    Eigen::MatrixXd sampled(samples.samples(), count * b);
    for (Eigen::Index k = 0; k < samples.samples(); k += samples_at_once) {
        const Eigen::Index size = std::min(samples_at_once, samples.samples() - k);
        sampled.middleRows(k, size) = evaluate_block(model, samples, k, size).middleCols(first * b, count * b);
    }
    return sampled;
}

/// The same at the states that the torque of each joint belongs to.
Eigen::MatrixXd recorded_regressor(const idim_model_interface& model, const recorded_states& states, int first,
                                   int count) {
    const Eigen::Index b = model.n_base;
    Eigen::MatrixXd sampled(states.of(first).samples(), count * b);
    for (int joint = first; joint < first + count;) {
        int end = joint + 1;
        while (end < first + count && &states.of(end) == &states.of(joint)) {
            ++end;
        }
        sampled.middleCols((joint - first) * b, (end - joint) * b) =
            sample_regressor(model, states.of(joint), joint, end - joint);
        joint = end;
    }
    return sampled;
}

/// Joints whose full-rate rows are held at once: as many as fit in 32 MiB, which the allocator keeps instead of giving
/// them back to the system, so that a long log costs repeated evaluations of the regressor instead of memory.
int joints_at_once(const idim_model_interface& model, Eigen::Index samples) {
    constexpr double budget = 32.0 * 1024.0 * 1024.0;
    const double one_joint = static_cast<double>(samples) * model.n_base * sizeof(double);
    return static_cast<int>(std::clamp(budget / one_joint, 1.0, static_cast<double>(model.dof)));
}

/// Samples that the decimation leaves.
Eigen::Index decimated_samples(const filtered_samples& samples, const filter_choice& choice) {
    return (samples.samples() + choice.decimation - 1) / choice.decimation;
}

void check_selection(const row_selection& kept, int joints, Eigen::Index samples) {
    if (kept.size() != static_cast<std::size_t>(joints)) {
        throw std::invalid_argument(fmt::format("observe: rows of {} joints for {}", kept.size(), joints));
    }
    for (const std::vector<Eigen::Index>& places : kept) {
        const bool ascend = std::adjacent_find(places.begin(), places.end(), std::greater_equal<>()) == places.end();
        if (!ascend || (!places.empty() && (places.front() < 0 || places.back() >= samples))) {
            throw std::invalid_argument(fmt::format("observe: rows do not ascend within 0..{}", samples - 1));
        }
    }
}

/// Rows `kept` of some columns: copied as a block where they follow one another, which is much faster.
Eigen::MatrixXd rows_of(const Eigen::MatrixXd& W, const std::vector<Eigen::Index>& kept, Eigen::Index column,
                        Eigen::Index count) {
    const auto size = static_cast<Eigen::Index>(kept.size());
    if (size > 0 && kept.back() - kept.front() + 1 == size) {
        return W.block(kept.front(), column, size, count);
    }
    return W(kept, Eigen::seqN(column, count));
}

observation_block observe_log(const idim_model_interface& model, const filtered_samples& samples,
                              const filter_choice& choice, const row_selection& kept, const Eigen::VectorXd& chi) {
    observation_block block;
    block.file = samples.file;
    block.rate = samples.rate / choice.decimation;
    block.t = samples.t(Eigen::seqN(0, decimated_samples(samples, choice), choice.decimation));
    block.kept = kept;
    check_selection(kept, model.dof, block.t.size());
    const recorded_states states(model, samples, chi);
    const int step = joints_at_once(model, samples.samples());
    for (int first = 0; first < model.dof; first += step) {
        const int count = std::min(step, model.dof - first);
        const Eigen::MatrixXd W = decimate(recorded_regressor(model, states, first, count), choice.decimation);
        for (int joint = 0; joint < count; ++joint) {
            block.W.push_back(rows_of(W, kept[first + joint], Eigen::Index{joint} * model.n_base, model.n_base));
        }
    }
    block.Y.resize(static_cast<std::size_t>(model.dof));
    if (samples.tau.size() > 0) {
        const Eigen::MatrixXd Y = decimate(samples.tau, choice.decimation);
        for (int joint = 0; joint < model.dof; ++joint) {
            block.Y[joint] = Y(kept[joint], joint);
        }
    }
    return block;
}

/// Places of all samples but those of rests.
std::vector<Eigen::Index> moving_rows(const Eigen::VectorXd& speed, double part) {
    speed_extremes extremes;
    extremes.add(speed);
    rest_search search(extremes, part);
    search.add(speed);
    return rows_between(search.finish(), 0, speed.size());
}

/// Leaves out rows whose state, as long ago as the torque is late, is not in the log.
void keep_within_log(const idim_model_interface& model, const filtered_samples& samples, const filter_choice& choice,
                     row_selection& kept) {
    for (int joint = 0; joint < model.dof && model.torque_delay != nullptr; ++joint) {
        const double shift = model.torque_delay[joint] * samples.rate;
        const auto is_outside = [&](Eigen::Index row) {
            const double place = static_cast<double>(row * choice.decimation) - shift;
            return place < 0.0 || place > static_cast<double>(samples.samples() - 1);
        };
        std::vector<Eigen::Index>& places = kept[static_cast<std::size_t>(joint)];
        places.erase(std::remove_if(places.begin(), places.end(), is_outside), places.end());
    }
}

void check_common_rate(const std::vector<filtered_samples>& logs) {
    std::vector<named_rate> rates;
    rates.reserve(logs.size());
    for (const filtered_samples& samples : logs) {
        rates.push_back({samples.file, samples.rate});
    }
    require_common_rate(rates);
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

double observation::share_left_out() const {
    Eigen::Index samples = 0;
    for (const observation_block& block : blocks) {
        samples += block.t.size() * dof;
    }
    return samples > 0 ? 1.0 - static_cast<double>(rows()) / static_cast<double>(samples) : 0.0;
}

observation::column column_of(const observation& rows, int column) {
    return rows.columns.empty() ? observation::column{column, -1} : rows.columns[static_cast<std::size_t>(column)];
}

row_selection all_rows(int joints, Eigen::Index samples) {
    std::vector<Eigen::Index> places(static_cast<std::size_t>(samples));
    std::iota(places.begin(), places.end(), Eigen::Index{0});
    return row_selection(static_cast<std::size_t>(joints), places);
}

row_selection select_rows(const filtered_samples& samples, const filter_choice& choice) {
    const int joints = static_cast<int>(samples.q.cols());
    row_selection kept = all_rows(joints, decimated_samples(samples, choice));
    if (choice.minimum_speed == 0.0 || samples.samples() == 0) {
        return kept;
    }
    const Eigen::VectorXd range = samples.q.colwise().maxCoeff() - samples.q.colwise().minCoeff();
    const Eigen::MatrixXd speed = decimate(samples.qd, choice.decimation);
    for (int joint = 0; joint < joints; ++joint) {
        if (range[joint] > held_range * range.maxCoeff()) {
            kept[joint] = moving_rows(speed.col(joint), choice.minimum_speed);
        }
    }
    return kept;
}

observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                    const filter_choice& choice, const Eigen::VectorXd& chi) {
    std::vector<row_selection> kept;
    kept.reserve(logs.size());
    for (const filtered_samples& samples : logs) {
        check_log(model, samples, choice);
        kept.push_back(select_rows(samples, choice));
        keep_within_log(model, samples, choice, kept.back());
    }
    return observe(model, logs, choice, kept, chi);
}

observation observe(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                    const filter_choice& choice, const std::vector<row_selection>& kept, const Eigen::VectorXd& chi) {
    check_common_rate(logs);
    if (kept.size() != logs.size()) {
        throw std::invalid_argument(fmt::format("observe: rows of {} logs for {}", kept.size(), logs.size()));
    }
    observation rows;
    rows.dof = model.dof;
    rows.n_base = model.n_base;
    for (std::size_t i = 0; i < logs.size(); ++i) {
        check_log(model, logs[i], choice);
        rows.blocks.push_back(observe_log(model, logs[i], choice, kept[i], chi));
    }
    return rows;
}

}  // namespace idim
