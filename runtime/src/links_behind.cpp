#include "links_behind.hpp"

#include <algorithm>

#include "idim/recorded_states.hpp"
#include "swing_start.hpp"

namespace idim {

namespace {

constexpr int start_steps = 2;  // a free swing leaves out that gravity changes with the link: some per cent of it

std::vector<int> joints_of(const std::vector<soft_transmission>& soft) {
    std::vector<int> joints;
    for (const soft_transmission& t : soft) {
        joints.push_back(t.joint);
    }
    return joints;
}

// The inertia stands on the left of the equation of the twist: what is left for the next step is that gravity and
// velocities act on the links where they are, a hundredth of the stiffness or less.
filtered_samples from_start(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                            const links_torque& torque, const twist_state& more) {
    constexpr int most_steps = 30;
    constexpr double settled = 1e-11;
    filtered_samples link = motor;
    double change = 1.0;
    for (int step = 0; step < most_steps && change > settled; ++step) {
        const swing_dynamics dynamics = dynamics_of(link, motor, soft, torque);
        const twist_motion twist = swing(dynamics, soft, motor.rate, slow_start(dynamics, soft, motor.rate) + more);
        const Eigen::MatrixXd before = link.q;
        for (std::size_t i = 0; i < soft.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            const int j = soft[i].joint;
            link.q.col(j) = motor.q.col(j) - twist.angle.col(column);
            link.qd.col(j) = motor.qd.col(j) - twist.rate.col(column);
            link.qdd.col(j) = motor.qdd.col(j) - twist.acceleration.col(column);
        }
        change = (link.q - before).cwiseAbs().maxCoeff() / std::max(1.0, motor.q.cwiseAbs().maxCoeff());
        if (!link.q.allFinite() || !link.qdd.allFinite()) {
            return motor;
        }
    }
    return link;
}

twist_state found_start(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                        const links_torque& torque, const lacking_torque& lacking) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    const twist_state none{Eigen::VectorXd::Zero(s), Eigen::VectorXd::Zero(s)};
    if (!lacking) {
        return none;
    }
    const swing_dynamics rigid = dynamics_of(motor, motor, soft, torque);
    const Eigen::Index count = free_samples(rigid, soft, motor.rate);
    if (count == 0) {
        return none;
    }
    const filtered_samples head = motor.part(0, count);
    twist_state start = none;
    for (int step = 0; step < start_steps; ++step) {
        const filtered_samples link = from_start(head, soft, torque, start);
        start = start + free_start(dynamics_of(link, head, soft, torque), soft, motor.rate,
                                   lacking(head, link)(Eigen::all, joints_of(soft)));
    }
    return start;
}

}  // namespace

std::vector<soft_transmission> transmissions_of(const idim_model_interface& model) {
    std::vector<soft_transmission> soft;
    for (int j = 0; j < model.dof; ++j) {
        if (const double stiffness = stiffness_of(model, j); stiffness > 0.0) {
            soft.push_back({j, stiffness, damping_of(model, j)});
        }
    }
    return soft;
}

Eigen::MatrixXd rigid_torques(const idim_model_interface& model, const filtered_samples& links,
                              const Eigen::VectorXd& chi) {
    Eigen::MatrixXd torque(links.samples(), model.dof);
    Eigen::VectorXd at(model.dof);
    for (Eigen::Index k = 0; k < links.samples(); ++k) {
        const Eigen::VectorXd q = links.q.row(k);
        const Eigen::VectorXd qd = links.qd.row(k);
        const Eigen::VectorXd qdd = links.qdd.row(k);
        model.rigid_torque(q.data(), qd.data(), qdd.data(), links.t[k], chi.data(), at.data());
        torque.row(k) = at;
    }
    return torque;
}

swing_dynamics dynamics_of(const filtered_samples& link, const filtered_samples& motor,
                           const std::vector<soft_transmission>& soft, const links_torque& torque) {
    const auto s = static_cast<Eigen::Index>(soft.size());
    const std::vector<int> joints = joints_of(soft);
    filtered_samples probe = link;
    probe.qdd = motor.qdd;
    swing_dynamics found{torque(probe)(Eigen::all, joints), Eigen::MatrixXd(motor.samples(), s * s)};
    for (Eigen::Index i = 0; i < s; ++i) {
        const int joint = joints[static_cast<std::size_t>(i)];
        probe.qdd.col(joint).array() += 1.0;
        found.inertia.middleCols(i * s, s) = torque(probe)(Eigen::all, joints) - found.forcing;
        probe.qdd.col(joint) = motor.qdd.col(joint);
    }
    return found;
}

filtered_samples links_behind(const filtered_samples& motor, const std::vector<soft_transmission>& soft,
                              const links_torque& torque, const lacking_torque& lacking) {
    return soft.empty() || motor.samples() == 0
               ? motor
               : from_start(motor, soft, torque, found_start(motor, soft, torque, lacking));
}

}  // namespace idim
