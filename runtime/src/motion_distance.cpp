#include "idim/motion_distance.hpp"

#include <cmath>
#include <stdexcept>

namespace idim {

namespace {

using sample_matrix = Eigen::MatrixXd filtered_samples::*;

double distance(const std::vector<filtered_samples>& motion, const std::vector<filtered_samples>& from,
                sample_matrix which, Eigen::Index joint, double start) {
    double difference = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
        const Eigen::VectorXd& t = from[i].t;
        const Eigen::Index first = t.size() > 0 ? (t.array() < t[0] + start).count() : 0;
        const Eigen::Index count = t.size() - first;
        const auto a = (motion[i].*which).col(joint).tail(count);
        const auto b = (from[i].*which).col(joint).tail(count);
        difference += (a - b).squaredNorm();
        size += b.squaredNorm();
    }
    if (size == 0.0) {
        return difference == 0.0 ? 0.0 : 1.0;
    }
    return std::sqrt(difference / size);
}

}  // namespace

std::vector<motion_distance> distances(const std::vector<filtered_samples>& motion,
                                       const std::vector<filtered_samples>& from, double start) {
    if (motion.size() != from.size() || motion.empty()) {
        throw std::invalid_argument("distances: not the same logs");
    }
    for (std::size_t i = 0; i < motion.size(); ++i) {
        if (motion[i].q.rows() != from[i].q.rows() || motion[i].q.cols() != from[i].q.cols()) {
            throw std::invalid_argument("distances: not the same samples");
        }
    }
    std::vector<motion_distance> result;
    for (Eigen::Index j = 0; j < from.front().q.cols(); ++j) {
        result.push_back({distance(motion, from, &filtered_samples::q, j, start),
                          distance(motion, from, &filtered_samples::qd, j, start),
                          distance(motion, from, &filtered_samples::qdd, j, start)});
    }
    return result;
}

}  // namespace idim
