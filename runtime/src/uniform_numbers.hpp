#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace idim {

/// Random numbers that are the same with every standard library.
class uniform_numbers {
  public:
    explicit uniform_numbers(std::uint64_t seed) : random_(seed) {}

    /// In [0, 1).
    double next() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * next(); }
    /// Each in [-1, 1).
    Eigen::VectorXd vector(Eigen::Index size) {
        Eigen::VectorXd values(size);
        for (double& value : values) {
            value = 2.0 * next() - 1.0;
        }
        return values;
    }

  private:
    std::mt19937_64 random_;
};

}  // namespace idim
