#include <algorithm>
#include <array>
#include <utility>

#include "periodic/folded_period.hpp"

namespace idim {

namespace {

void add_to(Eigen::MatrixXd& sum, const Eigen::MatrixXd& signal, Eigen::Index first, const periodic_part& part) {
    if (sum.size() == 0 && signal.size() > 0) {
        sum = Eigen::MatrixXd::Zero(part.period, signal.cols());
    }
    if (signal.size() > 0) {
        sum.middleRows(first, signal.rows()) += signal;
    }
}

}  // namespace

filtered_samples mean_period(const motion_source& motion, const periodic_part& part) {
    constexpr Eigen::Index at_once = Eigen::Index{1} << 14;
    constexpr std::array signals = {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd,
                                    &filtered_samples::tau, &filtered_samples::temp};
    filtered_samples mean;
    mean.file = motion.file();
    mean.rate = motion.rate();
    mean.t.resize(part.period);
    for (Eigen::Index p = 0; p < part.periods; ++p) {
        for (Eigen::Index first = 0; first < part.period; first += at_once) {
            const Eigen::Index count = std::min(at_once, part.period - first);
            const filtered_samples samples = motion.part(part.first + p * part.period + first, count);
            if (p == 0) {
                mean.t.segment(first, count) = samples.t;
            }
            for (const auto signal : signals) {
                add_to(mean.*signal, samples.*signal, first, part);
            }
        }
    }
    for (const auto signal : signals) {
        mean.*signal /= static_cast<double>(part.periods);
    }
    return mean;
}

Eigen::Index period_margin(const filter_choice& choice) {
    return Eigen::Index{25} * choice.decimation;
}

Eigen::Index rows_in_period(const periodic_part& part, const filter_choice& choice) {
    return (part.period + choice.decimation - 1) / choice.decimation;
}

filtered_samples average_periods(const motion_source& motion, const periodic_part& part, const filter_choice& choice) {
    const Eigen::Index margin = period_margin(choice);
    const Eigen::Index n = part.period + 2 * margin;
    std::vector<Eigen::Index> place;
    for (Eigen::Index k = 0; k < n; ++k) {
        place.push_back(((k - margin) % part.period + part.period) % part.period);
    }
    filtered_samples mean = mean_period(motion, part);
    const double start = mean.t[0] - static_cast<double>(margin) / mean.rate;
    mean.t = start + Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / mean.rate);
    for (const auto signal : {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd,
                              &filtered_samples::tau, &filtered_samples::temp}) {
        if ((mean.*signal).size() > 0) {
            mean.*signal = Eigen::MatrixXd((mean.*signal)(place, Eigen::all));
        }
    }
    return mean;
}

filtered_samples average_periods(const filtered_samples& samples, const periodic_part& part,
                                 const filter_choice& choice) {
    return average_periods(resident_motion(samples), part, choice);
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
