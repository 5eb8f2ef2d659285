#include "idim/effect_trace.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "candidate_list.hpp"
#include "declared_terms.hpp"
#include "effect_tracer.hpp"
#include "idim/input_error.hpp"
#include "model_candidates.hpp"
#include "noise_floor.hpp"
#include "size_constancy.hpp"
#include "structure_proposal.hpp"
#include "term_deviations.hpp"

namespace idim {

namespace {

constexpr double first_alignment = 0.5;  ///< of a sample: where its linearisation starts
constexpr int linearisations = 3;
constexpr double implausible_z = 2.0;
constexpr double least_by_refit = 0.01;  ///< of the residual variance held back, once everything is fitted again
constexpr double loosest_shape = 0.5;    ///< deviation of a shape over its value
/// The error over all joints may rise by this part: other joints' parameters move within their deviations.
constexpr double error_margin = 2e-3;

/// Share of the residual variance beyond the noise floor that an effect removes from its joints' rows held back, at the
/// joint where that is most: an effect of the whole robot need not show at every joint.
double explained_fraction(const trace_fit& before, const trace_fit& after, const std::vector<int>& touched,
                          const noise_floor& floor) {
    double most = -1.0;
    for (const int j : touched) {
        const auto joint = static_cast<std::size_t>(j);
        double removed = 0.0;
        double there = 0.0;
        for (std::size_t l = 0; l < before.logs().size(); ++l) {
            if (!before.logs()[l].held_back) {
                continue;
            }
            const double first = before.residual()[l][joint].squaredNorm();
            removed += first - after.residual()[l][joint].squaredNorm();
            there += first;
            if (floor.rms.size() > 0) {
                const double noise =
                    floor.rms[j] * floor.rms[j] * static_cast<double>(before.residual()[l][joint].size());
                there -= std::min(noise, first);
            }
        }
        most = std::max(most, there > 0.0 ? std::clamp(removed / there, -1.0, 1.0) : 0.0);
    }
    return most;
}

/// Smallest values of the base parameters that make sense: those of effects' coefficients, by name.
Eigen::VectorXd least_values(const trace_input& input) {
    const idim_model_interface& model = *input.model;
    Eigen::VectorXd least = Eigen::VectorXd::Constant(model.n_base, -std::numeric_limits<double>::infinity());
    for (int e = 0; e < input.catalogue->count; ++e) {
        const idim_effect& effect = input.catalogue->effects[e];
        for (int c = 0; c < effect.n_linear; ++c) {
            const std::string stem = effect.linear_names[c];
            for (int k = 0; k < model.n_base && effect.linear_min[c] == 0.0; ++k) {
                const std::string name = model.parameter_names[k];
                const bool same = name.size() > stem.size() && name.compare(0, stem.size(), stem) == 0 &&
                                  std::isdigit(static_cast<unsigned char>(name[stem.size()])) != 0;
                least[k] = same ? 0.0 : least[k];
            }
        }
    }
    return least;
}

/// A name that was given and taken back: what it explained changes with another joint's position.
struct suspect {
    effect_place place;
    int changes_with;
};

class tracer {
  public:
    explicit tracer(const trace_input& input) : input_(input) {
        for (const filtered_samples& samples : input.fitted) {
            logs_.push_back(make_traced_log(*input.model, samples, input.filter, false));
        }
        for (const filtered_samples& samples : input.held_back) {
            logs_.push_back(make_traced_log(*input.model, samples, input.filter, true));
        }
        result_.floor = floor_from_spectrum(logs_);
        least_ = least_values(input);
    }

    effect_trace run() {
        trace_fit fit = fit_with_own_noise(logs_, {});
        result_.before = {errors_of(fit, false), errors_of(fit, true)};
        fit = with_steps_found(aligned(std::move(fit)));
        do {
            fit = with_all_that_pass(std::move(fit));
        } while (input_.only.empty() && !result_.interrupted && takes_suspects_out(fit));
        if (input_.most_effects == 0) {
            look(fit);
        }
        if (!result_.interrupted) {
            find_structure(fit);
            result_.unsupported = find_unsupported(fit, input_);
        }
        result_.after = {errors_of(fit, false), errors_of(fit, true)};
        fill_parameters(fit);
        return std::move(result_);
    }

  private:
    void say(const std::string& line) const {
        if (input_.progress) {
            input_.progress(line);
        }
    }

    void use_torques_of(const trace_fit& fit) {
        const Eigen::VectorXd chi = fit.chi();
        for (traced_log& log : logs_) {
            update_torques(*input_.model, chi, log);
        }
    }

