#include "dynamics/parameter_values.hpp"

namespace idim::generator {

GiNaC::ex gate_of(const standard_parameters& parameters, const standard_parameter& load) {
    return parameters.gates[static_cast<std::size_t>(load.gate)].symbol;
}

parameter_values::parameter_values(symbolic_model& model, const standard_parameters& parameters,
                                   const parameter_selection& selection)
    : parameters_(parameters), value_(parameters.all.size(), 0) {
    for (std::size_t k = 0; k < selection.kept.size(); ++k) {
        value_[selection.kept[k]] = model.declare({selection.names[k], symbol_role::parameter, static_cast<int>(k)});
    }
    declare_gates(model, parameters);
    for (std::size_t p = 0; p < parameters.all.size(); ++p) {
        const standard_parameter& load = parameters.all[p];
        if (load.gate >= 0 && !value_[p].is_zero()) {
            const GiNaC::ex with = inertial(load.joint, load.kind) + gate_of(parameters, load) * value_[p];
            loaded_[{load.joint, load.kind}] = model.assign("loaded_" + load.name, with);
        }
    }
}

GiNaC::ex parameter_values::inertial(int link, parameter_kind kind) const {
    if (const auto loaded = loaded_.find({link, kind}); loaded != loaded_.end()) {
        return loaded->second;
    }
    const std::size_t p = parameters_.index(link, kind);
    return p < value_.size() ? value_[p] : GiNaC::ex(0);
}

symmetric3 parameter_values::inertia(int link) const {
    const auto of = [this, link](parameter_kind kind) { return inertial(link, kind); };
    return {of(parameter_kind::XX), of(parameter_kind::XY), of(parameter_kind::XZ),
            of(parameter_kind::YY), of(parameter_kind::YZ), of(parameter_kind::ZZ)};
}

vector3 parameter_values::first_moments(int link) const {
    return {inertial(link, parameter_kind::MX), inertial(link, parameter_kind::MY), inertial(link, parameter_kind::MZ)};
}

void declare_gates(symbolic_model& model, const standard_parameters& parameters) {
    if (parameters.gates.empty()) {
        return;
    }
    model.declare(parameters.time, {"t", symbol_role::time, 0});
    for (const time_gate& gate : parameters.gates) {
        model.define(gate.symbol, gate.value);
    }
}

void declare_signals(symbolic_model& model, const standard_parameters& parameters) {
    if (parameters.uses_time && parameters.gates.empty()) {
        model.declare(parameters.time, {"t", symbol_role::time, 0});
    }
    if (parameters.uses_temperature) {
        for (std::size_t i = 0; i < parameters.temperature.size(); ++i) {
            const GiNaC::symbol& symbol = parameters.temperature[i];
            model.declare(symbol, {symbol.get_name(), symbol_role::temperature, static_cast<int>(i)});
        }
    }
    for (std::size_t s = 0; s < parameters.states.size(); ++s) {
        const effect_memory& state = parameters.states[s];
        model.declare(state.symbol, {state.name, symbol_role::state, static_cast<int>(s)});
    }
    const std::size_t n = parameters.drives.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 3 && parameters.drives[i].is_elastic(); ++k) {
            const GiNaC::symbol& symbol = parameters.drives[i].motor[k];
            model.declare(symbol, {symbol.get_name(), symbol_role::motor, static_cast<int>(k * n + i)});
        }
    }
}

void declare_rigid_torque(symbolic_model& model, const standard_parameters& parameters) {
    for (std::size_t i = 0; i < parameters.rigid_torque.size() && parameters.uses_rigid_torque; ++i) {
        const GiNaC::symbol& symbol = parameters.rigid_torque[i];
        model.declare(symbol, {symbol.get_name(), symbol_role::rigid_torque, static_cast<int>(i)});
    }
}

GiNaC::ex effect_torque(const standard_parameters& parameters, const parameter_values& values, int coordinate) {
    GiNaC::ex torque = 0;
    for (std::size_t p = 0; p < parameters.all.size(); ++p) {
        for (const auto& [acted_on, column] : parameters.all[p].columns) {
            torque += acted_on == coordinate ? column * values[p] : GiNaC::ex(0);
        }
    }
    return torque;
}

}  // namespace idim::generator
