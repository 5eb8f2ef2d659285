#include "dynamics/parameter_values.hpp"

namespace idim::generator {

parameter_values::parameter_values(symbolic_model& model, const standard_parameters& parameters,
                                   const parameter_selection& selection)
    : parameters_(parameters), value_(parameters.all.size(), 0) {
    for (std::size_t k = 0; k < selection.kept.size(); ++k) {
        value_[selection.kept[k]] = model.declare({selection.names[k], symbol_role::parameter, static_cast<int>(k)});
    }
}

GiNaC::ex parameter_values::inertial(int link, parameter_kind kind) const {
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

void declare_signals(symbolic_model& model, const standard_parameters& parameters) {
    if (parameters.uses_time) {
        model.declare(parameters.time, {"t", symbol_role::time, 0});
    }
    if (parameters.uses_temperature) {
        for (std::size_t i = 0; i < parameters.temperature.size(); ++i) {
            const GiNaC::symbol& symbol = parameters.temperature[i];
            model.declare(symbol, {symbol.get_name(), symbol_role::temperature, static_cast<int>(i)});
        }
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
