#include "streaming/streamed_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "idim/input_error.hpp"
#include "idim/recorded_states.hpp"
#include "idim/streamed_identification.hpp"
#include "streaming/scratch_table.hpp"
#include "uniform_time.hpp"

namespace idim {

namespace {

constexpr Eigen::Index rows_in_part = Eigen::Index{1} << 13;
constexpr Eigen::Index longest_reach = Eigen::Index{1} << 14;

/// Successive parts of a log, held as long as a window over them moves on.
class sliding_window {
  public:
    sliding_window(const idim_model_interface& model, const decimated_log& log) : model_(model), log_(log) {}

    /// Rows from..to-1; neither may be less than before.
    observation_block rows(Eigen::Index from, Eigen::Index to) {
        while (!held_.empty() && first_ + held_.front().t.size() <= from) {
            first_ += held_.front().t.size();
            held_.pop_front();
        }
        for (; end_ < to; end_ += held_.back().t.size()) {
            held_.push_back(log_.part(model_, end_, std::min(log_.rows_at_once(), log_.rows() - end_)));
        }
        return joined(from, to);
    }

  private:
    observation_block joined(Eigen::Index from, Eigen::Index to) const {
        observation_block window;
        window.file = log_.file();
        window.rate = log_.rate();
        window.t.resize(to - from);
        const auto joints = static_cast<std::size_t>(model_.dof);
        window.kept.resize(joints);
        Eigen::Index begin = first_;
        for (const observation_block& part : held_) {
            const Eigen::Index a = std::clamp(from - begin, Eigen::Index{0}, part.t.size());
            const Eigen::Index b = std::clamp(to - begin, a, part.t.size());
            window.t.segment(begin + a - from, b - a) = part.t.segment(a, b - a);
            begin += part.t.size();
        }
        for (std::size_t j = 0; j < joints; ++j) {
            join(j, from, to, window);
        }
        return window;
    }

    void join(std::size_t joint, Eigen::Index from, Eigen::Index to, observation_block& window) const {
        std::vector<Eigen::Index>& kept = window.kept[joint];
        Eigen::MatrixXd W(to - from, model_.n_base);
        Eigen::VectorXd Y(to - from);
        Eigen::Index begin = first_;
        for (const observation_block& part : held_) {
            const row_part wanted{part, from - begin, to - from};
            const auto [first, count] = wanted.rows_of(joint);
            const auto next = static_cast<Eigen::Index>(kept.size());
            W.middleRows(next, count) = part.W[joint].middleRows(first, count);
            Y.segment(next, count) = part.Y[joint].segment(first, count);
            for (Eigen::Index k = first; k < first + count; ++k) {
                kept.push_back(part.kept[joint][static_cast<std::size_t>(k)] + begin - from);
            }
            begin += part.t.size();
        }
        const auto rows = static_cast<Eigen::Index>(kept.size());
        W.conservativeResize(rows, Eigen::NoChange);
        Y.conservativeResize(rows);
        window.W.push_back(std::move(W));
        window.Y.push_back(std::move(Y));
    }

    const idim_model_interface& model_;
    const decimated_log& log_;
    std::deque<observation_block> held_;
    Eigen::Index first_ = 0;  ///< row where the first of them begins
    Eigen::Index end_ = 0;    ///< row behind the last
};

/// A series in a temporary file: a column for each joint, not a number where a row was left out.
class stored_series : public series_source {
  public:
    stored_series(int joints, std::size_t logs) : table_(joints), rows_(logs, 0) {}

    void add(std::size_t log, const Eigen::MatrixXd& values) {
        table_.append(values);
        rows_[log] += values.rows();
    }

    void visit(const std::function<void(const std::vector<gapped_series>&, bool)>& use) const override {
        Eigen::Index place = 0;
        for (const Eigen::Index rows : rows_) {
            for (Eigen::Index first = 0; first < rows; first += rows_in_part) {
                const Eigen::Index count = std::min(rows_in_part, rows - first);
                use(pieces(table_.read(place + first, count)), first == 0);
            }
            place += rows;
        }
    }

  private:
    static std::vector<gapped_series> pieces(const Eigen::MatrixXd& values) {
        std::vector<gapped_series> joints;
        for (Eigen::Index j = 0; j < values.cols(); ++j) {
            const Eigen::ArrayXd value = values.col(j);
            joints.push_back({value.isFinite().select(value, 0.0), value.isFinite().cast<double>()});
        }
        return joints;
    }

