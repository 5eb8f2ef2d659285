#include "undeclared/plant.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace idim::undeclared {

namespace {

/// Torque of a spring and damper behind a play of `gap` in all.
double transmitted(const transmission& t, double twist, double twist_rate) {
    const double play = 0.5 * t.gap;
    if (std::abs(twist) <= play) {
        return 0.0;
    }
    const double torque = t.stiffness * (twist - std::copysign(play, twist)) + t.damping * twist_rate;
    return torque * twist > 0.0 || play == 0.0 ? torque : 0.0;  // a flank pushes and never pulls
}

Eigen::VectorXd rotors_of(const arm& robot) {
    Eigen::VectorXd inertia(robot.dof());
    for (int j = 0; j < robot.dof(); ++j) {
        inertia[j] = robot.drives[static_cast<std::size_t>(j)].rotor_inertia;
    }
    return inertia;
}

}  // namespace

plant::plant(const arm& robot, const plant_changes& changes, double step, const Eigen::VectorXd& regularisation)
    : robot_(robot),
      changes_(changes),
      step_(step),
      regularisation_(regularisation),
      engine_(robot),
      nominal_(robot),
      loaded_(changes.loads.size(), false),
      rotors_(rotors_of(robot)),
      deflection_(changes.bristles.size(), 0.0),
      transmission_of_(robot.rows.size(), -1),
      bristle_of_(robot.rows.size(), -1) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.dof());
    signals_ = {0.0, zero, zero, zero, zero, zero, zero};
    link_q_ = link_velocity_ = drive_velocity_ = link_force_ = drive_force_ = declared_ = zero;
    for (int j = 0; j < robot.dof(); ++j) {
        rows_.push_back({{j}});
    }
    for (const dry_term& term : changes.dry) {
        if (term.joints.size() > 1) {
            rows_.push_back({term.joints});
        }
    }
    for (std::size_t i = 0; i < changes.transmissions.size(); ++i) {
        transmission_of_[static_cast<std::size_t>(changes.transmissions[i].joint)] = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < changes.bristles.size(); ++i) {
        bristle_of_[static_cast<std::size_t>(changes.bristles[i].joint)] = static_cast<int>(i);
    }
    if (changes.gravity) {
        engine_.set_gravity(*changes.gravity);
    }
}

bool plant::is_nominal() const {
    return !changes_.gravity && changes_.transmissions.empty() &&
           std::find(loaded_.begin(), loaded_.end(), true) == loaded_.end();
}

void plant::carry_loads() {
    for (std::size_t i = 0; i < changes_.loads.size(); ++i) {
        const carried_load& load = changes_.loads[i];
        const bool on = signals_.t >= load.from && signals_.t < load.until;
        if (on != loaded_[i]) {
            const solid& link = robot_.links[static_cast<std::size_t>(load.link)];
            engine_.set_link(load.link, on ? link + load.body : link);
            loaded_[i] = on;
        }
    }
}

/// Everything but dry friction: on links and stiff joints in link_force_, on rotors behind a transmission in
/// drive_force_.
void plant::collect_forces(const Eigen::VectorXd& tau) {
    drive_force_ = tau;
    for (int j = 0; j < robot_.dof(); ++j) {
        const drive& one = robot_.drives[static_cast<std::size_t>(j)];
        drive_force_[j] -= one.viscous * signals_.qd[j] + one.offset;
    }
    for (const torque_term& term : changes_.torques) {
        drive_force_[term.joint] -= term.torque(signals_);
    }
    for (std::size_t i = 0; i < changes_.bristles.size(); ++i) {
        const bristle& b = changes_.bristles[i];
        const double stiffness = robot_.drives[static_cast<std::size_t>(b.joint)].coulomb / b.stretch;
        const double v = signals_.qd[b.joint], z = deflection_[i];
        drive_force_[b.joint] -= stiffness * (z + b.damping * (v - std::abs(v) * z / b.stretch));
    }
    link_force_ = drive_force_ - N_;
    for (const transmission& t : changes_.transmissions) {
        const double torque =
            transmitted(t, signals_.q[t.joint] - link_q_[t.joint], drive_velocity_[t.joint] - link_velocity_[t.joint]);
        drive_force_[t.joint] -= torque;
        link_force_[t.joint] = torque - N_[t.joint];
    }
}

void plant::set_magnitudes() {
    for (int j = 0; j < robot_.dof(); ++j) {
        const bool replaced = bristle_of_[static_cast<std::size_t>(j)] >= 0;
        rows_[static_cast<std::size_t>(j)].magnitude =
            replaced ? 0.0 : robot_.drives[static_cast<std::size_t>(j)].coulomb;
    }
    std::size_t several = robot_.rows.size();
    for (const dry_term& term : changes_.dry) {
        if (term.joints.size() > 1) {
            rows_[several++].magnitude = term.magnitude(signals_);
        } else {
            rows_[static_cast<std::size_t>(term.joints.front())].magnitude += term.magnitude(signals_);
        }
    }
}

