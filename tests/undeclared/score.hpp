#pragma once

#include <string>
#include <vector>

#include "undeclared/bench_case.hpp"
#include "undeclared/finding.hpp"

namespace idim::undeclared {

/// One effect that was missing, and what came of it.
struct scored_effect {
    bool named = false;                ///< by its name, or by a family that has it
    bool exactly = false;              ///< by its name
    bool right_joint = false;          ///< of the step that names it; of the first step where none does
    int sizes = 0, sizes_right = 0;    ///< linear coefficients compared, and within 1.96 deviations
    int shapes = 0, shapes_right = 0;  ///< shape coefficients compared, and within 5 %
    double p_value = 1.0, explained = 0.0;
    std::string compared;  ///< each coefficient: found, deviation, truth
};

struct score {
    std::vector<scored_effect> effects;
    int steps = 0, surplus = 0;  ///< effects added, and those that name nothing that is missing
    bool worse = false;          ///< error on validation above that before
    double ratio = 0.0;          ///< error on validation to the true model's
    double worst_joint_ratio = 0.0;
    double rho_in_tool_band = 0.0;  ///< from the errors before and those of the true model
    bool span_said = false;         ///< listed as not identifiable
    bool structure_found = false;   ///< outside the catalogue: right joint, and one of the right signals
    std::string named_as;           ///< for the confusion matrix: the first step's name, none, or failed
};

score score_of(const bench_case& made, const finding& found, const model_errors& true_model);

}  // namespace idim::undeclared
