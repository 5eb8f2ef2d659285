// Effects of the catalogue that are more than a torque by an expression of the joint's motion, declared at an arm: the
// generated models against Orocos KDL and closed forms, and their identification from smooth simulated motion.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "description/robot_description.hpp"
#include "idim/fitted_rows.hpp"
#include "idim/log_parameters.hpp"
#include "idim/recorded_states.hpp"
#include "oracles/kdl_robot.hpp"
#include "support/robot_files.hpp"
#include "support/sign.hpp"
#include "support/test_model.hpp"

namespace idim::test {

namespace {

const char* const bare_arm =
    "name: arm\n"
    "joints:\n"
    "  - {name: j1, theta: q}\n"
    "  - {name: j2, alpha: pi/2, theta: q, d: 0.1}\n"
    "  - {name: j3, theta: q, d: 0.4}\n"
    "effects:\n"
    "  - viscous_friction\n";

/// What a closed form may depend on beside the motion.
struct conditions {
    double t = 0.0;
    Eigen::VectorXd state;
};

/// The arm with effects more, links that could exist, and its oracle.
class declared_arm {
  public:
    explicit declared_arm(const std::string& effects)
        : file_(folder_.write("arm.yaml", bare_arm + effects)),
          model(file_),
          table(mdh_table_of(generator::read_robot(file_))) {
        std::mt19937_64 random(31);
        links = plausible_links(3, random);
        standard = standard_parameters_of(links);
        standard["Fv1"] = 3.0;
        standard["Fv2"] = 2.0;
        standard["Fv3"] = 0.5;
    }

    Eigen::VectorXd chi() const { return model.regroup(standard); }
    Eigen::VectorXd rigid(const joint_state& s) const { return kdl_robot(table, links).inverse_dynamics(s); }
    Eigen::VectorXd viscous(const joint_state& s) const {
        return Eigen::Vector3d(3.0, 2.0, 0.5).cwiseProduct(Eigen::Vector3d(s.qd));
    }

    /// The signals of model_interface.h at a state.
    Eigen::VectorXd signals(const joint_state& s, const conditions& c) const {
        const idim_model_interface& m = model.interface();
        Eigen::VectorXd result = Eigen::VectorXd::Zero(std::max(3, m.n_signals));
        result.segment(3, m.n_states) = c.state;
        if (m.needs_rigid_torque != 0) {
            result.tail(3) = rigid(s);
        }
        return result;
    }

  private:
    temporary_folder folder_;
    std::string file_;

