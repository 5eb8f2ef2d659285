#include "statistics/thinned_rows.hpp"

#include <cmath>

namespace idim {

std::vector<Eigen::Index> thinned_rows(const std::vector<Eigen::Index>& places, double correlation_length) {
    const auto distance = static_cast<Eigen::Index>(std::ceil(correlation_length));
    std::vector<Eigen::Index> rows;
    Eigen::Index next = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (k == 0 || places[k] >= next) {
            rows.push_back(static_cast<Eigen::Index>(k));
            next = places[k] + distance;
        }
    }
    return rows;
}

}  // namespace idim
