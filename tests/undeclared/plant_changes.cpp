#include "undeclared/plant_changes.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace idim::undeclared {

namespace {

using std::numbers::pi;

/// Even, of period 2 pi, between -1 and 1, with corners.
double triangle(double angle) {
    return 2.0 / pi * std::asin(std::cos(angle));
}

double squared(double x) {
    return x * x;
}

/// Linear or shape coefficients of an effect, 0 where it has none of that name.
double value(const missing_effect& e, const char* name) {
    const auto found = e.linear.find(name);
    return found == e.linear.end() ? 0.0 : found->second;
}

double shape(const missing_effect& e, const char* name) {
    const auto found = e.shape.find(name);
    return found == e.shape.end() ? 0.0 : found->second;
}

/// Forms that are a function of velocities, time and temperature; an empty function for every other form.
signal_function velocity_torque_of(const missing_effect& e) {
    const int j = e.joint, o = e.other;
    const std::string& form = e.form;
    if (form == "viscous_friction") {
        return [a = value(e, "Fv"), j](const plant_signals& s) { return a * s.qd[j]; };
    }
    if (form == "asymmetric_viscous_friction") {
        return [a = value(e, "Fva"), j](const plant_signals& s) { return a * std::abs(s.qd[j]); };
    }
    if (form == "nonlinear_viscous_friction" && shape(e, "p") > 1.0) {
        return [a = value(e, "Fp"), p = shape(e, "p"), j](const plant_signals& s) {
            return std::copysign(a * std::pow(std::abs(s.qd[j]), p), s.qd[j]);
        };
    }
    if (form == "coupling_friction") {
        return [a = value(e, "Fvc"), b = value(e, "Fcc"), o](const plant_signals& s) {
            return a * s.qd[o] + b * s.slip[o];
        };
    }
    if (form == "thermal_friction" && e.shape.count("T0")) {
        return [a = value(e, "Fvt"), T0 = shape(e, "T0"), j](const plant_signals& s) {
            return a * s.qd[j] * (s.temperature[j] - T0);
        };
    }
    if (form == "thermal_friction") {
        return [a = value(e, "Fvt"), tc = shape(e, "tc"), j](const plant_signals& s) {
            return a * s.qd[j] * std::exp(-s.t / tc);
        };
    }
    if (form == "periodic_disturbance") {
        return [a = value(e, "Ac"), b = value(e, "As"), w = shape(e, "w")](const plant_signals& s) {
            return a * std::cos(w * s.t) + b * std::sin(w * s.t);
        };
    }
    return {};
}

/// Forms that are a function of the joint's position; an empty function for every other form.
signal_function position_torque_of(const missing_effect& e) {
    const int j = e.joint;
    const std::string& form = e.form;
    if (form == "torque_offset") {
        return [a = value(e, "off")](const plant_signals&) { return a; };
    }
    if (form == "torque_ripple") {
        return [c = value(e, "Ac"), a = value(e, "As"), k = shape(e, "k"), j](const plant_signals& s) {
            return c * std::cos(k * s.q[j]) + a * std::sin(k * s.q[j]);
        };
    }
    if (form == "ripple_triangle" || form == "ripple_with_harmonic") {
        const double amplitude = std::hypot(value(e, "Ac"), value(e, "As"));
        const double phase = std::atan2(value(e, "As"), value(e, "Ac"));
        const bool corners = form == "ripple_triangle";
        return [=, k = shape(e, "k")](const plant_signals& s) {
            const double angle = k * s.q[j] - phase;
            return amplitude * (corners ? triangle(angle) : std::cos(angle) + 0.4 * std::cos(2.0 * angle + 1.0));
        };
    }
    if (form == "spring" || form == "spring_hardening") {
        const double cubic = form == "spring" ? 0.0 : 0.3;
        return [=, a = value(e, "K"), b = value(e, "K0")](const plant_signals& s) {
            return a * s.q[j] * (1.0 + cubic * squared(s.q[j])) + b;
        };
    }
    if (form == "gravity_compensator" || form == "gravity_sine") {
        return [a = value(e, "Kc"), b = value(e, "Ks"), j](const plant_signals& s) {
            return a * std::cos(s.q[j]) + b * std::sin(s.q[j]);
        };
    }
    return {};
}

/// Forms outside the catalogue; an empty function for every other form.
signal_function outside_torque_of(const missing_effect& e) {
    const int j = e.joint, o = e.other;
    const double a = shape(e, "range"), b = shape(e, "other_range"), phase = shape(e, "phase"), c = value(e, "c");
    if (e.form == "position_product") {
        return [=](const plant_signals& s) { return 4.0 * c * (s.q[j] / a + phase) * (s.q[o] / b - phase); };
    }
    if (e.form == "sine_of_both") {
        return [=](const plant_signals& s) {
            return 2.0 * c * std::sin(2.5 * s.q[j] / a + phase) * std::cos(2.0 * s.q[o] / b + 2.0 * phase);
        };
    }
    if (e.form == "friction_by_other_position") {
        return [=](const plant_signals& s) { return 2.0 * c * s.slip[j] * (s.q[o] / b); };
    }
    return {};
}

/// Forms that are a torque at the effect's joint; an empty function for every other form.
signal_function torque_of(const missing_effect& e) {
    for (const auto& family : {velocity_torque_of, position_torque_of, outside_torque_of}) {
        if (signal_function torque = family(e)) {
            return torque;
        }
    }
    return {};
}

/// Forms that are dry friction at the effect's joint; an empty function for every other form.
signal_function dry_magnitude_of(const missing_effect& e) {
    const int j = e.joint;
    const std::string& form = e.form;
    if (form == "coulomb_friction") {
        return [a = value(e, "Fc")](const plant_signals&) { return a; };
    }
    if (form == "asymmetric_coulomb") {
        return [a = value(e, "Fca"), j](const plant_signals& s) { return s.qd[j] > 0.0 ? a : -a; };
    }
    if (form == "stribeck_friction") {
        return [a = value(e, "Fs"), vs = e.at("vs"), j](const plant_signals& s) {
            return a * std::exp(-squared(s.qd[j] / vs));
        };
    }
    if (form == "stribeck_exponent_one") {
        return [a = value(e, "Fs"), vs = e.at("vs"), j](const plant_signals& s) {
            return a * std::exp(-std::abs(s.qd[j]) / vs);
        };
    }
    if (form == "stribeck_tanh") {
        return [a = value(e, "Fs"), vs = e.at("vs"), j](const plant_signals& s) {
            return a * (1.0 - std::tanh(std::abs(s.qd[j]) / vs));
        };
    }
    if (form == "nonlinear_viscous_friction" && e.at("p") <= 1.0) {
        return [a = value(e, "Fp"), p = e.at("p"), j](const plant_signals& s) {
            return a * std::pow(std::abs(s.qd[j]), p);
        };
    }
    if (form == "viscous_logarithm") {
        return [a = value(e, "Fp"), v0 = e.at("v0"), j](const plant_signals& s) {
            return a * std::log1p(std::abs(s.qd[j]) / v0);
        };
    }
    if (form == "load_dependent_friction") {
        return [a = value(e, "Fl"), j](const plant_signals& s) { return a * std::abs(s.tau_rigid[j]); };
    }
    if (form == "load_saturating") {
        return [a = value(e, "Fl"), j](const plant_signals& s) { return a * std::pow(std::abs(s.tau_rigid[j]), 0.8); };
    }
    if (form == "position_dependent_friction") {
        return [a = value(e, "Fcc"), b = value(e, "Fcs"), k = e.at("k"), j](const plant_signals& s) {
            return a * std::cos(k * s.q[j]) + b * std::sin(k * s.q[j]);
        };
    }
    if (form == "position_friction_triangle") {
        const double amplitude = std::hypot(value(e, "Fcc"), value(e, "Fcs"));
        const double phase = std::atan2(value(e, "Fcs"), value(e, "Fcc"));
        return [=, k = e.at("k")](const plant_signals& s) { return amplitude * triangle(k * s.q[j] - phase); };
    }
    return {};
}

carried_load load_of(const missing_effect& e) {
    carried_load load{e.joint, {}, e.at("t0"), e.at("t1")};
    load.body.mass = e.size("M");
    for (int i = 0; i < 3; ++i) {
        load.body.centre[i] = e.at("x" + std::to_string(i));
        for (int j = i; j < 3; ++j) {
            const double entry = load.body.mass * e.at("I" + std::to_string(i) + std::to_string(j));
            load.body.central_inertia(i, j) = load.body.central_inertia(j, i) = entry;
        }
    }
    return load;
}

/// Gravity turned about the axes of the base that it is not along.
Eigen::Vector3d tilted(const Eigen::Vector3d& gravity, const missing_effect& e) {
    const Eigen::Vector3d turn(value(e, "tilt_x"), value(e, "tilt_y"), value(e, "tilt_z"));
    return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * gravity;
}

/// Inertias of the two sides of a transmission decide how stiff and how damped it is.
transmission soft(const missing_effect& e, const arm& robot) {
    const double stiffness = 1.0 / e.size("compliance");
    const double rotor = robot.drives[static_cast<std::size_t>(e.joint)].rotor_inertia;
    return {e.joint, stiffness, 2.0 * e.at("damping_ratio") * std::sqrt(stiffness * rotor), 0.0};
}

/// Contact of 80 Hz of the rotor on the flank, a fifth of the critical damping: stiff beside any motion.
transmission loose(const missing_effect& e, const arm& robot) {
    const double rotor = robot.drives[static_cast<std::size_t>(e.joint)].rotor_inertia;
    const double w = 2.0 * pi * 80.0;
    return {e.joint, rotor * w * w, 0.4 * rotor * w, e.size("gap")};
}

void add(const missing_effect& e, const arm& robot, plant_changes& changes) {
    if (signal_function torque = torque_of(e)) {
        changes.torques.push_back({e.joint, std::move(torque)});
    } else if (signal_function dry = dry_magnitude_of(e)) {
        changes.dry.push_back({{e.joint}, std::move(dry)});
    } else if (e.form == "joint_coupling") {
        changes.inertias.push_back({e.joint, e.other, e.size("Iac")});
        const double Fv = e.size("Fvc"), Fc = e.size("Fcc");
        const int a = e.joint, b = e.other;
        changes.torques.push_back({a, [Fv, b](const plant_signals& s) { return Fv * s.qd[b]; }});
        changes.torques.push_back({b, [Fv, a](const plant_signals& s) { return Fv * s.qd[a]; }});
        changes.dry.push_back({{a, b}, [Fc](const plant_signals&) { return Fc; }});
    } else if (e.form == "rotor_inertia") {
        changes.inertias.push_back({e.joint, e.joint, e.size("Ia")});
    } else if (e.form == "base_tilt") {
        changes.gravity = tilted(robot.gravity, e);
    } else if (e.form == "payload" || e.form == "permanent_payload") {
        changes.loads.push_back(load_of(e));
    } else if (e.form == "presliding_hysteresis" || e.form == "presliding_damped") {
        changes.bristles.push_back({e.joint, e.size("stretch"), e.form == "presliding_damped" ? 0.01 : 0.0});
    } else if (e.form == "joint_elasticity") {
        changes.transmissions.push_back(soft(e, robot));
    } else if (e.form == "backlash") {
        changes.transmissions.push_back(loose(e, robot));
    } else if (e.form == "torque_delay") {
        changes.delay[e.joint] += e.size("Td");
    } else if (e.form == "drive_gain_error" || e.form == "uncoupled_gain") {
        changes.gain[e.joint] *= 1.0 + e.size("gain");
    } else {
        throw std::invalid_argument("the plant knows no " + e.form);
    }
}

}  // namespace

plant_changes changes_of(const std::vector<missing_effect>& effects, const arm& robot) {
    plant_changes changes;
    changes.delay = Eigen::VectorXd::Zero(robot.dof());
    changes.gain = Eigen::VectorXd::Ones(robot.dof());
    for (const missing_effect& effect : effects) {
        add(effect, robot, changes);
    }
    return changes;
}

}  // namespace idim::undeclared
