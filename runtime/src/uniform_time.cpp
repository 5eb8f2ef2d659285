#include "uniform_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace idim {

double median_period(const Eigen::VectorXd& t) {
    Eigen::VectorXd step = t.tail(t.size() - 1) - t.head(t.size() - 1);
    const auto middle = step.begin() + step.size() / 2;
    std::nth_element(step.begin(), middle, step.end());
    return *middle;
}

bool is_uniform(const Eigen::VectorXd& t, double tolerance) {
    const Eigen::Index n = t.size();
    const double period = (t[n - 1] - t[0]) / static_cast<double>(n - 1);
    const auto grid = t[0] + Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) * period;
    return (t.array() - grid).abs().maxCoeff() <= tolerance * period;
}

double uniform_rate(Eigen::Index samples, double duration, const input_location& where) {
    if (samples < 2) {
        throw input_error(where, fmt::format("{} samples, at least 2 are needed", samples));
    }
    return static_cast<double>(samples - 1) / duration;
}

double uniform_rate(const Eigen::VectorXd& t, const input_location& where) {
    return uniform_rate(t.size(), t.size() > 1 ? t[t.size() - 1] - t[0] : 0.0, where);
}

void require_common_rate(const std::vector<named_rate>& logs) {
    constexpr double tolerance = 0.05;
    for (const named_rate& other : logs) {
        const named_rate& first = logs.front();
        if (std::abs(other.rate - first.rate) > tolerance * first.rate) {
            throw input_error({other.file, 0, "t"},
                              fmt::format("sampled at {:.6g} Hz, but {} at {:.6g} Hz; logs used together "
                                          "need one rate",
                                          other.rate, first.file, first.rate));
        }
    }
}

}  // namespace idim
