#include "undeclared/missing_effect.hpp"

#include <functional>
#include <numbers>
#include <stdexcept>

namespace idim::undeclared {

namespace {

using std::numbers::pi;

/// What a maker of one form may use.
struct surroundings {
    const arm& robot;
    const joint_scales& scales;
    int joint;
    double duration;
    sampler& random;

    double torque() const { return 0.1 * scales.torque[joint]; }
    double speed() const { return scales.speed[joint]; }
    double top_speed() const { return scales.top_speed[joint]; }
    double range() const { return scales.range[joint]; }
};

using maker = std::function<void(const surroundings&, missing_effect&)>;

/// Two linear coefficients of one amplitude at a random phase.
void set_phase(const surroundings& s, missing_effect& effect, const std::string& cosine, const std::string& sine) {
    const double phase = s.random.uniform(0.0, 2.0 * pi);
    effect.linear[cosine] = s.torque() * std::cos(phase);
    effect.linear[sine] = s.torque() * std::sin(phase);
}

void set_neighbour(const surroundings& s, missing_effect& effect) {
    const int last = s.robot.dof() - 1;
    effect.other = s.joint == last || (s.joint > 0 && s.random.chance(0.5)) ? s.joint - 1 : s.joint + 1;
}

/// Waves per radian or metre: at least 1.5 and at most 16 over the joint's range.
double wave_number(const surroundings& s) {
    return s.random.log_uniform(1.5, 16.0) * pi / s.range();
}

void make_stribeck(const surroundings& s, missing_effect& effect) {
    effect.linear["Fs"] = s.torque();
    effect.shape["vs"] = s.top_speed() * s.random.log_uniform(0.03, 0.2);
}

void make_nonlinear_viscous(const surroundings& s, missing_effect& effect) {
    const double p = s.random.chance(0.5) ? s.random.uniform(0.3, 0.7) : s.random.uniform(1.5, 2.6);
    effect.shape["p"] = p;
    effect.linear["Fp"] = s.torque() / std::pow(s.speed(), p);
}

void make_position_dependent(const surroundings& s, missing_effect& effect) {
    effect.shape["k"] = s.random.uniform(0.8, 6.0) * pi / (2.0 * s.range());
    set_phase(s, effect, "Fcc", "Fcs");
}

void make_ripple(const surroundings& s, missing_effect& effect) {
    effect.shape["k"] = wave_number(s);
    set_phase(s, effect, "Ac", "As");
}

void make_spring(const surroundings& s, missing_effect& effect) {
    effect.linear["K"] = s.torque() / s.range() * 2.0;
    effect.linear["K0"] = s.torque() * s.random.uniform(-1.0, 1.0);
}

void make_joint_coupling(const surroundings& s, missing_effect& effect) {
    set_neighbour(s, effect);
    const auto& drives = s.robot.drives;
    const drive &a = drives[static_cast<std::size_t>(s.joint)], &b = drives[static_cast<std::size_t>(effect.other)];
    effect.linear["Iac"] = 0.2 * std::min(a.rotor_inertia, b.rotor_inertia) * s.random.uniform(0.3, 1.0);
    effect.linear["Fvc"] = 0.4 * std::min(a.viscous, b.viscous) * s.random.uniform(0.3, 1.0);
    effect.linear["Fcc"] = 0.5 * std::min(a.coulomb, b.coulomb) * s.random.uniform(0.3, 1.0);
}

void make_coupling_friction(const surroundings& s, missing_effect& effect) {
    set_neighbour(s, effect);
    effect.linear["Fvc"] = 0.5 * s.torque() / s.scales.speed[effect.other] * s.random.sign();
    effect.linear["Fcc"] = s.torque() * (effect.linear["Fvc"] > 0.0 ? 1.0 : -1.0);
}

/// Angles of the gravity vector about the two axes of the base that it is not along.
void make_tilt(const surroundings& s, missing_effect& effect) {
    const double direction = s.random.uniform(0.0, 2.0 * pi);
    effect.linear["tilt_x"] = 0.05 * std::cos(direction);
    effect.linear[s.robot.gravity.z() != 0.0 ? "tilt_y" : "tilt_z"] = 0.05 * std::sin(direction);
}

void make_payload(const surroundings& s, missing_effect& effect) {
    const solid& link = s.robot.links[static_cast<std::size_t>(s.joint)];
    const double reach = std::cbrt(link.mass) * 0.05;
    const solid load = random_solid(0.5 * link.mass, reach, s.random);
    effect.linear["M"] = load.mass;  // the form of the load stays, its density changes
    for (int i = 0; i < 3; ++i) {
        effect.shape["x" + std::to_string(i)] = load.centre[i];
        for (int j = i; j < 3; ++j) {
            effect.shape["I" + std::to_string(i) + std::to_string(j)] = load.central_inertia(i, j) / load.mass;
        }
    }
    effect.shape["t0"] = s.duration * s.random.uniform(0.15, 0.45);
    effect.shape["t1"] = s.duration * s.random.uniform(0.6, 0.9);
}

void make_thermal(const surroundings& s, missing_effect& effect) {
    if (s.random.chance(0.5)) {  // a sensor: friction falls as the joint warms up, over 10 to 20 degrees
        effect.linear["Fvt"] = -s.torque() / s.speed() / 10.0;
        effect.shape["T0"] = 25.0;
    } else {
        effect.linear["Fvt"] = 2.0 * s.torque() / s.speed();
        effect.shape["tc"] = s.duration * s.random.uniform(0.15, 0.6);
    }
}

void make_presliding(const surroundings& s, missing_effect& effect) {
    effect.linear["stretch"] = s.range() * s.random.log_uniform(0.004, 0.02);  // [rad or m] where friction is reached
}

void make_elasticity(const surroundings& s, missing_effect& effect) {
    // Locked-motor frequency of 15 Hz at first, damping ratio of 2 to 10 %.
    const double w = 2.0 * pi * 15.0;
    effect.linear["compliance"] = 1.0 / (s.scales.inertia[s.joint] * w * w);
    effect.shape["damping_ratio"] = s.random.uniform(0.02, 0.1);
}

void make_backlash(const surroundings& s, missing_effect& effect) {
    effect.linear["gap"] = 0.01 * s.range();
}

void make_delay(const surroundings& s, missing_effect& effect) {
    effect.linear["Td"] = s.random.pick({0.004, 0.008});
}

void make_gain(const surroundings& s, missing_effect& effect) {
    effect.linear["gain"] = 0.1 * s.random.sign();
}

void make_periodic(const surroundings& s, missing_effect& effect) {
    effect.shape["w"] = 2.0 * pi * s.random.log_uniform(0.3, 4.0);
    set_phase(s, effect, "Ac", "As");
}

maker one(std::string parameter, double (*value)(const surroundings&)) {
    return [parameter, value](const surroundings& s, missing_effect& effect) { effect.linear[parameter] = value(s); };
}

double of_torque(const surroundings& s) {
    return s.torque();
}

/// A maker and the name in the catalogue of what it makes.
struct entry {
    std::string name;
    maker make;
};

const std::map<std::string, entry>& exact() {
    static const std::map<std::string, entry> entries = {
        {"rotor_inertia", {"", one("Ia", [](const surroundings& s) { return 0.3 * s.scales.inertia[s.joint]; })}},
        {"viscous_friction", {"", one("Fv", [](const surroundings& s) { return s.torque() / s.speed(); })}},
        {"coulomb_friction", {"", one("Fc", of_torque)}},
        {"torque_offset", {"", one("off", [](const surroundings& s) { return s.torque() * s.random.sign(); })}},
        {"asymmetric_viscous_friction", {"", one("Fva", [](const surroundings& s) { return s.torque() / s.speed(); })}},
        {"stribeck_friction", {"", make_stribeck}},
        {"nonlinear_viscous_friction", {"", make_nonlinear_viscous}},
        {"load_dependent_friction", {"", one("Fl", [](const surroundings&) { return 0.1; })}},
        {"position_dependent_friction", {"", make_position_dependent}},
        {"torque_ripple", {"", make_ripple}},
        {"spring", {"", make_spring}},
        {"gravity_compensator",
         {"", [](const surroundings& s, missing_effect& effect) { set_phase(s, effect, "Kc", "Ks"); }}},
        {"joint_coupling", {"", make_joint_coupling}},
        {"coupling_friction", {"", make_coupling_friction}},
        {"base_tilt", {"", make_tilt}},
        {"payload", {"", make_payload}},
        {"thermal_friction", {"", make_thermal}},
        {"presliding_hysteresis", {"", make_presliding}},
        {"backlash", {"", make_backlash}},
        {"joint_elasticity", {"", make_elasticity}},
        {"torque_delay", {"", make_delay}},
        {"drive_gain_error", {"", make_gain}},
        {"periodic_disturbance", {"", make_periodic}}};
    return entries;
}

const std::map<std::string, entry>& near() {
    static const std::map<std::string, entry> entries = {
        {"stribeck_exponent_one", {"stribeck_friction", make_stribeck}},
        {"stribeck_tanh", {"stribeck_friction", make_stribeck}},
        {"ripple_triangle", {"torque_ripple", make_ripple}},
        {"ripple_with_harmonic", {"torque_ripple", make_ripple}},
        {"load_saturating", {"load_dependent_friction", one("Fl", [](const surroundings&) { return 0.1; })}},
        {"spring_hardening", {"spring", make_spring}},
        {"viscous_logarithm",
         {"nonlinear_viscous_friction",
          [](const surroundings& s, missing_effect& effect) {
              effect.linear["Fp"] = s.torque();
              effect.shape["v0"] = 0.1 * s.top_speed();
          }}},
        {"position_friction_triangle", {"position_dependent_friction", make_position_dependent}},
        {"presliding_damped", {"presliding_hysteresis", make_presliding}}};
    return entries;
}

void make_product(const surroundings& s, missing_effect& effect) {
    set_neighbour(s, effect);
    effect.linear["c"] = s.torque();
    effect.shape["range"] = s.range();
    effect.shape["other_range"] = s.scales.range[effect.other];
    effect.shape["phase"] = s.random.uniform(-0.5, 0.5);
}

const std::map<std::string, entry>& outside() {
    static const std::map<std::string, entry> entries = {{"position_product", {"", make_product}},
                                                         {"sine_of_both", {"", make_product}},
                                                         {"friction_by_other_position", {"", make_product}}};
    return entries;
}

const std::map<std::string, entry>& span() {
    static const std::map<std::string, entry> entries = {
        {"asymmetric_coulomb", {"", one("Fca", [](const surroundings& s) { return s.torque() * s.random.sign(); })}},
        {"gravity_sine",
         {"gravity_compensator",
          [](const surroundings& s, missing_effect& effect) { set_phase(s, effect, "Kc", "Ks"); }}},
        {"permanent_payload",
         {"payload",
          [](const surroundings& s, missing_effect& effect) {
              make_payload(s, effect);
              effect.shape["t0"] = -1.0;
              effect.shape["t1"] = 1e9;
          }}},
        {"uncoupled_gain", {"drive_gain_error", make_gain}}};
    return entries;
}

std::vector<std::string> names_of(const std::map<std::string, entry>& entries) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : entries) {
        names.push_back(name);
    }
    return names;
}

}  // namespace