  public:
    test_model model;
    mdh_table table;
    std::vector<rigid_link> links;
    value_table standard;
};

using closed_form = std::function<Eigen::VectorXd(const joint_state&, const conditions&)>;

/// The models at random states against the closed form of the whole torque, and against each other.
void expect_torque(const declared_arm& robot, const closed_form& torque, const closed_form& state = {}) {
    std::mt19937_64 random(32);
    const Eigen::VectorXd chi = robot.chi();
    for (int k = 0; k < 30; ++k) {
        const joint_state s = random_state(3, random);
        conditions c{0.1 * k, {}};
        if (state) {
            c.state = state(s, c);
        }
        const Eigen::VectorXd signals = robot.signals(s, c);
        const Eigen::VectorXd expected = torque(s, c);
        const Eigen::VectorXd tau = robot.model.inverse_dynamics(s, chi, c.t, signals);
        // Rounding of some hundred operations.
        EXPECT_LE(deviation(tau, expected), 1e-10);
        EXPECT_LE(deviation(robot.model.regressor(s, c.t, signals) * chi, expected), 1e-10);
        int pivot = -1;
        EXPECT_LE(deviation(robot.model.forward_dynamics(s, tau, chi, pivot, c.t, signals), s.qdd), 1e-9);
        EXPECT_EQ(pivot, 0);
        joint_state still = s;
        still.qdd.setZero();
        EXPECT_LE(
            deviation(robot.model.bias(s, chi, c.t, signals), robot.model.inverse_dynamics(still, chi, c.t, signals)),
            1e-12);
    }
}

/// Sums of sines with their derivatives.
joint_state smooth_motion(double t, double phase = 0.0) {
    const double pi = M_PI;
    joint_state s{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    const double frequency[3][3] = {{0.31, 0.53, 0.87}, {0.27, 0.61, 0.97}, {0.37, 0.47, 0.79}};
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const double w = 2.0 * pi * frequency[j][i];
            const double a = 0.8 / (i + 1);
            const double angle = w * t + 1.3 * i + 0.7 * j + phase;
            s.q[j] += a * std::sin(angle);
            s.qd[j] += a * w * std::cos(angle);
            s.qdd[j] -= a * w * w * std::sin(angle);
        }
    }
    return s;
}

/// Exact motion with the torque of a closed form of time.
filtered_samples recorded(const std::function<Eigen::VectorXd(double)>& torque, double phase = 0.0) {
    constexpr Eigen::Index samples = 6000;
    filtered_samples log;
    log.file = "simulated";
    log.rate = 500.0;
    log.t.resize(samples);
    for (const auto signal :
         {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd, &filtered_samples::tau}) {
        (log.*signal).resize(samples, 3);
    }
    for (Eigen::Index k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) / log.rate;
        const joint_state s = smooth_motion(t, phase);
        log.t[k] = t;
        log.q.row(k) = s.q;
        log.qd.row(k) = s.qd;
        log.qdd.row(k) = s.qdd;
        log.tau.row(k) = torque(t);
    }
    return log;
}

filter_choice by_five() {
    filter_choice choice;
    choice.decimation = 5;
    return choice;
}

/// Identified parameters of the logs beside the truth, relative to its largest element.
void expect_recovered(const declared_arm& robot, const std::vector<filtered_samples>& logs, double tolerance) {
    const fitted_rows fit = fit_rows(robot.model.interface(), logs, by_five(), least_squares_method::ols);
    ASSERT_EQ(fit.result.chi.size(), fit.rows.n_base) << fit.result.message;
    EXPECT_TRUE(fit.result.converged) << fit.result.message;
    EXPECT_LE(deviation(fit.result.chi.head(robot.model.n_base()), robot.chi()), tolerance);
}

}  // namespace

TEST(DeclaredEffect, DriveGainErrorScalesTheTorqueOfItsJoint) {
    declared_arm robot("  - {effect: drive_gain_error, joints: [j2], shape: {Ke: 0.1}}\n");
    const Eigen::Vector3d gain(1.0, 1.1, 1.0);
    const auto torque = [&](const joint_state& s, const conditions&) {
        return Eigen::VectorXd(gain.cwiseProduct(Eigen::Vector3d(robot.rigid(s) + robot.viscous(s))));
    };
    expect_torque(robot, torque);
    expect_recovered(robot, {recorded([&](double t) { return torque(smooth_motion(t), {}); })}, 1e-9);
    const declared_arm plain("");
    const Eigen::VectorXd q = smooth_motion(0.3).q;
    EXPECT_LE(
        deviation(robot.model.mass_matrix(q, robot.chi()), gain.asDiagonal() * plain.model.mass_matrix(q, plain.chi())),
        1e-12);
}

TEST(DeclaredEffect, BaseTiltTurnsGravityAboutXThenY) {
    declared_arm robot("  - {effect: base_tilt, shape: {tilt_x: 0.05, tilt_y: -0.1}}\n");
    const Eigen::Vector3d turned = Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()) * Eigen::Vector3d(0, 0, -9.81);
    robot.table.gravity = {turned[0], turned[1], turned[2]};
    const auto torque = [&](const joint_state& s, const conditions&) {
        return Eigen::VectorXd(robot.rigid(s) + robot.viscous(s));
    };
    expect_torque(robot, torque);
    expect_recovered(robot, {recorded([&](double t) { return torque(smooth_motion(t), {}); })}, 1e-8);
    // The first axis no longer stands upright, so that gravity tells of the first moments about it.
    EXPECT_GT(robot.model.n_base(), declared_arm("").model.n_base());
}

