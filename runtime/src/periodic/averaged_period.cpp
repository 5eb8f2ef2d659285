#include <utility>

#include "periodic/folded_period.hpp"

namespace idim {

Eigen::MatrixXd mean_period(const Eigen::MatrixXd& signal, const periodic_part& part) {
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(part.period, signal.cols());
    for (Eigen::Index p = 0; p < part.periods; ++p) {
        mean += signal.middleRows(part.first + p * part.period, part.period);
    }
    return mean / static_cast<double>(part.periods);
}

Eigen::Index period_margin(const filter_choice& choice) {
    return Eigen::Index{25} * choice.decimation;
}

Eigen::Index rows_in_period(const periodic_part& part, const filter_choice& choice) {
    return (part.period + choice.decimation - 1) / choice.decimation;
}

filtered_samples average_periods(const filtered_samples& samples, const periodic_part& part,
                                 const filter_choice& choice) {
    const Eigen::Index margin = period_margin(choice);
    const Eigen::Index n = part.period + 2 * margin;
    std::vector<Eigen::Index> place;
    for (Eigen::Index k = 0; k < n; ++k) {
        place.push_back(((k - margin) % part.period + part.period) % part.period);
    }
    const auto average = [&](const Eigen::MatrixXd& signal) {
        return signal.size() == 0 ? Eigen::MatrixXd() : Eigen::MatrixXd(mean_period(signal, part)(place, Eigen::all));
    };
    filtered_samples mean;
    mean.file = samples.file;
    mean.rate = samples.rate;
    const double start = samples.t[part.first] - static_cast<double>(margin) / samples.rate;
    mean.t = start + Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / samples.rate);
    mean.q = average(samples.q);
    mean.qd = average(samples.qd);
    mean.qdd = average(samples.qdd);
    mean.tau = average(samples.tau);
    mean.temp = average(samples.temp);
    return mean;
}

observation rows_of_period(observation rows, const std::vector<periodic_part>& parts, const filter_choice& choice) {
    const Eigen::Index lead = period_margin(choice) / choice.decimation;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        observation_block& block = rows.blocks[i];
        const Eigen::Index count = rows_in_period(parts[i], choice);
        block.t = Eigen::VectorXd(block.t.segment(lead, count));
        for (std::size_t j = 0; j < block.kept.size(); ++j) {
            std::vector<Eigen::Index> inside;
            std::vector<Eigen::Index> kept;
            for (std::size_t k = 0; k < block.kept[j].size(); ++k) {
                const Eigen::Index place = block.kept[j][k] - lead;
                if (place >= 0 && place < count) {
                    inside.push_back(static_cast<Eigen::Index>(k));
                    kept.push_back(place);
                }
            }
            block.W[j] = Eigen::MatrixXd(block.W[j](inside, Eigen::all));
            block.Y[j] = Eigen::VectorXd(block.Y[j](inside));
            block.kept[j] = std::move(kept);
        }
    }
    return rows;
}

}  // namespace idim
