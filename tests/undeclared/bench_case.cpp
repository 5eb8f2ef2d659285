#include "undeclared/bench_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "undeclared/standard_parameters.hpp"

namespace idim::undeclared {

namespace {

bool listed(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// What one attempt at a case is made of.
struct draft {
    bench_case made;
    joint_scales scales;
    std::vector<motion> identification, validation;
    sampler noise;
};

recording_settings random_settings(const joint_scales& scales, bool sticking, sampler& random) {
    recording_settings settings;
    settings.log_rate = random.pick({200.0, 250.0, 500.0, 1000.0});
    std::vector<double> rates;
    for (const double rate : {200.0, 250.0, 500.0, 1000.0}) {
        if (rate >= settings.log_rate && std::fmod(rate, settings.log_rate) == 0.0) {
            rates.push_back(rate);
        }
    }
    settings.controller.rate = random.pick(rates);
    settings.controller.bandwidth = random.uniform(10.0, std::min(35.0, 0.1 * settings.controller.rate));
    settings.controller.damping = random.uniform(0.7, 1.1);
    settings.controller.integral = random.chance(0.4) ? random.uniform(0.3, 2.0) : 0.0;
    settings.controller.gravity = random.uniform(0.85, 1.1);
    settings.controller.feedforward = random.chance(0.4);
    settings.commanded = random.chance(0.5);
    settings.regularisation = sticking ? 0.0 : random.log_uniform(1e-4, 2e-3);
    settings.position.kind = random.pick<const char*>({"white", "quantised"});
    settings.position.size = scales.range * random.log_uniform(1e-6, 2e-5);
    settings.torque.kind = random.pick<const char*>({"white", "coloured", "quantised"});
    const double share = random.log_uniform(0.005, 0.03);
    settings.torque.size = scales.torque * share * (settings.torque.kind == "quantised" ? 2.0 : 1.0);
    settings.torque.corner = settings.log_rate * random.log_uniform(0.01, 0.2);
    settings.reference_columns = random.chance(0.5);
    settings.temperature_columns = random.chance(0.2);
    return settings;
}

std::string random_kind(const std::string& form, sampler& random) {
    if (form == "uncoupled_gain") {
        return "gantry";
    }
    if (form == "gravity_sine") {
        return random.pick<const char*>({"vertical", "3r", "6r", "7r"});
    }
    return random.pick<const char*>({"scara", "vertical", "scara4", "3r", "ppr", "6r", "6r", "7r"});
}

/// A robot with drives, motions, noise and control, and no effect yet.
draft random_draft(const std::string& class_name, std::uint64_t seed, const std::string& form, int attempt) {
    sampler random(fmt::format("{} {}", class_name, attempt), seed);
    bench_case made;
    made.class_name = class_name;
    made.seed = seed;
    made.robot = random_arm(random_kind(form, random), random);
    const double duration = random.uniform(20.0, 40.0);
    const double period = random.chance(0.3) ? 10.0 : 0.0;
    const double top_frequency = random.uniform(0.4, 1.0);
    const auto motions = [&](int count) {
        std::vector<motion> list;
        for (int i = 0; i < count; ++i) {
            list.emplace_back(made.robot, std::round(duration), period, top_frequency, random);
        }
        return list;
    };
    std::vector<motion> identification = motions(random.chance(0.3) ? 2 : 1);
    std::vector<motion> validation = motions(random.chance(0.3) ? 2 : 1);
    const bool offsets = form == "asymmetric_coulomb" || (form != "torque_offset" && random.chance(0.3));
    size_drives(made.robot, scales_along(made.robot, identification.front()), offsets, random);
    made.declared = usual_declaration(made.robot, offsets);
    const joint_scales scales = scales_along(made.robot, identification.front());
    // Where joints stick, friction is no function of the velocity, and what is inside the span may come out of it.
    const bool sticking =
        class_name == "sticking" || (random.chance(0.3) && class_name != "nothing" && class_name != "span");
    made.settings = random_settings(scales, sticking, random);
    return {made, scales, identification, validation, sampler("noise", seed)};
}

/// Whether the motor moves apart from its link.
bool needs_rotor(const std::string& form) {
    return form == "joint_elasticity" || form == "backlash";
}

/// One that the description would declare in the usual case: it is left out there, and in the arm itself.
void undeclare(const missing_effect& effect, bench_case& made) {
    const std::size_t j = static_cast<std::size_t>(effect.joint);
    drive& one = made.robot.drives[j];
    if (effect.form == "viscous_friction") {
        made.declared.viscous[j] = false;
        one.viscous = 0.0;
    } else if (effect.form == "coulomb_friction") {
        made.declared.coulomb[j] = false;
        one.coulomb = 0.0;
    } else if (effect.form == "rotor_inertia") {
        made.declared.rotor[j] = false;
        one.rotor_inertia = 0.0;
    }
}

void adapt_settings(const missing_effect& effect, recording_settings& settings) {
    if (effect.form == "thermal_friction") {
        settings.temperature_columns = effect.shape.count("T0") > 0;
    }
    if (needs_rotor(effect.form) || effect.form.starts_with("presliding")) {
        settings.step = 0.0002;
        settings.controller.bandwidth = std::min(settings.controller.bandwidth, 15.0);
        settings.position.size *= 0.5;
    }
}

recording recorded(const draft& plan, const std::vector<missing_effect>& effects, const motion& reference, int number) {
    const plant_changes changes = changes_of(effects, plan.made.robot);
    sampler noise = plan.noise;
    for (int i = 0; i < number; ++i) {
        noise.normal();
    }
    return record(plan.made.robot, changes, reference, plan.scales, plan.made.settings, noise);
}

struct sized_effect {
    missing_effect effect;
    double rho;
    int joint;
};

/// An effect small beside the joint's torque, and large enough outside the span: the strength is found by trying.
std::optional<sized_effect> sized(const draft& plan, missing_effect effect, double rho) {
    constexpr double most_of_torque = 0.5;
    constexpr int tries = 5;
    std::optional<declared_span> span;  // the effect is small: the motion of the first try does for all
    for (int i = 0; i < tries; ++i) {
        const recording made = recorded(plan, {effect}, plan.identification.front(), 0);
        if (!span) {
            span.emplace(plan.made.robot, plan.made.declared, made);
        }
        const effect_strength now = span->strength_of(made);
        Eigen::Index joint = 0;
        const double found = now.outside.cwiseQuotient(now.residual).maxCoeff(&joint);
        if (std::abs(found / rho - 1.0) < 0.1) {
            const bool usual = (now.whole.array() < most_of_torque * plan.scales.torque.array()).all();
            return usual ? std::optional<sized_effect>({effect, found, static_cast<int>(joint)}) : std::nullopt;
        }
        const double step = std::clamp(rho / found, 1e-3, 10.0);
        if (!std::isfinite(step) || (found < 1e-3 * rho && i > 1)) {
            return std::nullopt;
        }
        effect = scaled(effect, step);
    }
    return std::nullopt;
}

bool add_effect(draft& plan, const std::string& form, double rho, sampler& random) {
    bench_case& made = plan.made;
    const int joint = random.below(made.robot.dof());
    const bool alone = made.robot.dof() < 2;
    if (alone || !possible(form, made.robot, joint)) {
        return false;
    }
    const missing_effect effect =
        random_effect(form, made.robot, joint, plan.scales, plan.identification.front().duration(), random);
    draft tried = plan;
    undeclare(effect, tried.made);
    if (needs_rotor(form) && tried.made.robot.drives[static_cast<std::size_t>(joint)].rotor_inertia == 0.0) {
        return false;
    }
    adapt_settings(effect, tried.made.settings);
    if (listed(span_forms(), form)) {  // of its usual size: nothing of it is outside
        tried.made.effects.push_back(effect);
        tried.made.rho_made.push_back(0.0);
        tried.made.shows_at.push_back(joint);
        plan = tried;
        return true;
    }
    const auto found = sized(tried, effect, rho);
    if (found) {
        tried.made.effects.push_back(found->effect);
        tried.made.rho_made.push_back(found->rho);
        tried.made.shows_at.push_back(found->joint);
        plan = tried;
    }
    return found.has_value();
}

std::vector<std::string> forms_of(const std::string& class_name, std::uint64_t seed, sampler& random) {
    if (class_name == "nothing" || class_name == "sticking") {
        return {};
    }
    const auto turn = [&](const std::vector<std::string>& forms) { return forms[seed % forms.size()]; };
    if (class_name == "near") {
        return {turn(near_forms())};
    }
    if (class_name == "outside") {
        return {turn(outside_forms())};
    }
    if (class_name == "span") {
        return {turn(span_forms())};
    }
    if (class_name == "two") {
        const std::string first = random.pick(catalogue_forms());
        std::string second = first;
        while (second == first) {
            second = random.pick(catalogue_forms());
        }
        return {first, second};
    }
    return {class_name};
}

double random_rho(const std::string& class_name, std::uint64_t seed, sampler& random) {
    if (class_name == "near" || class_name == "outside") {
        return random.pick({0.5, 1.0, 2.0});
    }
    if (class_name == "two") {
        return random.pick({0.35, 0.5, 1.0, 2.0});
    }
    constexpr double steps[] = {0.2, 0.35, 0.5, 1.0, 2.0};
    return listed(catalogue_forms(), class_name) ? steps[seed % 5] : 0.0;
}

void write_recordings(const bench_case& made, const std::string& prefix, bool without_effect) {
    const auto write = [&](const std::vector<recording>& list, const char* name) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            write_log(fmt::format("{}{}{}.csv", prefix, name, i + 1), list[i], made.settings, without_effect);
        }
    };
    write(made.identification, "ident");
    write(made.validation, "valid");
}

nlohmann::json truth_json(const bench_case& made) {
    nlohmann::json effects = nlohmann::json::array();
    for (std::size_t i = 0; i < made.effects.size(); ++i) {
        const missing_effect& e = made.effects[i];
        effects.push_back({{"form", e.form},
                           {"effect", e.name},
                           {"joint", e.joint + 1},
                           {"other", e.other + 1},
                           {"linear", e.linear},
                           {"shape", e.shape},
                           {"rho", made.rho_made[i]},
                           {"shows_at", made.shows_at[i] + 1}});
    }
    const recording_settings& s = made.settings;
    return {{"class", made.class_name},
            {"seed", made.seed},
            {"kind", made.robot.kind},
            {"rho", made.rho},
            {"effects", effects},
            {"log_rate", s.log_rate},
            {"control_rate", s.controller.rate},
            {"commanded", s.commanded},
            {"regularisation", s.regularisation},
            {"position_noise", s.position.kind},
            {"torque_noise", s.torque.kind}};
}

}  // namespace

