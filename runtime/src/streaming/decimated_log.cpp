#include "streaming/decimated_log.hpp"

#include <algorithm>

#include "idim/zero_phase_filter.hpp"

namespace idim {

namespace {

constexpr Eigen::Index fewest_samples_at_once = Eigen::Index{1} << 11;  // whose regressors stay in the cache
constexpr Eigen::Index times_reach = 6;                                 // so that little is filtered twice

/// Rows of the decimation filter's memory, at least those that its ends are continued by.
Eigen::Index decimation_reach(int decimation) {
    if (decimation == 1) {
        return 0;
    }
    const second_order_sections filter = decimation_filter(decimation);
    return (std::max(settling(filter), padding(filter) + 1) + decimation - 1) / decimation;
}

}  // namespace

decimated_log::decimated_log(const stored_log& data, const filter_choice& choice)
    : samples_(data, choice),
      choice_(choice),
      rows_((samples_.samples() + choice.decimation - 1) / choice.decimation),
      reach_(decimation_reach(choice.decimation)) {
    check_decimation(data.file(), samples_.samples(), choice);
    find_rests();
}

Eigen::Index decimated_log::rows_at_once() const {
    return std::max(fewest_samples_at_once / choice_.decimation, times_reach * reach_);
}

decimated_log::window decimated_log::around(Eigen::Index first, Eigen::Index count) const {
    const Eigen::Index from = std::max(Eigen::Index{0}, first - reach_);
    const Eigen::Index to = std::min(samples_.samples(), (first + count + reach_) * choice_.decimation);
    const Eigen::Index begin = from * choice_.decimation;
    return {samples_.part(begin, to - begin), first - from};
}

void decimated_log::for_speeds(
    const std::function<void(const Eigen::MatrixXd& q, const Eigen::MatrixXd& speed)>& use) const {
    for (Eigen::Index first = 0; first < rows_; first += rows_at_once()) {
        const Eigen::Index count = std::min(rows_at_once(), rows_ - first);
        const window part = around(first, count);
        use(part.samples.q, decimate(part.samples.qd, choice_.decimation).middleRows(part.lead, count));
    }
}

void decimated_log::find_rests() {
    Eigen::RowVectorXd lowest;
    Eigen::RowVectorXd highest;
    std::vector<speed_extremes> extremes;
    for_speeds([&](const Eigen::MatrixXd& q, const Eigen::MatrixXd& speed) {
        if (extremes.empty()) {
            extremes.resize(static_cast<std::size_t>(q.cols()));
            lowest = highest = q.row(0);
        }
        lowest = lowest.cwiseMin(q.colwise().minCoeff());
        highest = highest.cwiseMax(q.colwise().maxCoeff());
        for (std::size_t j = 0; j < extremes.size(); ++j) {
            extremes[j].add(speed.col(static_cast<Eigen::Index>(j)));
        }
    });
    rests_.resize(extremes.size());
    if (choice_.minimum_speed == 0.0) {
        return;
    }
    const Eigen::RowVectorXd range = highest - lowest;
    std::vector<rest_search> searches;
    for (const speed_extremes& of_joint : extremes) {
        searches.emplace_back(of_joint, choice_.minimum_speed);
    }
    for_speeds([&](const Eigen::MatrixXd& /*q*/, const Eigen::MatrixXd& speed) {
        for (std::size_t j = 0; j < searches.size(); ++j) {
            searches[j].add(speed.col(static_cast<Eigen::Index>(j)));
        }
    });
    for (std::size_t j = 0; j < searches.size(); ++j) {
        if (range[static_cast<Eigen::Index>(j)] > held_range * range.maxCoeff()) {
            rests_[j] = searches[j].finish();
        }
    }
}

Eigen::Index decimated_log::kept_rows(std::size_t joint) const {
    Eigen::Index count = rows_;
    for (const sample_run& rest : rests_[joint]) {
        count -= rest.end - rest.begin;
    }
    return count;
}

observation_block decimated_log::part(const idim_model_interface& model, Eigen::Index first, Eigen::Index count) const {
    const window wide = around(first, count);
    row_selection places;
    for (const std::vector<sample_run>& rests : rests_) {
        places.push_back(rows_between(rests, first, count));
        for (Eigen::Index& place : places.back()) {
            place += wide.lead;
        }
    }
    observation rows = observe(model, {wide.samples}, choice_, std::vector<row_selection>{places});
    observation_block& block = rows.blocks.front();
    block.t = Eigen::VectorXd(block.t.segment(wide.lead, count));
    for (std::vector<Eigen::Index>& kept : block.kept) {
        for (Eigen::Index& place : kept) {
            place -= wide.lead;
        }
    }
    return std::move(block);
}

}  // namespace idim
