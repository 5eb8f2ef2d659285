#include "candidate_list.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "declared_terms.hpp"
#include "expression_candidate.hpp"
#include "model_candidates.hpp"

namespace idim {

namespace {

/// Where the linearisation of a delay starts: a quarter of a sample.
constexpr double first_delay = 0.25;

/// Whether the rotor of joint j is declared and the model cannot tell its inertia from the link's.
bool has_lumped_rotor(const trace_input& input, int j) {
    const effect_place rotor{"rotor_inertia", {j}, {}};
    const auto is_rotor = [&](const declared_term& term) { return term.place == rotor; };
    const std::vector<declared_term> separable = separable_terms(input);
    return std::find(input.declared.begin(), input.declared.end(), rotor) != input.declared.end() &&
           std::none_of(separable.begin(), separable.end(), is_rotor);
}

void add_at_joints(const trace_input& input, const idim_effect& effect, std::vector<candidate_pointer>& list) {
    const idim_model_interface& model = *input.model;
    const double period = 1.0 / input.fitted.front().rate;
    for (int j = 0; j < model.dof; ++j) {
        switch (effect.kind) {
            case IDIM_EFFECT_DELAY:
                list.push_back(delay_candidate(j, first_delay * period, period));
                break;
            case IDIM_EFFECT_GAIN:
                list.push_back(gain_candidate(j));
                break;
            case IDIM_EFFECT_ELASTICITY:
                // The motion of motors and states are signals of such a model, which a link's own motion does not give.
                if (model.n_signals <= model.dof) {
                    list.push_back(elasticity_candidate(model, j, has_lumped_rotor(input, j)));
                }
                break;
            case IDIM_EFFECT_PAYLOAD:
                list.push_back(payload_candidate(model, j));
                break;
            case IDIM_EFFECT_TILT:
                break;  // of the whole robot
            default:
                list.push_back(expression_candidate(effect, j, -1));
        }
    }
}

void add_at_pairs(const trace_input& input, const idim_effect& effect, std::vector<candidate_pointer>& list) {
    for (int j = 0; j < input.model->dof; ++j) {
        for (int other = effect.acts_on_both != 0 ? j + 1 : 0; other < input.model->dof; ++other) {
            if (other != j) {
                list.push_back(expression_candidate(effect, j, other));
            }
        }
    }
}

bool has_signals(const trace_input& input, const idim_effect& effect) {
    if ((effect.needs & IDIM_NEEDS_TEMPERATURE) == 0) {
        return true;
    }
    const auto recorded = [](const filtered_samples& log) { return log.temp.size() > 0; };
    return std::all_of(input.fitted.begin(), input.fitted.end(), recorded) &&
           std::all_of(input.held_back.begin(), input.held_back.end(), recorded);
}

bool is_declared(const trace_input& input, const std::string& effect) {
    return std::any_of(input.declared.begin(), input.declared.end(),
                       [&](const effect_place& place) { return place.effect == effect; });
}

}  // namespace

std::vector<candidate_pointer> list_candidates(const trace_input& input, const std::vector<effect_term>& terms,
                                               const Eigen::VectorXd& chi) {
    std::vector<candidate_pointer> list;
    for (int e = 0; e < input.catalogue->count; ++e) {
        const idim_effect& effect = input.catalogue->effects[e];
        if (!has_signals(input, effect)) {
            continue;
        }
        if (effect.kind == IDIM_EFFECT_TILT) {
            if (candidate_pointer tilt = tilt_candidate(*input.model, input.turned, chi)) {
                list.push_back(std::move(tilt));
            }
        } else if (effect.scope == IDIM_EFFECT_PAIR) {
            add_at_pairs(input, effect, list);
        } else {
            add_at_joints(input, effect, list);
        }
    }
    const auto taken = [&](const candidate_pointer& candidate) {
        const effect_place place = candidate->place();
        const bool asked =
            input.only.empty() || std::find(input.only.begin(), input.only.end(), place) != input.only.end();
        if (!asked || (candidate->is_of_the_robot && is_declared(input, candidate->effect))) {
            return true;
        }
        return std::find(input.declared.begin(), input.declared.end(), place) != input.declared.end() ||
               std::any_of(terms.begin(), terms.end(),
                           [&](const effect_term& term) { return place == term.candidate->place(); });
    };
    list.erase(std::remove_if(list.begin(), list.end(), taken), list.end());
    return list;
}

std::optional<effect_term> term_of(const trace_step& step, const std::vector<candidate_pointer>& candidates) {
    const auto same = [&](const candidate_pointer& candidate) { return candidate->place() == step.place; };
    const auto candidate = std::find_if(candidates.begin(), candidates.end(), same);
    if (candidate == candidates.end()) {
        return std::nullopt;
    }
    std::vector<double> shape;
    for (const shape_bound& bound : (*candidate)->shape) {
        const auto written = [&](const effect_parameter& parameter) { return parameter.name == bound.name; };
        const auto found = std::find_if(step.parameters.begin(), step.parameters.end(), written);
        if (found == step.parameters.end()) {
            return std::nullopt;
        }
        shape.push_back(found->value);
    }
    return effect_term{*candidate, Eigen::Map<Eigen::VectorXd>(shape.data(), static_cast<Eigen::Index>(shape.size()))};
}

}  // namespace idim