/// Velocities at the end of the step. Row i: v = v0 - w lambda with lambda = c v / eps within |v| <= eps and c beyond.
void plant::solve_friction() {
    constexpr int most_sweeps = 50;
    const auto row_velocity = [&](const dry_row& row) {
        double v = 0.0;
        for (const int j : row.joints) {
            v += drive_velocity_[j];
        }
        return v;
    };
    const auto push = [&](const dry_row& row, double impulse) {
        for (const int j : row.joints) {
            if (transmission_of_[static_cast<std::size_t>(j)] >= 0) {
                drive_velocity_[j] -= step_ * impulse / rotors_[j];
                continue;
            }
            link_velocity_ -= step_ * impulse * compliance_.col(j);
            for (int i = 0; i < robot_.dof(); ++i) {
                if (transmission_of_[static_cast<std::size_t>(i)] < 0) {
                    drive_velocity_[i] = link_velocity_[i];
                }
            }
        }
    };
    for (dry_row& row : rows_) {  // the last step's impulses are a good guess
        row.impulse = std::clamp(row.impulse, -std::max(row.magnitude, 0.0), std::max(row.magnitude, 0.0));
        push(row, row.impulse);
    }
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double change = 0.0;
        for (dry_row& row : rows_) {
            const double c = std::max(row.magnitude, 0.0), eps = regularisation_[row.joints.front()];
            double w = 0.0;
            for (const int j : row.joints) {
                for (const int k : row.joints) {
                    const bool apart = transmission_of_[static_cast<std::size_t>(j)] >= 0 ||
                                       transmission_of_[static_cast<std::size_t>(k)] >= 0;
                    w += step_ * (apart ? (j == k ? 1.0 / rotors_[j] : 0.0) : compliance_(j, k));
                }
            }
            const double v0 = row_velocity(row) + w * row.impulse;
            const double impulse =
                c == 0.0 ? 0.0 : (std::abs(v0) >= w * c + eps ? std::copysign(c, v0) : v0 / (w + eps / c));
            push(row, impulse - row.impulse);
            change = std::max(change, std::abs(impulse - row.impulse) / (c > 0.0 ? c : 1.0));
            row.impulse = impulse;
        }
        if (change < 1e-9) {
            return;
        }
    }
}

void plant::advance_bristles() {
    for (std::size_t i = 0; i < changes_.bristles.size(); ++i) {
        const bristle& b = changes_.bristles[i];
        const double v = drive_velocity_[b.joint], full = std::copysign(b.stretch, v);
        deflection_[i] = full + (deflection_[i] - full) * std::exp(-std::abs(v) * step_ / b.stretch);
    }
}

void plant::declare(const joint_matrix& links_M) {
    Eigen::VectorXd& rigid = signals_.tau_rigid;
    if (is_nominal()) {
        rigid = links_M * signals_.qdd + N_;
    } else {
        nominal_.inverse_dynamics(signals_.q, signals_.qd, signals_.qdd, rigid);
    }
    declared_ = rigid + rotors_.cwiseProduct(signals_.qdd);
    for (int j = 0; j < robot_.dof(); ++j) {
        const drive& one = robot_.drives[static_cast<std::size_t>(j)];
        const dry_row& row = rows_[static_cast<std::size_t>(j)];
        const double v = drive_velocity_[j], eps = regularisation_[j];
        const double moves = eps > 0.0 ? std::clamp(v / eps, -1.0, 1.0) : (v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0));
        signals_.slip[j] = row.magnitude > 0.0 ? row.impulse / row.magnitude : moves;
        declared_[j] += one.viscous * signals_.qd[j] + one.coulomb * signals_.slip[j] + one.offset;
    }
}

void plant::advance(const Eigen::VectorXd& tau, const Eigen::VectorXd& temperature) {
    carry_loads();
    signals_.temperature = temperature;
    signals_.qd = drive_velocity_ + 0.5 * step_ * signals_.qdd;
    Eigen::VectorXd link_qd = signals_.qd;
    for (const transmission& t : changes_.transmissions) {
        link_qd[t.joint] = link_velocity_[t.joint];
    }
    engine_.equations_of_motion(link_q_, link_qd, M_, N_);
    const joint_matrix links_M = M_;
    for (int j = 0; j < robot_.dof(); ++j) {
        M_(j, j) += transmission_of_[static_cast<std::size_t>(j)] >= 0 ? 0.0 : rotors_[j];
    }
    for (const coupled_inertia& c : changes_.inertias) {
        M_(c.joint, c.other) += c.inertia;
        M_(c.other, c.joint) += c.joint == c.other ? 0.0 : c.inertia;
    }
    compliance_ = M_.llt().solve(joint_matrix::Identity(robot_.dof(), robot_.dof()));
    collect_forces(tau);
    set_magnitudes();
    const Eigen::VectorXd before = drive_velocity_;
    link_velocity_ += step_ * (compliance_ * link_force_);
    for (int j = 0; j < robot_.dof(); ++j) {
        const bool apart = transmission_of_[static_cast<std::size_t>(j)] >= 0;
        drive_velocity_[j] = apart ? drive_velocity_[j] + step_ * drive_force_[j] / rotors_[j] : link_velocity_[j];
    }
    solve_friction();
    advance_bristles();
    signals_.qdd = (drive_velocity_ - before) / step_;
    declare(links_M);
    link_q_ += step_ * link_velocity_;
    signals_.q += step_ * drive_velocity_;
    signals_.t += step_;
}

}  // namespace idim::undeclared
