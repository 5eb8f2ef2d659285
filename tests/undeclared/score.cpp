#include "undeclared/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace idim::undeclared {

namespace {

constexpr double interval = 1.96;  // deviations of 95 %
constexpr double shape_tolerance = 0.05;

std::string joint_name(int joint) {
    return "j" + std::to_string(joint + 1);
}

bool of_the_robot(const std::string& name) {
    return name == "base_tilt";
}

/// Whether the joints of a finding are those of the truth, whichever way round where the effect is symmetric.
bool same_joints(const missing_effect& truth, const named_effect& found) {
    if (of_the_robot(found.name)) {
        return true;
    }
    if (found.name == "joint_coupling") {
        std::set<std::string> all(found.joints.begin(), found.joints.end());
        all.insert(found.from.begin(), found.from.end());
        return all == std::set<std::string>{joint_name(truth.joint), joint_name(truth.other)};
    }
    const bool first = !found.joints.empty() && found.joints.front() == joint_name(truth.joint);
    return first && (found.name != "coupling_friction" || found.from.empty() || truth.other < 0 ||
                     found.from.front() == joint_name(truth.other));
}

bool names(const missing_effect& truth, const named_effect& found) {
    return !truth.name.empty() && found.name == truth.name && same_joints(truth, found);
}

bool in_family(const missing_effect& truth, const found_effect& step) {
    return names(truth, step.effect) || std::any_of(step.confusable_with.begin(), step.confusable_with.end(),
                                                    [&](const named_effect& other) { return names(truth, other); });
}

/// Amplitude of a pair of coefficients; its deviation to first order.
value_with_deviation amplitude(const value_with_deviation& a, const value_with_deviation& b) {
    const double size = std::hypot(a.value, b.value);
    return {size, std::hypot(a.value * a.std, b.value * b.std) / size};
}

void compare_size(const std::string& name, const value_with_deviation& found, double truth, scored_effect& result) {
    ++result.sizes;
    result.sizes_right += std::abs(found.value - truth) <= interval * found.std ? 1 : 0;
    result.compared += fmt::format(" {}={:.4g}+-{:.2g}({:.4g})", name, found.value, found.std, truth);
}

void compare_shape(const std::string& name, const value_with_deviation& found, double truth, scored_effect& result) {
    ++result.shapes;
    result.shapes_right += std::abs(found.value - truth) <= shape_tolerance * std::abs(truth) ? 1 : 0;
    result.compared += fmt::format(" {}={:.4g}({:.4g})", name, found.value, truth);
}

/// Sizes of the plant under the names and in the units that the catalogue has for them.
std::map<std::string, double> catalogue_shapes_of(const missing_effect& truth) {
    std::map<std::string, double> shapes = truth.shape;
    const auto rename = [&](const char* own, const char* name, auto convert) {
        if (const auto found = truth.linear.find(own); found != truth.linear.end()) {
            shapes[name] = convert(found->second);
        }
    };
    const auto same = [](double value) { return value; };
    rename("compliance", "K", [](double value) { return 1.0 / value; });
    rename("gap", "b", same);
    rename("stretch", "zs", same);
    rename("gain", "Ke", same);
    rename("Td", "Td", same);
    rename("tilt_x", "tilt_x", same);
    rename("tilt_y", "tilt_y", same);
    return shapes;
}

/// Coefficients that both have. A pair of one wave is compared by its amplitude: its phase depends on the wave number.
/// The load's ten parameters and the constant of a spring are partly the model's, so they are not compared.
void compare_coefficients(const missing_effect& truth, const found_effect& step, scored_effect& result) {
    const std::vector<std::pair<std::string, std::string>> waves = {{"Ac", "As"}, {"Kc", "Ks"}, {"Fcc", "Fcs"}};
    std::set<std::string> done = {"K0", "T0", "M"};
    for (const auto& [cosine, sine] : waves) {
        if (truth.linear.count(sine) && step.parameters.count(cosine) && step.parameters.count(sine)) {
            compare_size("amplitude", amplitude(step.parameters.at(cosine), step.parameters.at(sine)),
                         std::hypot(truth.size(cosine), truth.size(sine)), result);
            done.insert({cosine, sine});
        }
    }
    const std::map<std::string, double> shapes = catalogue_shapes_of(truth);
    for (const auto& [name, value] : truth.linear) {
        if (!done.count(name) && !shapes.count(name) && step.parameters.count(name)) {
            compare_size(name, step.parameters.at(name), value, result);
        }
    }
    for (const auto& [name, value] : shapes) {
        if (!done.count(name) && step.parameters.count(name)) {
            compare_shape(name, step.parameters.at(name), value, result);
        }
    }
}

scored_effect score_effect(const missing_effect& truth, const finding& found) {
    scored_effect result;
    if (!found.steps.empty()) {
        result.right_joint = same_joints(truth, found.steps.front().effect);
    }
    for (const found_effect& step : found.steps) {
        if (!in_family(truth, step)) {
            continue;
        }
        result.named = result.right_joint = true;
        result.exactly = names(truth, step.effect);
        result.p_value = step.p_value;
        result.explained = step.explained;
        if (result.exactly && truth.form == truth.name) {
            compare_coefficients(truth, step, result);
        }
        return result;
    }
    return result;
}

/// Effects of the catalogue that were added and name nothing missing; a proposal claims no name.
int surplus_in(const bench_case& made, const finding& found) {
    std::vector<bool> taken(made.effects.size(), false);
    int surplus = 0;
    for (const found_effect& step : found.steps) {
        bool right = false;
        for (std::size_t i = 0; i < made.effects.size() && !right; ++i) {
            right = !taken[i] && in_family(made.effects[i], step);
            taken[i] = taken[i] || right;
        }
        surplus += right ? 0 : 1;
    }
    return surplus;
}

bool structure_in(const missing_effect& truth, const finding& found) {
    const std::string other = std::to_string(truth.other + 1);
    return std::any_of(found.unexplained.begin(), found.unexplained.end(), [&](const found_structure& structure) {
        return structure.joint == joint_name(truth.joint) &&
               std::find(structure.signals.begin(), structure.signals.end(), "q" + other) != structure.signals.end();
    });
}

void score_errors(const bench_case& made, const finding& found, const model_errors& true_model, score& result) {
    constexpr double rounding = 1e-9;
    result.worse = found.after_validation.relative > found.before_validation.relative * (1.0 + rounding);
    double sum = 0.0;
    for (std::size_t j = 0; j < true_model.rms.size(); ++j) {
        sum += true_model.rms[j] * true_model.rms[j];
        result.worst_joint_ratio =
            std::max(result.worst_joint_ratio, found.after_validation.rms.at(j) / true_model.rms[j]);
    }
    result.ratio = found.after_validation.relative * found.before_validation.torque_norm() / std::sqrt(sum);
    for (const int j : made.shows_at) {
        const std::size_t i = static_cast<std::size_t>(j);
        const double with = found.before_validation.rms.at(i), without = true_model.rms.at(i);
        result.rho_in_tool_band =
            std::max(result.rho_in_tool_band, std::sqrt(std::max(0.0, with * with - without * without)) / without);
    }
}

}  // namespace

score score_of(const bench_case& made, const finding& found, const model_errors& true_model) {
    score result;
    if (!found.ran()) {
        result.named_as = found.timed_out ? "timeout" : "failed";
        result.effects.resize(made.effects.size());
        return result;
    }
    result.steps = static_cast<int>(found.steps.size());
    result.named_as =
        found.steps.empty() ? (found.unexplained.empty() ? "none" : "unexplained") : found.steps.front().effect.name;
    for (const missing_effect& truth : made.effects) {
        result.effects.push_back(score_effect(truth, found));
    }
    result.surplus = surplus_in(made, found);
    score_errors(made, found, true_model, result);
    if (!made.effects.empty()) {
        const missing_effect& truth = made.effects.front();
        result.structure_found = truth.other >= 0 && structure_in(truth, found);
        result.span_said = std::any_of(found.not_identifiable.begin(), found.not_identifiable.end(),
                                       [&](const named_effect& entry) { return names(truth, entry); });
    }
    return result;
}

}  // namespace idim::undeclared