    /// Takes a common lateness of all torques by less than a sample off, as a term of its own that is not reported.
    trace_fit aligned(trace_fit fit) {
        use_torques_of(fit);
        const double period = 1.0 / logs_.front().samples.rate;
        double at = first_alignment * period;
        for (int pass = 0; pass < linearisations; ++pass) {
            const candidate_pointer candidate = alignment_candidate(input_.model->dof, at);
            const trace_fit with = fit_with_own_noise(logs_, {{candidate, Eigen::VectorXd()}}, &fit.noise());
            const double found = with.coefficients(0)[0];
            if (!(std::abs(found) <= period) || std::abs(found) < 1e-3 * period) {
                return fit;
            }
            at = found;
            result_.alignment = found;
        }
        fixed_ = 1;
        use_torques_of(fit);
        return fit_with_own_noise(logs_, {{alignment_candidate(input_.model->dof, at), Eigen::VectorXd()}},
                                  &fit.noise());
    }

    /// What takes a hidden effect up, by name.
    std::string reason(const hidden_candidate& found) const {
        constexpr std::size_t most_names = 4;
        std::vector<std::string> names;
        for (const Eigen::Index k : found.absorbed_by) {
            if (k < input_.model->n_base && names.size() < most_names) {
                names.emplace_back(input_.model->parameter_names[k]);
            }
        }
        return names.empty() ? "no torque of it is left beside the terms of the model"
                             : fmt::format("taken up by {}", fmt::join(names, ", "));
    }

    /// Effects within the span of the model, and loads that never come off, which are part of their link.
    std::vector<hidden_effect> hidden(const effect_survey& all, const std::vector<candidate_pointer>& tried) const {
        std::vector<hidden_effect> effects;
        for (const hidden_candidate& found : all.within_span) {
            effects.push_back({found.place, reason(found)});
        }
        for (const candidate_pointer& candidate : tried) {
            if (!candidate->when_permanent.empty()) {
                effects.push_back({candidate->place(), candidate->when_permanent});
            }
        }
        return effects;
    }

    /// Nothing where the user interrupts.
    std::optional<effect_survey> look(const trace_fit& fit) {
        use_torques_of(fit);
        const std::vector<candidate_pointer> candidates = list_candidates(input_, fit.terms(), fit.chi());
        std::optional<effect_survey> surveyed = survey(fit, candidates, input_.go_on);
        if (!surveyed) {
            result_.interrupted = true;
            return std::nullopt;
        }
        effect_survey& all = *surveyed;
        result_.tests = all.tests;
        result_.not_identifiable = hidden(all, candidates);
        result_.candidates.clear();
        for (tried_candidate& tried : all.candidates) {
            const effect_evidence& evidence = tried.evidence;
            const effect_candidate& candidate = *evidence.term.candidate;
            for (const suspect& known : suspects_) {
                if (known.place == candidate.place()) {
                    tried.objection = fmt::format("its size would change with q{}", known.changes_with + 1);
                }
            }
            std::vector<double> values(evidence.coefficient.begin(), evidence.coefficient.end());
            values.insert(values.end(), evidence.term.shape.begin(), evidence.term.shape.end());
            result_.candidates.push_back({candidate.place(), tried.p_value, evidence.explained_fraction,
                                          evidence.f_statistic, evidence.correlation_length, evidence.z_all(),
                                          evidence.z_moving(), std::move(values), tried.objection});
        }
        return surveyed;
    }

    /// The fit with the best candidate that passes, everything fitted again and needless terms taken out; none if there
    /// is no such candidate, or the fit is no better for it.
    std::optional<trace_fit> with_one_more(const trace_fit& fit) {
        const std::optional<effect_survey> surveyed = look(fit);
        if (!surveyed) {
            return std::nullopt;
        }
        const effect_survey& all = *surveyed;
        for (std::size_t i = 0; i < all.candidates.size(); ++i) {
            if (!all.candidates[i].objection.empty()) {
                continue;
            }
            std::vector<effect_term> terms = fit.terms();
            terms.push_back(all.candidates[i].evidence.term);
            trace_fit with = settled(fit_with_own_noise(logs_, terms, &fit.noise()));
            const std::string objection =
                objection_once_fitted(fit, with, all.candidates[i].evidence.term.candidate->joints);
            if (!objection.empty()) {
                result_.candidates[i].objection = objection;
                continue;
            }
            record(fit, with, all, i);
            return pruned(std::move(with));
        }
        return std::nullopt;
    }

    /// The fit with the terms of an earlier trace.
    trace_fit with_steps_found(trace_fit fit) {
        if (input_.found.empty()) {
            return fit;
        }
        const std::vector<candidate_pointer> candidates = list_candidates(input_, fit.terms(), fit.chi());
        std::vector<effect_term> terms = fit.terms();
        for (const trace_step& step : input_.found) {
            if (std::optional<effect_term> term = term_of(step, candidates)) {
                terms.push_back(std::move(*term));
                result_.steps.push_back(step);
            } else {
                say(fmt::format("{} at joint {} is looked for again", step.place.effect,
                                fmt::join(ordinals(step.place.joints), ", ")));
            }
        }
        return pruned(settled(fit_with_own_noise(logs_, terms, &fit.noise())));
    }

