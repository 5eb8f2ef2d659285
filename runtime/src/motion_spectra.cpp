#include "motion_spectra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "idim/filtered_samples.hpp"
#include "idim/input_error.hpp"
#include "uniform_time.hpp"

namespace idim {

namespace {

constexpr Eigen::Index shortest_log = 64;  // samples, for segments of 16
// Samples by which the segments are chosen, 2^16 at most: a longer log gives more of them instead of a finer grid.
constexpr Eigen::Index longest_span = Eigen::Index{1} << 18;

/// Range of every joint's position, and what tells a motion from noise.
struct motion_extent {
    Eigen::VectorXd range;
    Eigen::VectorXd step_square;  ///< sum of squared differences of successive positions
    Eigen::VectorXd spread;       ///< sum of squared deviations from the mean
};

motion_extent extent_of(const readable_log& data) {
    constexpr Eigen::Index at_once = Eigen::Index{1} << 16;
    Eigen::RowVectorXd lowest = data.part(0, 1).q.row(0);
    Eigen::RowVectorXd highest = lowest;
    Eigen::RowVectorXd steps = Eigen::RowVectorXd::Zero(lowest.size());
    // About the first position, so that the sums of squares lose nothing to a mean far from zero.
    const Eigen::RowVectorXd origin = lowest;
    Eigen::RowVectorXd sum = steps;
    Eigen::RowVectorXd square = steps;
    Eigen::RowVectorXd last = origin;
    for (Eigen::Index first = 0; first < data.samples; first += at_once) {
        const Eigen::MatrixXd q = data.part(first, std::min(at_once, data.samples - first)).q;
        lowest = lowest.cwiseMin(q.colwise().minCoeff());
        highest = highest.cwiseMax(q.colwise().maxCoeff());
        const Eigen::MatrixXd moved = q.rowwise() - origin;
        sum += moved.colwise().sum();
        square += moved.colwise().squaredNorm();
        steps += (q.row(0) - last).cwiseAbs2() +
                 (q.bottomRows(q.rows() - 1) - q.topRows(q.rows() - 1)).colwise().squaredNorm();
        last = q.row(q.rows() - 1);
    }
    return {highest - lowest, steps, square - sum.cwiseAbs2() / static_cast<double>(data.samples)};
}

/// Joints that move: a held one drifts by less than held_range of the largest range of any joint, or shows noise alone,
/// whose steps are as large as its spread (von Neumann's ratio, 2 for white noise).
std::vector<Eigen::Index> moving_joints(const readable_log& data) {
    const motion_extent extent = extent_of(data);
    std::vector<Eigen::Index> joints;
    for (Eigen::Index joint = 0; joint < extent.range.size(); ++joint) {
        if (extent.range[joint] > held_range * extent.range.maxCoeff() &&
            extent.step_square[joint] < 0.1 * extent.spread[joint]) {
            joints.push_back(joint);
        }
    }
    return joints;
}

/// Averages of one joint's spectra, segment by segment.
struct joint_averages {
    Eigen::Index joint = 0;
    welch_average position;
    welch_average acceleration;
    welch_average torque;
};

void add_segment(const log& part, double rate, Eigen::Index segment, joint_averages& averages) {
    const Eigen::VectorXd q = part.q.col(averages.joint);
    averages.position.add(q.head(segment));
    if (part.tau.size() > 0) {
        averages.torque.add(part.tau.col(averages.joint).head(segment));
    }
    if (q.size() == segment + 2) {
        averages.acceleration.add((q.tail(segment) - 2.0 * q.segment(1, segment) + q.head(segment)) * (rate * rate));
    }
}

}  // namespace

void append_spectra(const readable_log& data, std::vector<joint_spectra>& spectra) {
    if (data.samples < shortest_log) {
        throw input_error(
            {data.file, 0, ""},
            fmt::format("{} samples, choosing the filter from the data needs at least {}; give the cut-off and the "
                        "decimation",
                        data.samples, shortest_log));
    }
    const Eigen::Index segment = welch_segment(std::min(data.samples - 2, longest_span));
    const welch_average empty(data.rate, segment);
    std::vector<joint_averages> averages;
    for (const Eigen::Index joint : moving_joints(data)) {
        averages.push_back({joint, empty, empty, empty});
    }
    bool has_torque = false;
    for (Eigen::Index first = 0; first + segment <= data.samples; first += empty.step()) {
        const log part = data.part(first, std::min(segment + 2, data.samples - first));
        has_torque = part.tau.size() > 0;
        for (joint_averages& of_joint : averages) {
            add_segment(part, data.rate, segment, of_joint);
        }
    }
    const double resolution = data.rate / static_cast<double>(segment);
    for (const joint_averages& of_joint : averages) {
        joint_spectra found;
        found.acceleration = of_joint.acceleration.spectrum();
        if (has_torque) {
            found.torque = of_joint.torque.spectrum();
        }
        // Four bins: clear of the main lobe of the Hann window around 0, and a half octave holds at least one bin.
        found.lowest = std::max(energy_frequency(of_joint.position.spectrum(), 0.99, data.rate), 4.0 * resolution);
        spectra.push_back(std::move(found));
    }
}

readable_log readable_in_memory(const log& data) {
    const auto uniform = std::make_shared<const log>(resample_uniform(data));
    const auto part = [uniform](Eigen::Index first, Eigen::Index count) {
        log rows;
        rows.q = uniform->q.middleRows(first, count);
        if (uniform->tau.size() > 0) {
            rows.tau = uniform->tau.middleRows(first, count);
        }
        return rows;
    };
    return {data.file, uniform->samples(), uniform_rate(uniform->t, {data.file, 0, "t"}), part};
}

}  // namespace idim
