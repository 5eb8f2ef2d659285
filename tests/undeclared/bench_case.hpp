#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "undeclared/declared_span.hpp"

namespace idim::undeclared {

/// A robot with something missing in its description, made from the name of a class and a seed.
struct bench_case {
    std::string class_name;
    std::uint64_t seed = 0;
    arm robot;             ///< without the effects
    declaration declared;  ///< what the description has
    std::vector<missing_effect> effects;
    double rho = 0.0;              ///< asked for; 0 where nothing is missing
    std::vector<double> rho_made;  ///< of each effect alone, at the joint where it shows most
    std::vector<int> shows_at;     ///< that joint
    recording_settings settings;
    std::vector<recording> identification, validation;
};

/// nothing, sticking, near, outside, span, two, and every form of the catalogue.
const std::vector<std::string>& case_classes();

/// Throws std::invalid_argument for another class, std::runtime_error where no robot could be found for it.
bench_case make_case(const std::string& class_name, std::uint64_t seed);

/// robot.yaml, ident1.csv.. and valid1.csv..: all that a tool may see.
void write_case(const bench_case& made, const std::string& folder);
/// The same logs without the effects (`twin_ident1.csv`..), truth.json, and the arm's standard parameters
/// (parameters.yaml).
void write_truth(const bench_case& made, const std::string& folder);

}  // namespace idim::undeclared
