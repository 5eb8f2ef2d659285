#include <fmt/format.h>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/inverse_dynamics.hpp"
#include "dynamics/mass_matrix.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Coordinates before k that row k of the lower triangle couples with, last first: in a tree without coupled joints
/// those between joint k and the base.
std::vector<std::size_t> coupled_with(const std::vector<std::vector<ex>>& M, std::size_t k) {
    std::vector<std::size_t> result;
    for (std::size_t i = k; i-- > 0;) {
        if (!M[k][i].is_zero()) {
            result.push_back(i);
        }
    }
    return result;
}

/// M = L' D L from the last joint inward, which fills in nothing that branches leave zero (Featherstone 2008, ch. 6.5).
/// On return the strict lower triangle of M holds L and the diagonal D. A pivot that is zero whatever the parameters (a
/// coordinate that moves nothing with inertia) stays in D, for the caller of the model to find; nothing is divided by
/// it.
std::vector<ex> factorise(symbolic_model& model, std::vector<std::vector<ex>>& M) {
    std::vector<ex> reciprocal(M.size());
    for (std::size_t k = M.size(); k-- > 0;) {
        reciprocal[k] = M[k][k].is_zero() ? ex(0) : model.assign(fmt::format("Dinv{}", k + 1), GiNaC::pow(M[k][k], -1));
        const std::vector<std::size_t> inward = coupled_with(M, k);
        for (const std::size_t i : inward) {
            const ex l = model.assign(fmt::format("L{}_{}", k + 1, i + 1), M[k][i] * reciprocal[k]);
            for (const std::size_t j : inward) {
                if (j <= i) {
                    M[i][j] = model.assign(fmt::format("M{}_{}_{}", i + 1, j + 1, k + 1), M[i][j] - l * M[k][j]);
                }
            }
            M[k][i] = l;
        }
    }
    return reciprocal;
}

}  // namespace

symbolic_model forward_dynamics_model(const kinematic_tree& tree, const standard_parameters& parameters,
                                      const parameter_selection& selection, const model_form& form) {
    symbolic_model model(tree);
    const parameter_values values(model, parameters, selection);
    declare_signals(model, parameters);
    declare_rigid_torque(model, parameters);
    const motion_inputs inputs{true, false, true};
    declare_motion(model, tree, inputs);
    model_frame frame(model, tree, values, merging_all(form));
    const std::vector<ex> bias = joint_torques(frame, inputs);
    auto M = inertia_elements(frame, parameters);
    const std::size_t n = M.size();
    std::vector<ex> x(n);
    for (std::size_t i = 0; i < n; ++i) {
        const GiNaC::symbol tau =
            model.declare({fmt::format("tau{}", i + 1), symbol_role::torque, static_cast<int>(i)});
        const ex all = parameters.without_elasticity(tree, effect_torque(parameters, values, static_cast<int>(i)));
        const ex effects = without_acceleration(all, tree);
        x[i] = model.assign(fmt::format("b{}", i + 1), tau / parameters.drives[i].gain - bias[i] - effects);
    }
    const std::vector<ex> reciprocal = factorise(model, M);
    for (std::size_t k = n; k-- > 0;) {
        for (const std::size_t i : coupled_with(M, k)) {
            x[i] = model.assign(fmt::format("y{}_{}", i + 1, k + 1), x[i] - M[k][i] * x[k]);
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        ex value = x[k] * reciprocal[k];
        for (const std::size_t i : coupled_with(M, k)) {
            value -= M[k][i] * x[i];
        }
        x[k] = model.assign(fmt::format("qdd{}", k + 1), value);
        model.output("qdd", static_cast<int>(k), x[k]);
        model.output("D", static_cast<int>(k), M[k][k]);
    }
    return model;
}

}  // namespace idim::generator
