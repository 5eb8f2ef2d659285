#include "undeclared/sampler.hpp"

#include <numbers>

namespace idim::undeclared {

namespace {

/// FNV-1a, so that streams of different names have nothing in common.
std::uint64_t mixed(const std::string& name, std::uint64_t seed) {
    std::uint64_t hash = 0xcbf29ce484222325ULL ^ (seed * 0x9e3779b97f4a7c15ULL);
    for (const char c : name) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
    return hash;
}

}  // namespace

sampler::sampler(const std::string& name, std::uint64_t seed) : engine_(mixed(name, seed)) {}

double sampler::normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    return radius * std::cos(2.0 * std::numbers::pi * unit());
}

}  // namespace idim::undeclared
