#include "streaming/filtered_log.hpp"

#include <algorithm>

namespace idim {

filtered_log::filtered_log(const stored_log& data, const filter_choice& choice)
    : data_(&data), filter_({data.file(), data.samples(), data.rate()}, choice) {}

filtered_samples filtered_log::part(Eigen::Index first, Eigen::Index count) const {
    const Eigen::Index begin = first + filter_.edge();
    const Eigen::Index from = std::max(Eigen::Index{0}, begin - filter_.reach());
    const Eigen::Index to = std::min(data_->samples(), begin + count + filter_.reach());
    return filter_.apply(data_->part(from, to - from), begin - from, count);
}

filtered_samples resident_motion::part(Eigen::Index first, Eigen::Index count) const {
    const auto rows = [&](const Eigen::MatrixXd& signal) {
        return signal.size() == 0 ? Eigen::MatrixXd() : Eigen::MatrixXd(signal.middleRows(first, count));
    };
    filtered_samples samples;
    samples.file = all_.file;
    samples.rate = all_.rate;
    samples.t = all_.t.segment(first, count);
    samples.q = rows(all_.q);
    samples.qd = rows(all_.qd);
    samples.qdd = rows(all_.qdd);
    samples.tau = rows(all_.tau);
    samples.temp = rows(all_.temp);
    return samples;
}

std::unique_ptr<motion_source> filter_log(const stored_log& data, const filter_choice& choice) {
    return std::make_unique<filtered_log>(data, choice);
}

}  // namespace idim
