#include "undeclared/joint_scales.hpp"

#include "undeclared/rigid_body_engine.hpp"

namespace idim::undeclared {

joint_scales scales_along(const arm& robot, const motion& reference) {
    constexpr int samples = 600;
    rigid_body_engine engine(robot);
    const int n = robot.dof();
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
    joint_scales scales{zero, zero, zero, zero, zero};
    joint_matrix M;
    Eigen::VectorXd N;
    for (int k = 0; k < samples; ++k) {
        const reference_point point = reference.at(reference.duration() * k / samples);
        engine.equations_of_motion(point.q, point.qd, M, N);
        Eigen::VectorXd tau = M * point.qdd + N;
        for (int j = 0; j < n; ++j) {
            const drive& one = robot.drives[static_cast<std::size_t>(j)];
            tau[j] += one.rotor_inertia * point.qdd[j] + one.viscous * point.qd[j] + one.offset +
                      one.coulomb * (point.qd[j] > 0.0 ? 1.0 : -1.0);
        }
        scales.torque += tau.cwiseAbs2() / samples;
        scales.speed += point.qd.cwiseAbs2() / samples;
        scales.top_speed = scales.top_speed.cwiseMax(point.qd.cwiseAbs());
        scales.range = scales.range.cwiseMax(point.q.cwiseAbs());
        scales.inertia += M.diagonal() / samples;
    }
    scales.torque = scales.torque.cwiseSqrt();
    scales.speed = scales.speed.cwiseSqrt();
    return scales;
}

void size_drives(arm& robot, const joint_scales& scales, bool offsets, sampler& random) {
    for (int j = 0; j < robot.dof(); ++j) {
        drive& one = robot.drives[static_cast<std::size_t>(j)];
        one.rotor_inertia = scales.inertia[j] * random.uniform(0.3, 1.2);
        const double torque = std::hypot(scales.torque[j], one.rotor_inertia * scales.speed[j]);
        one.coulomb = torque * random.uniform(0.1, 0.5);
        one.viscous = torque / scales.speed[j] * random.uniform(0.05, 0.4);
        one.offset = offsets ? torque * random.uniform(-0.1, 0.1) : 0.0;
    }
}

}  // namespace idim::undeclared