    scratch_table table_;
    std::vector<Eigen::Index> rows_;  ///< per log
};

/// The rows of a part's residual, not a number where one was left out.
Eigen::MatrixXd residual_of(const row_part& part, const Eigen::VectorXd& chi, const std::vector<double>& joint_weight) {
    Eigen::MatrixXd values =
        Eigen::MatrixXd::Constant(part.count, static_cast<Eigen::Index>(joint_weight.size()), std::nan(""));
    for (std::size_t j = 0; j < joint_weight.size(); ++j) {
        const auto [first, count] = part.rows_of(j);
        const Eigen::VectorXd left =
            joint_weight[j] * (part.block.Y[j].segment(first, count) - part.block.W[j].middleRows(first, count) * chi);
        for (Eigen::Index k = 0; k < count; ++k) {
            const Eigen::Index place = part.block.kept[j][static_cast<std::size_t>(first + k)] - part.first;
            values(place, static_cast<Eigen::Index>(j)) = left[k];
        }
    }
    return values;
}

}  // namespace

std::string whole_log_need(const idim_model_interface& model) {
    if (model.n_states > 0) {
        return "effects with states";
    }
    if (depends_on_parameters(model)) {
        return "effects of the links' torque or soft transmissions";
    }
    if (model.torque_delay != nullptr &&
        std::any_of(model.torque_delay, model.torque_delay + model.dof, [](double delay) { return delay != 0.0; })) {
        return "delays of the torque";
    }
    if (model.parameter_is_per_log != nullptr &&
        std::any_of(model.parameter_is_per_log, model.parameter_is_per_log + model.n_base,
                    [](int per_log) { return per_log != 0; })) {
        return "parameters that are each log's own";
    }
    return {};
}

streamed_rows::streamed_rows(const idim_model_interface& model, const std::vector<stored_log>& logs,
                             const filter_choice& choice)
    : model_(model) {
    std::vector<named_rate> rates;
    for (const stored_log& log : logs) {
        if (const std::string need = whole_log_need(model); !need.empty()) {
            throw input_error(
                {log.file(), 0, ""},
                fmt::format("the model of {} has {}, which need the log in memory, expected a shorter log", model.robot,
                            need));
        }
        rates.push_back({log.file(), log.rate()});
        logs_.emplace_back(log, choice);
    }
    require_common_rate(rates);
}

Eigen::Index streamed_rows::rows(int joint) const {
    Eigen::Index count = 0;
    for (const decimated_log& log : logs_) {
        count += log.kept_rows(static_cast<std::size_t>(joint));
    }
    return count;
}

void streamed_rows::visit(Eigen::Index margin, const std::function<void(const row_part&)>& use) const {
    for (const decimated_log& log : logs_) {
        visit(log, margin, use);
    }
}

void streamed_rows::visit(const decimated_log& log, Eigen::Index margin,
                          const std::function<void(const row_part&)>& use) const {
    if (margin == 0) {
        for (Eigen::Index first = 0; first < log.rows(); first += log.rows_at_once()) {
            const Eigen::Index count = std::min(log.rows_at_once(), log.rows() - first);
            const observation_block block = log.part(model_, first, count);
            use({block, 0, count, std::min(log.rows(), longest_reach), first == 0});
        }
        return;
    }
    sliding_window window(model_, log);
    for (Eigen::Index first = 0; first < log.rows(); first += rows_in_part) {
        const Eigen::Index count = std::min(rows_in_part, log.rows() - first);
        const Eigen::Index from = std::max(Eigen::Index{0}, first - margin);
        const Eigen::Index to = std::min(log.rows(), first + count + margin);
        const observation_block block = window.rows(from, to);
        use({block, first - from, count, std::min(log.rows(), longest_reach), from == 0});
    }
}

std::unique_ptr<series_source> streamed_rows::residual(const Eigen::VectorXd& chi,
                                                       const std::vector<double>& joint_weight) const {
    auto series = std::make_unique<stored_series>(model_.dof, logs_.size());
    for (std::size_t i = 0; i < logs_.size(); ++i) {
        visit(logs_[i], 0, [&](const row_part& part) { series->add(i, residual_of(part, chi, joint_weight)); });
    }
    return series;
}

}  // namespace idim
