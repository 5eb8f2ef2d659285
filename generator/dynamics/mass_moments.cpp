#include "dynamics/mass_moments.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

symmetric3 sum_of(symbolic_model& model, const std::string& name, const symmetric3& a, const symmetric3& b) {
    return {model.assign(name + "_xx", a.xx + b.xx), model.assign(name + "_xy", a.xy + b.xy),
            model.assign(name + "_xz", a.xz + b.xz), model.assign(name + "_yy", a.yy + b.yy),
            model.assign(name + "_yz", a.yz + b.yz), model.assign(name + "_zz", a.zz + b.zz)};
}

/// What moving the origin by -P adds to second moments, with the first moments S before and T = S + M P after:
/// P S' + S P' + M P P' = P T' + S P'.
symmetric3 transport(symbolic_model& model, const std::string& name, const vector3& P, const vector3& S,
                     const vector3& T) {
    const auto element = [&](std::size_t i, std::size_t j) { return P[i] * T[j] + S[i] * P[j]; };
    const auto square = [&](std::size_t i) {
        if (P[i].is_zero() || S[i].is_equal(T[i])) {
            return ex(2 * P[i] * S[i]);
        }
        return ex(P[i] * model.assign("S" + name + "_both_" + std::to_string(i + 1), S[i] + T[i]));
    };
    return {square(0), element(0, 1), element(0, 2), square(1), element(1, 2), square(2)};
}

}  // namespace

mass_moments moments_of_link(symbolic_model& model, const parameter_values& values, int link,
                             const std::string& label) {
    const symmetric3 J = values.inertia(link);
    std::vector<std::pair<ex, ex>> known;  // equal moments have one name, so that their difference vanishes
    const auto half = [&](const char* name, const ex& twice) {
        for (const auto& [value, symbol] : known) {
            if (value.is_equal(twice)) {
                return symbol;
            }
            if (value.is_equal(-twice)) {
                return ex(-symbol);
            }
        }
        known.emplace_back(twice, model.assign(name + label, twice / 2));
        return known.back().second;
    };
    const ex xx = half("KXX", J.yy + J.zz - J.xx);
    const ex yy = half("KYY", J.xx + J.zz - J.yy);
    const ex zz = half("KZZ", J.xx + J.yy - J.zz);
    return {
        {xx, -J.xy, -J.xz, yy, -J.yz, zz}, values.first_moments(link), values.inertial(link, parameter_kind::M), J.zz};
}

mass_moments add(symbolic_model& model, const std::string& name, const mass_moments& a, const mass_moments& b) {
    return {sum_of(model, "K" + name, a.K, b.K), model.assign("S" + name, add(a.S, b.S)),
            model.assign("M" + name, a.M + b.M),
            a.J_zz && b.J_zz ? std::optional(model.assign("J" + name + "_zz", *a.J_zz + *b.J_zz)) : std::nullopt};
}

mass_moments turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle,
                          const mass_moments& m) {
    return {turn_about_z(model, "K" + name, angle, m.K), turn_about_z(model, "S" + name, angle, m.S), m.M, m.J_zz};
}

mass_moments link_to_joint(const std::string& name, const link_frame& frame, const mass_moments& m) {
    return {frame.link_to_joint("K" + name, m.K), frame.link_to_joint("S" + name, m.S), m.M, m.J_zz};
}

mass_moments joint_to_antecedent(symbolic_model& model, const std::string& name, const link_frame& frame,
                                 const mass_moments& m) {
    const symmetric3 K = frame.joint_to_antecedent("K" + name, m.K);
    const vector3 S = frame.joint_to_antecedent("S" + name, m.S);
    const vector3& P = frame.position();
    const vector3 moved =
        model.assign("S" + name + "_moved", vector3{S[0] + m.M * P[0], S[1] + m.M * P[1], S[2] + m.M * P[2]});
    const symmetric3 by_moving = transport(model, name, P, S, moved);
    std::optional<ex> J_zz;
    if (m.J_zz && frame.keeps_z()) {
        J_zz = model.assign("J" + name + "_zz_moved", *m.J_zz + by_moving.xx + by_moving.yy);
    }
    return {sum_of(model, "K" + name + "_moved", K, by_moving), moved, m.M, J_zz};
}

mass_moments on_axis(const mass_moments& m) {
    mass_moments part;
    part.K.zz = m.K.zz;
    part.S[2] = m.S[2];
    part.M = m.M;
    return part;  // J_zz = 0
}

mass_moments off_axis(const mass_moments& m) {
    mass_moments part = m;  // J_zz as it was
    part.K.zz = 0;
    part.S[2] = 0;
    part.M = 0;
    return part;
}

ex inertia_about_z(symbolic_model& model, const mass_moments& m, const std::string& label) {
    return m.J_zz ? *m.J_zz : model.assign("Jzz" + label, m.K.xx + m.K.yy);
}

bool is_zero(const mass_moments& m) {
    return m.K.xx.is_zero() && m.K.xy.is_zero() && m.K.xz.is_zero() && m.K.yy.is_zero() && m.K.yz.is_zero() &&
           m.K.zz.is_zero() && is_zero(m.S) && m.M.is_zero();
}

}  // namespace idim::generator