TEST(DeclaredEffect, PayloadCountsFromItsStartToBeforeItsEnd) {
    declared_arm robot("  - {effect: payload, joints: [j3], shape: {t0: 1, t1: 2}}\n");
    std::mt19937_64 random(33);
    std::vector<rigid_link> load(3);
    load[2] = plausible_links(1, random).front();
    for (const auto& [name, value] : standard_parameters_of(load)) {
        if (name.back() == '3') {
            robot.standard["P" + name] = value;
        }
    }
    const auto torque = [&](const joint_state& s, const conditions& c) {
        const bool on = c.t >= 1.0 && c.t < 2.0;
        const Eigen::VectorXd carried = kdl_robot(robot.table, load).inverse_dynamics(s);
        return Eigen::VectorXd(robot.rigid(s) + robot.viscous(s) + (on ? 1.0 : 0.0) * carried);
    };
    expect_torque(robot, torque);
    EXPECT_EQ(robot.model.interface().needs_time, 1);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(3);
    for (const auto& [t, on] : {std::pair{1.0, true}, {2.0, false}, {std::nextafter(2.0, 1.0), true}}) {
        const joint_state s = smooth_motion(0.2);
        EXPECT_LE(deviation(robot.model.inverse_dynamics(s, robot.chi(), t, none), torque(s, {on ? 1.5 : 0.0, {}})),
                  1e-10);
    }
    // Where the load comes and goes the decimation filter smears both sides alike.
    expect_recovered(robot, {recorded([&](double t) { return torque(smooth_motion(t), {t, {}}); })}, 1e-7);
}

TEST(DeclaredEffect, LoadDependentFrictionFollowsTheTorqueOfTheLinks) {
    declared_arm robot("  - {effect: load_dependent_friction, joints: [j2, j3]}\n");
    robot.standard["Fl2"] = 0.15;
    robot.standard["Fl3"] = 0.08;
    const auto torque = [&](const joint_state& s, const conditions&) {
        const Eigen::VectorXd rigid = robot.rigid(s);
        Eigen::VectorXd friction = robot.viscous(s);
        friction[1] += 0.15 * std::abs(rigid[1]) * sign(s.qd[1]);
        friction[2] += 0.08 * std::abs(rigid[2]) * sign(s.qd[2]);
        return Eigen::VectorXd(rigid + friction);
    };
    expect_torque(robot, torque);
    // The iteration ends where the torque moves by less than 1e-9; parameters are worse conditioned than the torque.
    expect_recovered(robot, {recorded([&](double t) { return torque(smooth_motion(t), {}); })}, 1e-6);
}

TEST(DeclaredEffect, PreslidingHysteresisRunsItsBristles) {
    declared_arm robot("  - {effect: presliding_hysteresis, joints: [j2], shape: {zs: 0.05}}\n");
    robot.standard["Fh2"] = 2.5;
    const auto torque = [&](const joint_state& s, const conditions& c) {
        return Eigen::VectorXd(robot.rigid(s) + robot.viscous(s) + 2.5 * c.state[0] * Eigen::Vector3d::Unit(1));
    };
    expect_torque(robot, torque, [](const joint_state& s, const conditions&) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, std::sin(3.0 * s.q[0])));
    });
    std::vector<double> z;  // Dahl's bristle, exact while the speed is held
    for (int k = 0; k < 6000; ++k) {
        const double v = smooth_motion(k / 500.0).qd[1];
        const double next_v = k == 0 ? 0.0 : smooth_motion((k - 1) / 500.0).qd[1];
        z.push_back(k == 0 ? sign(v) : sign(next_v) + (z.back() - sign(next_v)) * std::exp(-std::abs(next_v) / 25.0));
    }
    const filtered_samples log = recorded([&](double t) {
        const auto k = static_cast<std::size_t>(std::lround(t * 500.0));
        return torque(smooth_motion(t), {t, Eigen::VectorXd::Constant(1, z[k])});
    });
    expect_recovered(robot, {log}, 1e-8);
    EXPECT_LE(deviation(model_torques(robot.model.interface(), log, robot.chi()), log.tau), 1e-10);
}