    trace_fit with_all_that_pass(trace_fit fit) {
        while (static_cast<int>(result_.steps.size()) < input_.most_effects) {
            std::optional<trace_fit> next = with_one_more(fit);
            if (!next) {
                break;
            }
            fit = std::move(*next);
        }
        return fit;
    }

    /// Takes terms out whose names do not hold: asked once nothing else passes, for an effect still missing elsewhere
    /// would seem to change the size of those that are found already. Such a name is not given again.
    bool takes_suspects_out(trace_fit& fit) {
        std::vector<effect_term> kept(fit.terms().begin(), fit.terms().begin() + fixed_);
        std::vector<trace_step> steps;
        for (std::size_t s = 0; s < result_.steps.size(); ++s) {
            const std::size_t term = s + static_cast<std::size_t>(fixed_);
            if (const std::optional<int> other = joint_that_changes(fit, term)) {
                const effect_place& place = result_.steps[s].place;
                suspects_.push_back({place, *other});
                say(fmt::format("{} at joint {} is taken back: its size changes with q{}", place.effect,
                                place.joints.front() + 1, *other + 1));
            } else {
                kept.push_back(fit.terms()[term]);
                steps.push_back(std::move(result_.steps[s]));
            }
        }
        const bool any = kept.size() < fit.terms().size();
        if (any) {
            fit = settled(fit_with_own_noise(logs_, kept, &fit.noise()));
        }
        result_.steps = std::move(steps);
        return any;
    }

    /// Why the fit with one term more is not taken, everything fitted again; empty if it is.
    std::string objection_once_fitted(const trace_fit& fit, const trace_fit& with,
                                      const std::vector<int>& joints) const {
        if (error_ratio(errors_of(fit, true), errors_of(with, true)) > 1.0 + error_margin) {
            return "raises the error of the data held back once everything is fitted again";
        }
        if (explained_fraction(fit, with, joints, {}) < least_by_refit) {
            return "explains next to nothing once everything is fitted again";
        }
        if (makes_implausible(fit, with)) {
            return "makes a coefficient implausible";
        }
        return has_loose_shape(with) ? "its shape is anybody's guess" : "";
    }

    /// Whether a coefficient that cannot be negative, such as a friction's, has become so beyond its uncertainty.
    bool makes_implausible(const trace_fit& before, const trace_fit& after) const {
        const double length =
            correlation_length(after, after.residual(), after.terms().back().candidate->touched.front());
        for (Eigen::Index k = 0; k < least_.size(); ++k) {
            const double deviation = std::sqrt(length) * after.white_deviation(k);
            const double value = after.chi()[k];
            if (value < least_[k] - implausible_z * deviation && value < before.chi()[k]) {
                return true;
            }
        }
        for (std::size_t i = static_cast<std::size_t>(fixed_); i < after.terms().size(); ++i) {
            const std::vector<linear_bound>& linear = after.terms()[i].candidate->linear;
            for (std::size_t c = 0; c < linear.size(); ++c) {
                const double value = after.coefficients(i)[static_cast<Eigen::Index>(c)];
                if (value < linear[c].min || value > linear[c].max) {
                    return true;
                }
            }
        }
        return false;
    }

    /// Whether the shape of the last term is anybody's guess.
    static bool has_loose_shape(const trace_fit& fit) {
        const effect_term& last = fit.terms().back();
        if (last.shape.size() != 1) {
            return false;
        }
        const term_values values = values_with_deviations(fit).back();
        const Eigen::Index place = values.value.size() - 1;
        return !(values.deviation[place] < loosest_shape * std::abs(values.value[place]));
    }

    /// Shapes searched and models linearised again around what was found.
    trace_fit settled(trace_fit fit) {
        for (int pass = 0; pass < linearisations; ++pass) {
            std::vector<effect_term> terms = fit.terms();
            bool moved = false;
            for (std::size_t i = static_cast<std::size_t>(fixed_); i < terms.size(); ++i) {
                if (const candidate_pointer again = terms[i].candidate->relinearised(fit.coefficients(i))) {
                    terms[i].candidate = again;
                    moved = true;
                }
            }
            if (!moved) {
                break;
            }
            use_torques_of(fit);
            fit = fit_with_own_noise(logs_, terms, &fit.noise());
        }
        return with_refined_shapes(fit);
    }

