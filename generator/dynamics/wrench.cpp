#include "dynamics/wrench.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Differences of the squares of W, named where they are needed: [0] is Wy^2 - Wz^2 and so on.
ex square_difference(symbolic_model& model, const vector3& squares, std::size_t at, const std::string& label) {
    static const char* const names[] = {"U2233_", "U3311_", "U1122_"};
    return model.assign(names[at] + label, squares[(at + 1) % 3] - squares[(at + 2) % 3]);
}

/// Moment about z that moves a body with U and VP of its origin.
ex axial_moment(symbolic_model& model, const carrying_motion& motion, const mass_moments& body,
                const std::string& label) {
    const matrix3& U = motion.U;
    const symmetric3& K = body.K;
    const ex u1122 = K.xy.is_zero() ? ex(0) : square_difference(model, motion.squares, 2, label);
    const bool needs_sum_alone = motion.WxWy.is_zero() || (K.xx - K.yy).is_zero();
    const ex diagonal =
        needs_sum_alone ? inertia_about_z(model, body, label) * motion.WP_z : U[1][0] * K.xx - U[0][1] * K.yy;
    return diagonal - u1122 * K.xy + U[1][2] * K.xz - U[0][2] * K.yz + body.S[0] * motion.VP[1] -
           body.S[1] * motion.VP[0];
}

}  // namespace

wrench add(symbolic_model& model, const std::string& name, const wrench& a, const wrench& b) {
    return {model.assign("f" + name, add(a.force, b.force)), model.assign("n" + name, add(a.moment, b.moment))};
}

wrench joint_to_antecedent(symbolic_model& model, const std::string& name, const link_frame& frame, const wrench& w) {
    const vector3 force = frame.joint_to_antecedent("f" + name, w.force);
    const vector3 moment = frame.joint_to_antecedent("n" + name, w.moment);
    return {force, model.assign("n" + name + "_at", add(moment, cross(frame.position(), force)))};
}

wrench wrench_of_body(symbolic_model& model, const link_motion& motion, const mass_moments& body,
                      const std::string& label) {
    const matrix3& U = motion.U;
    const symmetric3& K = body.K;
    const vector3& S = body.S;
    const ex u2233 = K.yz.is_zero() ? ex(0) : square_difference(model, motion.squares, 0, label);
    const ex u3311 = K.xz.is_zero() ? ex(0) : square_difference(model, motion.squares, 1, label);
    const vector3 lever = cross(S, motion.VP);
    const vector3 moment = {
        U[2][1] * K.yy - U[1][2] * K.zz + U[2][0] * K.xy - U[1][0] * K.xz - u2233 * K.yz + lever[0],
        U[0][2] * K.zz - U[2][0] * K.xx - U[2][1] * K.xy - u3311 * K.xz + U[0][1] * K.yz + lever[1],
        axial_moment(model, {motion.W, motion.VP, U, motion.squares, motion.WxWy, motion.WP[2]}, body, label),
    };
    const vector3 force = {body.M * motion.VP[0] + dot(U[0], S), body.M * motion.VP[1] + dot(U[1], S),
                           body.M * motion.VP[2] + dot(U[2], S)};
    return {model.assign("F" + label, force), model.assign("N" + label, moment)};
}

wrench wrench_of_link(symbolic_model& model, const link_motion& motion, const parameter_values& values, int link,
                      const std::string& label) {
    const matrix3& U = motion.U;
    const symmetric3 J = values.inertia(link);
    const vector3 S = values.first_moments(link);
    const ex mass = values.inertial(link, parameter_kind::M);
    const ex zzyy = model.assign("ZZYY" + label, J.zz - J.yy);
    const ex xxzz = model.assign("XXZZ" + label, J.xx - J.zz);
    const ex yyxx = model.assign("YYXX" + label, J.yy - J.xx);
    const ex u2233 = J.yz.is_zero() ? ex(0) : square_difference(model, motion.squares, 0, label);
    const ex u3311 = J.xz.is_zero() ? ex(0) : square_difference(model, motion.squares, 1, label);
    const ex u1122 = J.xy.is_zero() ? ex(0) : square_difference(model, motion.squares, 2, label);
    const vector3 lever = cross(S, motion.VP);
    const vector3 moment = {
        J.xx * motion.WP[0] + zzyy * motion.WyWz - J.xy * U[2][0] + J.xz * U[1][0] + J.yz * u2233 + lever[0],
        J.yy * motion.WP[1] + xxzz * motion.WxWz + J.xy * U[2][1] + J.xz * u3311 - J.yz * U[0][1] + lever[1],
        J.zz * motion.WP[2] + yyxx * motion.WxWy + J.xy * u1122 - J.xz * U[1][2] + J.yz * U[0][2] + lever[2],
    };
    const vector3 force = {mass * motion.VP[0] + dot(U[0], S), mass * motion.VP[1] + dot(U[1], S),
                           mass * motion.VP[2] + dot(U[2], S)};
    return {model.assign("F" + label, force), model.assign("N" + label, moment)};
}

ex carried_torque(symbolic_model& model, const kinematic_joint& joint, const carrying_motion& motion,
                  const mass_moments& body) {
    if (joint.type == joint_type::prismatic) {
        return model.assign("fc" + joint.label, body.M * motion.VP[2] + dot(motion.U[2], body.S));
    }
    return model.assign("nc" + joint.label, axial_moment(model, motion, body, joint.label));
}

wrench added_wrench(symbolic_model& model, const kinematic_joint& joint, const carrying_motion& motion,
                    const joint_rates& rates, const mass_moments& body) {
    const std::string& label = joint.label;
    const symmetric3& K = body.K;
    const vector3& S = body.S;
    const ex twice = model.assign("twice_rate" + label, 2 * rates.velocity);
    const ex gx = model.assign("Gx" + label, twice * motion.W[0]);
    const ex gy = model.assign("Gy" + label, twice * motion.W[1]);
    const ex& a = rates.acceleration;
    if (joint.type == joint_type::prismatic) {
        const vector3 VP = {gy, -gx, a};
        return {model.assign("Fd" + label, vector3{body.M * VP[0], body.M * VP[1], body.M * VP[2]}),
                model.assign("Nd" + label, cross(S, VP))};
    }
    const ex sum = model.assign("Wsum" + label, motion.W[2] + rates.velocity);
    const ex both = model.assign("Wboth" + label, motion.W[2] + sum);
    const ex e = model.assign("E" + label, rates.velocity * both);
    const ex zz = inertia_about_z(model, body, label);
    const vector3 moment = {gx * K.xy + gy * K.yy - a * K.xz + e * K.yz, -gx * K.xx - gy * K.xy - a * K.yz - e * K.xz,
                            a * zz};
    return {model.assign("Fd" + label, vector3{-e * S[0] - a * S[1], a * S[0] - e * S[1], gx * S[0] + gy * S[1]}),
            model.assign("Nd" + label, moment)};
}

wrench unit_wrench(symbolic_model& model, const kinematic_joint& joint, const mass_moments& body) {
    if (joint.type == joint_type::prismatic) {
        return {{0, 0, body.M}, {body.S[1], -body.S[0], 0}};
    }
    const ex zz = inertia_about_z(model, body, joint.label);
    return {{-body.S[1], body.S[0], 0}, {-body.K.xz, -body.K.yz, zz}};
}

}  // namespace idim::generator
