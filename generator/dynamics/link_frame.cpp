#include "dynamics/link_frame.hpp"

#include <fmt/format.h>

namespace idim::generator {

namespace {

using GiNaC::ex;

angle_pair inverse(const angle_pair& angle) {
    return {angle.cos, -angle.sin};
}

// Vectors of sparse frames are full of zeros, which GiNaC finds only after it has built the product or sum.
ex sparse_product(const ex& a, const ex& b) {
    return a.is_zero() || b.is_zero() ? ex(0) : a * b;
}
ex sparse_sum(const ex& a, const ex& b) {
    return a.is_zero() ? b : b.is_zero() ? a : a + b;
}
/// a b - c d
ex difference(const ex& a, const ex& b, const ex& c, const ex& d) {
    return c.is_zero() || d.is_zero() ? sparse_product(a, b) : sparse_sum(sparse_product(a, b), -c * d);
}

/// v turned by the angle about axis 0 (x) or 2 (z); named unless it is a mere exchange of components.
vector3 turn(symbolic_model& model, const std::string& name, const angle_pair& angle, int axis, const vector3& v) {
    if (is_identity(angle)) {
        return v;
    }
    const std::size_t a = axis == 0 ? 1 : 0;
    const std::size_t b = axis == 0 ? 2 : 1;
    vector3 result = v;
    result[a] = difference(angle.cos, v[a], angle.sin, v[b]).expand();
    result[b] = sparse_sum(sparse_product(angle.sin, v[a]), sparse_product(angle.cos, v[b])).expand();
    if (!is_quarter(angle)) {
        result[a] = model.assign(fmt::format("{}_{}", name, a + 1), result[a]);
        result[b] = model.assign(fmt::format("{}_{}", name, b + 1), result[b]);
    }
    return result;
}

symmetric3 z_to_x(const symmetric3& m) {
    return {m.yy, m.yz, m.xy, m.zz, m.xz, m.xx};
}
symmetric3 x_to_z(const symmetric3& m) {
    return {m.zz, m.xz, m.yz, m.xx, m.xy, m.yy};
}

/// About x: the axes renamed cyclically (y z x) -> (x y z), turned about the new z, and renamed back.
symmetric3 turn_about_x(symbolic_model& model, const std::string& name, const angle_pair& angle, const symmetric3& m) {
    return x_to_z(turn_about_z(model, name, angle, z_to_x(m)));
}

}  // namespace

bool is_identity(const angle_pair& angle) {
    return angle.sin.is_zero() && angle.cos.is_equal(1);
}

bool is_quarter(const angle_pair& angle) {
    return angle.sin.is_zero() || angle.cos.is_zero();
}

vector3 turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle, const vector3& v) {
    return turn(model, name, angle, 2, v);
}

/// A symmetric matrix turned about z. With u = s (xx - yy) + 2 c xy: xx' = xx - s u, yy' = yy + s u, xy' = c u - xy,
/// which shares the two products s u and c u (8 multiplications in all).
symmetric3 turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle, const symmetric3& m) {
    if (is_identity(angle)) {
        return m;
    }
    const ex& c = angle.cos;
    const ex& s = angle.sin;
    if (is_quarter(angle)) {
        return {c * c * m.xx + s * s * m.yy, (c * c - s * s) * m.xy, c * m.xz - s * m.yz,
                s * s * m.xx + c * c * m.yy, s * m.xz + c * m.yz,    m.zz};
    }
    const ex difference = model.assign(name + "_xxyy", m.xx - m.yy);
    const ex twice = model.assign(name + "_2xy", 2 * m.xy);
    const ex u = model.assign(name + "_u", s * difference + c * twice);
    const ex t = model.assign(name + "_t", s * u);
    return {model.assign(name + "_xx", m.xx - t),
            model.assign(name + "_xy", c * u - m.xy),
            model.assign(name + "_xz", c * m.xz - s * m.yz),
            model.assign(name + "_yy", m.yy + t),
            model.assign(name + "_yz", s * m.xz + c * m.yz),
            m.zz};
}

vector3 cross(const vector3& a, const vector3& b) {
    return {difference(a[1], b[2], a[2], b[1]), difference(a[2], b[0], a[0], b[2]), difference(a[0], b[1], a[1], b[0])};
}

ex dot(const vector3& a, const vector3& b) {
    return sparse_sum(sparse_sum(sparse_product(a[0], b[0]), sparse_product(a[1], b[1])), sparse_product(a[2], b[2]));
}

vector3 add(const vector3& a, const vector3& b) {
    return {sparse_sum(a[0], b[0]), sparse_sum(a[1], b[1]), sparse_sum(a[2], b[2])};
}

bool is_zero(const vector3& a) {
    return a[0].is_zero() && a[1].is_zero() && a[2].is_zero();
}

link_frame::link_frame(symbolic_model& model, const kinematic_joint& joint, const angle_pair& theta,
                       const vector3& position)
    : model_(model), gamma_(joint.gamma), alpha_(joint.alpha), theta_(theta), position_(position) {}

vector3 link_frame::antecedent_to_joint(const std::string& name, const vector3& v) const {
    const vector3 after_gamma = turn(model_, name + "_g", inverse(gamma_), 2, v);
    return turn(model_, name + "_a", inverse(alpha_), 0, after_gamma);
}

vector3 link_frame::joint_to_antecedent(const std::string& name, const vector3& v) const {
    const vector3 after_alpha = turn(model_, name + "_a", alpha_, 0, v);
    return turn(model_, name + "_g", gamma_, 2, after_alpha);
}

symmetric3 link_frame::joint_to_antecedent(const std::string& name, const symmetric3& m) const {
    const symmetric3 after_alpha = turn_about_x(model_, name + "_a", alpha_, m);
    return turn_about_z(model_, name + "_g", gamma_, after_alpha);
}

vector3 link_frame::joint_to_link(const std::string& name, const vector3& v) const {
    return turn(model_, name, inverse(theta_), 2, v);
}

vector3 link_frame::link_to_joint(const std::string& name, const vector3& v) const {
    return turn(model_, name, theta_, 2, v);
}

symmetric3 link_frame::link_to_joint(const std::string& name, const symmetric3& m) const {
    return turn_about_z(model_, name, theta_, m);
}

vector3 link_frame::to_link(const std::string& name, const vector3& v) const {
    return joint_to_link(name, antecedent_to_joint(name, v));
}

vector3 link_frame::to_antecedent(const std::string& name, const vector3& v) const {
    return joint_to_antecedent(name, link_to_joint(name, v));
}

}  // namespace idim::generator