TEST(DeclaredEffect, BacklashCarriesNoLoadInsideItsGap) {
    declared_arm robot(
        "  - {effect: rotor_inertia, joints: [j3]}\n"
        "  - {effect: backlash, joints: [j3], shape: {b: 0.05}}\n");
    robot.standard["Ia3"] = 0.3;
    robot.standard["Bl3"] = 1.0;
    const auto torque = [&](const joint_state& s, const conditions& c) {
        Eigen::VectorXd tau = robot.rigid(s);
        tau[2] = std::abs(c.state[0]) >= 0.999 * 0.025 ? tau[2] : 0.0;
        tau[2] += 0.3 * s.qdd[2];
        return Eigen::VectorXd(tau + robot.viscous(s));
    };
    expect_torque(robot, torque, [](const joint_state& s, const conditions&) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, s.q[0] > 0.0 ? 0.025 : 0.01));
    });
    std::vector<double> x = {0.025 * sign(smooth_motion(0.0).qd[2])};
    for (int k = 1; k < 6000; ++k) {
        x.push_back(std::clamp(x.back() + smooth_motion((k - 1) / 500.0).qd[2] / 500.0, -0.025, 0.025));
    }
    const filtered_samples log = recorded([&](double t) {
        const auto k = static_cast<std::size_t>(std::lround(t * 500.0));
        return torque(smooth_motion(t), {t, Eigen::VectorXd::Constant(1, x[k])});
    });
    expect_recovered(robot, {log}, 1e-6);
}

TEST(DeclaredEffect, TorqueDelayTakesTheRowsOfAnEarlierState) {
    declared_arm robot("  - {effect: torque_delay, joints: [j2], shape: {Td: 0.0137}}\n");
    const auto torque = [&](double t) {
        const joint_state late = smooth_motion(t - 0.0137);
        const joint_state now = smooth_motion(t);
        Eigen::VectorXd tau = robot.rigid(now) + robot.viscous(now);
        tau[1] = (robot.rigid(late) + robot.viscous(late))[1];
        return tau;
    };
    const filtered_samples log = recorded(torque);
    const Eigen::MatrixXd found = model_torques(robot.model.interface(), log, robot.chi());
    // Cubic interpolation over 2 ms of motion below 1 Hz; the first samples have no earlier state.
    EXPECT_LE(deviation(found.bottomRows(5980), log.tau.bottomRows(5980)), 1e-7);
    // The decimation filter smears the first samples over the rows behind them.
    expect_recovered(robot, {log}, 1e-3);
}

