#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace idim::undeclared {

struct value_with_deviation {
    double value = 0.0, std = 0.0;
};

/// An effect by name and where it is said to act.
struct named_effect {
    std::string name;
    std::vector<std::string> joints, from;
};

struct found_effect {
    named_effect effect;
    std::map<std::string, value_with_deviation> parameters;
    double p_value = 1.0, explained = 0.0;
    std::vector<named_effect> confusable_with;

    bool proposed() const { return effect.name.starts_with("proposed"); }
};

struct found_structure {
    std::string joint;
    std::vector<std::string> signals;
    bool has_proposal = false;
};

/// Errors of a model on some rows: {relative_error, joints: [{joint, rms, relative_error}]}.
struct model_errors {
    double relative = 0.0;
    std::vector<double> rms, joint_relative;

    double torque_norm() const;  ///< |Y| in the unit of rms
};

/// What refine said of a case.
struct finding {
    int exit_status = -1;
    bool timed_out = false;
    double seconds = 0.0;
    std::string message;  ///< the tool's last line where there is no result
    std::string verdict;
    std::vector<found_effect> steps;
    std::vector<found_structure> unexplained;
    std::vector<named_effect> not_identifiable;
    model_errors before_identification, before_validation, after_validation;

    bool ran() const { return !verdict.empty(); }
};

model_errors errors_in(const nlohmann::json& content);
/// Of a refine.json; throws nlohmann::json::exception naming the field where the contract is not kept.
void read_refinement(const nlohmann::json& content, finding& result);

}  // namespace idim::undeclared