missing_effect scaled(missing_effect effect, double factor) {
    for (auto& [name, value] : effect.linear) {
        value *= factor;
    }
    return effect;
}

const std::vector<std::string>& catalogue_forms() {
    static const std::vector<std::string> names = names_of(exact());
    return names;
}

const std::vector<std::string>& near_forms() {
    static const std::vector<std::string> names = names_of(near());
    return names;
}

const std::vector<std::string>& outside_forms() {
    static const std::vector<std::string> names = names_of(outside());
    return names;
}

const std::vector<std::string>& span_forms() {
    static const std::vector<std::string> names = names_of(span());
    return names;
}

bool possible(const std::string& form, const arm& robot, int joint) {
    const bool rotates = !robot.rows[static_cast<std::size_t>(joint)].prismatic;
    const bool has_gravity = robot.gravity.norm() > 0.0;
    if (form == "base_tilt") {
        return has_gravity;
    }
    if (form == "payload" || form == "permanent_payload") {
        return joint == robot.dof() - 1;
    }
    if (form == "gravity_compensator") {
        return rotates;
    }
    if (form == "gravity_sine") {  // the first joint that lifts links: its own angle alone decides
        return has_gravity && rotates && joint == (robot.kind == "vertical" ? 0 : 1) && robot.kind != "scara4";
    }
    if (form == "uncoupled_gain") {
        return robot.kind == "gantry";
    }
    return true;
}

missing_effect random_effect(const std::string& form, const arm& robot, int joint, const joint_scales& scales,
                             double duration, sampler& random) {
    for (const auto* entries : {&exact(), &near(), &outside(), &span()}) {
        const auto found = entries->find(form);
        if (found == entries->end()) {
            continue;
        }
        missing_effect effect;
        effect.form = form;
        effect.name = entries == &exact() ? form : found->second.name;
        effect.joint = joint;
        found->second.make({robot, scales, joint, duration, random}, effect);
        return effect;
    }
    throw std::invalid_argument("no effect of form " + form);
}

}  // namespace idim::undeclared