TEST(DeclaredEffect, JointElasticityPutsTheLinkBehindItsMotor) {
    // One link that swings: q_motor = q_link + tau / K with the derivatives of tau in closed form.
    const temporary_folder folder;
    const test_model model(
        folder.write("swing.yaml",
                     "name: swing\njoints:\n  - {name: j1, alpha: pi/2, theta: q}\neffects:\n  - rotor_inertia\n"
                     "  - viscous_friction\n  - {effect: joint_elasticity, shape: {K: 20000}}\n"));
    const double J = 1.5, G = 9.81 * 0.8, K = 20000.0, Ia = 0.4, Fv = 3.0;
    filtered_samples log;
    log.rate = 1000.0;
    constexpr Eigen::Index samples = 12000;
    log.t.resize(samples);
    for (const auto signal :
         {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd, &filtered_samples::tau}) {
        (log.*signal).resize(samples, 1);
    }
    for (Eigen::Index k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) / log.rate;
        std::array<double, 5> q{};  // of the link, with its derivatives
        for (const auto& [a, w] : {std::pair{0.9, 2.1}, {0.5, 5.7}}) {
            for (std::size_t d = 0; d < q.size(); ++d) {
                q[d] += a * std::pow(w, static_cast<double>(d)) * std::sin(w * t + 0.5 * M_PI * static_cast<double>(d));
            }
        }
        const double c = std::cos(q[0]), s = std::sin(q[0]);
        const double load = J * q[2] + G * c;
        const double load_rate = J * q[3] - G * s * q[1];
        const double load_acceleration = J * q[4] - G * (c * q[1] * q[1] + s * q[2]);
        log.t[k] = t;
        log.q(k, 0) = q[0] + load / K;
        log.qd(k, 0) = q[1] + load_rate / K;
        log.qdd(k, 0) = q[2] + load_acceleration / K;
        log.tau(k, 0) = load + Ia * log.qdd(k, 0) + Fv * log.qd(k, 0);
    }
    const Eigen::VectorXd truth = model.regroup({{"ZZ1", J}, {"MX1", 0.8}, {"Ia1", Ia}, {"Fv1", Fv}});
    const fitted_rows fit = fit_rows(model.interface(), {log}, by_five(), least_squares_method::ols);
    ASSERT_EQ(fit.result.chi.size(), truth.size()) << fit.result.message;
    // The sum of both inertias is what slow motion tells; the twist, 0.3 % of the motion, parts it between link and
    // rotor.
    const std::vector<std::string> names = model.parameter_names();
    Eigen::Vector3d found = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < names.size(); ++k) {
        const double value = fit.result.chi[static_cast<Eigen::Index>(k)];
        found[0] += names[k].rfind("ZZ1", 0) == 0 || names[k] == "Ia1" ? value : 0.0;
        found[1] += names[k] == "MX1" ? value : 0.0;
        found[2] += names[k] == "Fv1" ? value : 0.0;
    }
    EXPECT_LE(deviation(found, Eigen::Vector3d(J + Ia, 0.8, Fv)), 5e-3);
    EXPECT_LE(deviation(model_torques(model.interface(), log, truth).middleRows(500, samples - 1000),
                        log.tau.middleRows(500, samples - 1000)),
              1e-4);
}

TEST(DeclaredEffect, PhaseOfAPeriodicDisturbanceIsEachLogsOwn) {
    declared_arm robot("  - {effect: periodic_disturbance, joints: [j2], shape: {w: 9}}\n");
    const auto log_with = [&](double phase) {
        return recorded(
            [&robot, phase](double t) {
                const joint_state s = smooth_motion(t, phase);
                return Eigen::VectorXd(robot.rigid(s) + robot.viscous(s) +
                                       1.7 * std::cos(9.0 * t + phase) * Eigen::Vector3d::Unit(1));
            },
            phase);
    };
    const std::vector<filtered_samples> logs = {log_with(0.0), log_with(1.1)};
    const idim_model_interface& model = robot.model.interface();
    const fitted_rows fit = fit_rows(model, logs, by_five(), least_squares_method::ols);
    ASSERT_EQ(fit.result.chi.size(), robot.model.n_base() + 2);
    EXPECT_LE(fit.result.residual.relative_error, 1e-9);
    const Eigen::Index last = fit.result.chi.size() - 2;
    EXPECT_NEAR(fit.result.chi[last], 1.7 * std::cos(1.1), 1e-8);
    EXPECT_NEAR(fit.result.chi[last + 1], -1.7 * std::sin(1.1), 1e-8);
    // Validation on another log refits its phase.
    const observation other = with_log_columns(model, observe(model, {log_with(2.3)}, by_five()));
    const Eigen::VectorXd chi = with_log_parameters(model, other, fit.result.chi.head(robot.model.n_base()));
    EXPECT_LE(errors(other, chi).relative_error, 1e-8);
}

}  // namespace idim::test
