#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace idim::undeclared {

/// Random numbers that depend on a name and a seed alone: the distributions of the standard library differ from one
/// library to the next, so these are our own over its generator.
class sampler {
  public:
    sampler(const std::string& name, std::uint64_t seed);

    double uniform(double low, double high) { return low + (high - low) * unit(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
    double sign() { return unit() < 0.5 ? -1.0 : 1.0; }
    bool chance(double probability) { return unit() < probability; }
    int below(int count) { return static_cast<int>(unit() * count); }
    double normal();  ///< mean 0, deviation 1; Box and Muller 1958

    template <typename T>
    T pick(std::initializer_list<T> values) {
        return values.begin()[below(static_cast<int>(values.size()))];
    }
    template <typename T>
    const T& pick(const std::vector<T>& values) {
        return values[static_cast<std::size_t>(below(static_cast<int>(values.size())))];
    }

  private:
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

    std::mt19937_64 engine_;
};

}  // namespace idim::undeclared