const std::vector<std::string>& case_classes() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list = {"nothing", "sticking", "near", "outside", "span", "two"};
        list.insert(list.end(), catalogue_forms().begin(), catalogue_forms().end());
        return list;
    }();
    return names;
}

bench_case make_case(const std::string& class_name, std::uint64_t seed) {
    constexpr int most_attempts = 40;
    if (!listed(case_classes(), class_name)) {
        throw std::invalid_argument("no class " + class_name + " of cases");
    }
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        sampler random(fmt::format("effects of {}, attempt {}", class_name, attempt), seed);
        const std::vector<std::string> forms = forms_of(class_name, seed, random);
        draft plan = random_draft(class_name, seed, forms.empty() ? "" : forms.front(), attempt);
        plan.made.rho = random_rho(class_name, seed, random);
        try {
            bool all = true;
            for (const std::string& form : forms) {
                all = all && add_effect(plan, form, plan.made.rho, random);
            }
            if (!all) {
                continue;
            }
            int number = 0;
            for (const motion& reference : plan.identification) {
                plan.made.identification.push_back(recorded(plan, plan.made.effects, reference, number++));
            }
            for (const motion& reference : plan.validation) {
                plan.made.validation.push_back(recorded(plan, plan.made.effects, reference, number++));
            }
            return plan.made;
        } catch (const std::runtime_error&) {
            continue;  // an unstable loop: another robot
        }
    }
    throw std::runtime_error(fmt::format("no robot found for {} {}", class_name, seed));
}

void write_case(const bench_case& made, const std::string& folder) {
    std::ofstream file(folder + "/robot.yaml");
    file << description_text(made.robot, made.declared);
    if (!file.flush()) {
        throw std::runtime_error("cannot write to " + folder);
    }
    write_recordings(made, folder + "/", false);
}

void write_truth(const bench_case& made, const std::string& folder) {
    std::ofstream file(folder + "/truth.json");
    file << truth_json(made).dump(2) << '\n';
    std::ofstream(folder + "/parameters.yaml") << standard_parameters_text(made.robot);
    write_recordings(made, folder + "/twin_", true);
}

}  // namespace idim::undeclared