    trace_fit pruned(trace_fit fit) {
        while (const std::optional<std::size_t> needless = needless_term(fit, static_cast<std::size_t>(fixed_))) {
            std::vector<effect_term> terms = fit.terms();
            say(fmt::format("{} at joint {} has become needless", terms[*needless].candidate->effect,
                            terms[*needless].candidate->joints.front() + 1));
            terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(*needless));
            result_.steps.erase(result_.steps.begin() + static_cast<std::ptrdiff_t>(*needless) - fixed_);
            fit = settled(fit_with_own_noise(logs_, terms, &fit.noise()));
        }
        return fit;
    }

    /// What is left once no known effect passes.
    void find_structure(const trace_fit& fit) {
        const auto passes = [](const trace_candidate& candidate) { return candidate.objection.empty(); };
        if (!input_.only.empty() ||
            (input_.most_effects == 0 && std::any_of(result_.candidates.begin(), result_.candidates.end(), passes))) {
            return;
        }
        for (const signal_dependence& dependence : find_dependences(fit)) {
            unexplained_structure structure;
            structure.joint = dependence.joint;
            structure.explained_fraction = dependence.explained_fraction;
            for (const signal_source& source : dependence.signals) {
                structure.signals.push_back(source.name());
            }
            if (const std::optional<proposed_torque> proposal = propose(fit, dependence)) {
                structure.terms = proposal->terms;
                structure.units = proposal->units;
                structure.from = proposal->from;
            }
            say(fmt::format("the residual of joint {} depends on {}: {:.0f} % of it on data held back",
                            dependence.joint + 1, fmt::join(structure.signals, ", "),
                            100.0 * dependence.explained_fraction));
            result_.unexplained.push_back(std::move(structure));
        }
    }

    void record(const trace_fit& before, const trace_fit& after, const effect_survey& all, std::size_t chosen) {
        const tried_candidate& tried = all.candidates[chosen];
        const effect_candidate& candidate = *tried.evidence.term.candidate;
        trace_step step;
        step.place = candidate.place();
        step.p_value = tried.p_value;
        step.explained_fraction = explained_fraction(before, after, candidate.joints, result_.floor);
        step.confusable_with = confusable_with(before, all, chosen);
        step.before = errors_of(before, true);
        step.after = errors_of(after, true);
        say(fmt::format("{} at joint {}: p {:.2g}, explains {:.0f} % on data held back, {:.2f} -> {:.2f} %",
                        candidate.effect, fmt::join(ordinals(candidate.joints), ", "), step.p_value,
                        100.0 * step.explained_fraction, 100.0 * step.before.relative_error,
                        100.0 * step.after.relative_error));
        result_.steps.push_back(std::move(step));
    }

    static std::vector<int> ordinals(std::vector<int> joints) {
        for (int& j : joints) {
            ++j;
        }
        return joints;
    }

    void fill_parameters(const trace_fit& fit) {
        const std::vector<term_values> values = values_with_deviations(fit);
        for (std::size_t s = 0; s < result_.steps.size(); ++s) {
            const std::size_t i = s + static_cast<std::size_t>(fixed_);
            const effect_candidate& candidate = *fit.terms()[i].candidate;
            const auto m = static_cast<Eigen::Index>(candidate.linear.size());
            for (Eigen::Index c = 0; c < values[i].value.size(); ++c) {
                const bool linear = c < m;
                const auto k = static_cast<std::size_t>(linear ? c : c - m);
                if (linear ? candidate.linear[k].is_nuisance || candidate.linear[k].is_one
                           : candidate.shape[k].is_nuisance) {
                    continue;
                }
                auto [value, deviation] = linear ? candidate.declared(values[i].value[c], values[i].deviation[c])
                                                 : std::pair(values[i].value[c], values[i].deviation[c]);
                if (linear && candidate.role == column_role::linear && !std::isfinite(deviation)) {
                    value = deviation;  // its column is a combination of the others
                }
                result_.steps[s].parameters.push_back({linear ? candidate.linear[k].name : candidate.shape[k].name,
                                                       linear ? candidate.linear[k].unit : candidate.shape[k].unit,
                                                       value, deviation,
                                                       !linear || candidate.role == column_role::shape});
            }
        }
    }

    const trace_input& input_;
    std::vector<traced_log> logs_;
    effect_trace result_;
    Eigen::VectorXd least_;  ///< smallest value of each base parameter that makes sense
    std::vector<suspect> suspects_;
    int fixed_ = 0;  ///< terms in front that are no effects
};

}  // namespace

effect_trace trace_effects(const trace_input& input) {
    if (input.fitted.empty() || input.held_back.empty()) {
        throw std::invalid_argument("trace_effects: needs logs to fit and logs held back");
    }
    return tracer(input).run();
}

}  // namespace idim
