#include "dynamics/effect_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "dynamics/effect_shape.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Effect files give units for a revolute joint; a prismatic one has forces and metres in their place.
std::string unit_for(const kinematic_joint& joint, std::string unit) {
    if (joint.type != joint_type::prismatic) {
        return unit;
    }
    const std::array<std::pair<std::string, std::string>, 3> exchanges = {
        std::pair{"N*m", "N"}, std::pair{"kg*m^2", "kg"}, std::pair{"rad", "m"}};
    for (const auto& [from, to] : exchanges) {
        if (const std::size_t at = unit.find(from); at != std::string::npos) {
            unit.replace(at, from.size(), to);
        }
    }
    return unit;
}

/// The terms of an effect that is an expression, at one joint.
class expression_reader {
  public:
    expression_reader(const kinematic_tree& tree, const effect_use& use, const effect_description& effect,
                      standard_parameters& parameters)
        : tree_(tree),
          use_(use),
          effect_(effect),
          parameters_(parameters),
          torque_(effect.torque_without_temperature && !use.shape.empty() ? *effect.torque_without_temperature
                                                                          : effect.torque) {
        if (effect.scope == effect_scope::robot) {
            throw input_error(use.where,
                              fmt::format("effect {} acts on the whole robot, expected one that acts on a joint "
                                          "or a pair of joints",
                                          effect.name));
        }
        if (effect.acts_on_both && !effect.states.empty()) {
            throw input_error(use.where, fmt::format("effect {} has states and acts on both joints of a pair, expected "
                                                     "one that acts on one",
                                                     effect.name));
        }
    }

    std::vector<standard_parameter> at(std::size_t i) {
        const int joint = use_.joints[i];
        const int from = effect_.scope == effect_scope::pair ? from_of(i) : -1;
        std::vector<standard_parameter> result;
        for (const linear_coefficient& coefficient : effect_.linear) {
            result.push_back(named(coefficient, joint, from));
        }
        add_columns(result, joint, from);
        if (effect_.acts_on_both) {
            add_columns(result, from, joint);
        }
        return result;
    }

  private:
    int from_of(std::size_t i) const {
        if (i >= use_.from.size()) {
            throw input_error(use_.where, fmt::format("effect {} acts on a joint from another one, expected from: "
                                                      "[<joint>] with one for each of its joints",
                                                      effect_.name));
        }
        return use_.from[i];
    }

    named_values signals(int joint, int from) {
        named_values names = tree_.constant_names;
        names["t"] = parameters_.time;
        add_joint(names, joint, "");
        if (const kinematic_joint& at = at_index(joint); at.coordinate >= 0) {
            const auto coordinate = static_cast<std::size_t>(at.coordinate);
            names["temp"] = parameters_.temperature[coordinate];
            names["tau_rigid"] = parameters_.rigid_torque[coordinate];
        }
        if (from >= 0) {
            add_joint(names, from, "_from");
        }
        add_shapes(names);
        return names;
    }

    const kinematic_joint& at_index(int joint) const { return tree_.joints[static_cast<std::size_t>(joint)]; }

    /// Where an effect at a joint acts: on the joint's own coordinate, or else on all that move the joint.
    static std::vector<joint_rate> acts_on(const kinematic_joint& joint) {
        return joint.coordinate >= 0 ? std::vector<joint_rate>{{joint.coordinate, 1}} : joint.rates;
    }

    void add_joint(named_values& names, int index, const std::string& suffix) const {
        const kinematic_joint& joint = at_index(index);
        const auto sum = [&](std::size_t derivative, const std::vector<GiNaC::symbol>& symbols) {
            ex value = 0;
            for (const joint_rate& rate : acts_on(joint)) {
                const auto i = static_cast<std::size_t>(rate.coordinate);
                const drive_model& drive = parameters_.drives[i];
                const bool of_motor = drive.is_elastic() && !joint.passive;
                value += rate.factor * (of_motor ? drive.motor[derivative] : symbols[i]);
            }
            return value;
        };
        names["q" + suffix] = joint.coordinate >= 0 ? sum(0, tree_.q) : joint.variable;
        names["qd" + suffix] = sum(1, tree_.qd);
        names["qdd" + suffix] = sum(2, tree_.qdd) + joint.drift;
    }

    /// A shape without a value stands for itself: an error only where an expression needs it.
    void add_shapes(named_values& names) {
        for (const shape_coefficient& shape : effect_.shape) {
            const auto given = use_.shape.find(shape.name);
            names[shape.name] =
                given == use_.shape.end() ? ex(unset(shape.name)) : exact_decimal(given->second, use_.where);
        }
    }

    const GiNaC::symbol& unset(const std::string& shape) {
        return unset_.try_emplace(shape, GiNaC::symbol(shape)).first->second;
    }

    ex parsed(const expression_text& text, const named_values& names) const {
        const ex value = parse_expression(text, names);
        for (const auto& [shape, symbol] : unset_) {
            if (value.has(symbol)) {
                shape_value(use_, effect_, shape);  // throws
            }
        }
        return value;
    }

    void note_signals(const ex& expression) {
        const auto has_any = [&expression](const std::vector<GiNaC::symbol>& symbols) {
            return std::any_of(symbols.begin(), symbols.end(),
                               [&expression](const GiNaC::symbol& symbol) { return expression.has(symbol); });
        };
        parameters_.uses_time = parameters_.uses_time || expression.has(parameters_.time);
        parameters_.uses_temperature = parameters_.uses_temperature || has_any(parameters_.temperature);
        parameters_.uses_rigid_torque = parameters_.uses_rigid_torque || has_any(parameters_.rigid_torque);
    }

    /// States of the effect at a joint, known by their names to the expressions; their own may not use the torque that
    /// the links transmit, which is known only behind them.
    void add_states(named_values& names, int joint, int from) {
        std::vector<effect_memory> memories;
        named_values known = names;
        known.erase("tau_rigid");
        for (const effect_state& state : effect_.states) {
            effect_memory& memory = memories.emplace_back();
            memory.name = suffixed(state.name, joint, from);
            memory.symbol = GiNaC::symbol(memory.name);
            names[state.name] = memory.symbol;
        }
        named_values next = known;
        next["dt"] = parameters_.step;
        for (std::size_t s = 0; s < memories.size(); ++s) {
            next[effect_.states[s].name] = memories[s].symbol;
        }
        for (std::size_t s = 0; s < memories.size(); ++s) {
            memories[s].start = parsed(effect_.states[s].start, known);
            memories[s].next = parsed(effect_.states[s].next, next);
            note_signals(memories[s].start);
            note_signals(memories[s].next);
        }
        parameters_.states.insert(parameters_.states.end(), memories.begin(), memories.end());
    }

    void add_columns(std::vector<standard_parameter>& parameters, int joint, int from) {
        named_values names = signals(joint, from);
        add_states(names, joint, from);
        std::vector<GiNaC::symbol> linear;
        for (const linear_coefficient& coefficient : effect_.linear) {
            linear.emplace_back(coefficient.name);
            names[coefficient.name] = linear.back();
        }
        const ex torque = parsed(torque_, names);
        note_signals(torque);
        ex rest = torque.expand();
        for (std::size_t k = 0; k < linear.size(); ++k) {
            const ex column = torque.diff(linear[k]).expand();
            check_free_of(column, linear);
            check_affine_in_acceleration(parameters_.without_elasticity(tree_, column));
            rest -= linear[k] * column;
            for (const joint_rate& rate : acts_on(at_index(joint))) {
                parameters[k].columns.emplace_back(rate.coordinate, (rate.factor * column).expand());
            }
        }
        if (!rest.expand().is_zero()) {
            throw input_error(
                torque_.where,
                fmt::format("expression \"{}\": expected a torque that is linear in its linear coefficients",
                            torque_.text));
        }
    }

    void check_free_of(const ex& column, const std::vector<GiNaC::symbol>& linear) const {
        for (const GiNaC::symbol& coefficient : linear) {
            if (column.has(coefficient)) {
                throw input_error(torque_.where, fmt::format("expression \"{}\": {} does not enter linearly",
                                                             torque_.text, coefficient.get_name()));
            }
        }
    }

    /// Otherwise there would be no mass matrix and no direct dynamic model.
    void check_affine_in_acceleration(const ex& column) const {
        for (const GiNaC::symbol& a : tree_.qdd) {
            const ex slope = column.diff(a);
            for (const GiNaC::symbol& b : tree_.qdd) {
                if (slope.has(b)) {
                    throw input_error(
                        torque_.where,
                        fmt::format("expression \"{}\": expected a torque that is affine in the accelerations",
                                    torque_.text));
                }
            }
        }
    }

    std::string suffixed(const std::string& name, int joint, int from) const {
        const std::string own = name + at_index(joint).label;
        return from >= 0 ? own + "_" + at_index(from).label : own;
    }

    standard_parameter named(const linear_coefficient& coefficient, int joint, int from) const {
        standard_parameter result;
        result.name = suffixed(coefficient.name, joint, from);
        result.joint = joint;
        result.unit = unit_for(at_index(joint), coefficient.unit);
        result.min = coefficient.min;
        result.per_log = effect_.per_log;
        return result;
    }

    const kinematic_tree& tree_;
    const effect_use& use_;
    const effect_description& effect_;
    standard_parameters& parameters_;
    const expression_text& torque_;
    std::map<std::string, GiNaC::symbol> unset_;
};

/// 1 from t0 to before t1: the inner signs are 0 at the ends, which the halves turn to the side of the interval.
ex gate_value(const GiNaC::symbol& t, const ex& t0, const ex& t1) {
    const ex half = GiNaC::numeric(1, 2);
    return (sign(sign(t - t0) + half) - sign(sign(t - t1) + half)) / 2;
}

int find_gate(const effect_use& use, const effect_description& effect, standard_parameters& parameters) {
    const double t0 = shape_value(use, effect, "t0");
    const double t1 = shape_value(use, effect, "t1");
    if (!(t0 < t1)) {
        throw input_error(use.where,
                          fmt::format("effect {}: t0 = {}, t1 = {}, expected t0 before t1", effect.name, t0, t1));
    }
    auto& gates = parameters.gates;
    const auto known =
        std::find_if(gates.begin(), gates.end(), [=](const time_gate& g) { return g.t0 == t0 && g.t1 == t1; });
    if (known != gates.end()) {
        return static_cast<int>(known - gates.begin());
    }
    const ex value = gate_value(parameters.time, exact_decimal(t0, use.where), exact_decimal(t1, use.where));
    gates.push_back({t0, t1, GiNaC::symbol(fmt::format("load{}", gates.size() + 1)), value});
    parameters.uses_time = true;
    return static_cast<int>(gates.size()) - 1;
}

std::vector<standard_parameter> payload(const kinematic_tree& tree, const effect_use& use,
                                        const effect_description& effect, int link, standard_parameters& parameters) {
    constexpr std::size_t inertial = 10;
    if (effect.linear.size() != inertial) {
        throw input_error({effect.file, 0, "linear"},
                          "expected ten coefficients, in the order XX XY XZ YY YZ ZZ MX MY MZ M");
    }
    const int gate = find_gate(use, effect, parameters);
    std::vector<standard_parameter> result;
    for (std::size_t k = 0; k < inertial; ++k) {
        standard_parameter& parameter = result.emplace_back();
        parameter.name = effect.linear[k].name + tree.joints[static_cast<std::size_t>(link)].label;
        parameter.kind = static_cast<parameter_kind>(k);
        parameter.joint = link;
        parameter.unit = effect.linear[k].unit;
        parameter.min = effect.linear[k].min;
        parameter.gate = gate;
    }
    return result;
}

}  // namespace

std::vector<standard_parameter> read_terms(const kinematic_tree& tree, const effect_use& use,
                                           const effect_description& effect, std::size_t i,
                                           standard_parameters& parameters) {
    check_shapes(use, effect);
    if (effect.kind == effect_kind::payload) {
        return payload(tree, use, effect, use.joints[i], parameters);
    }
    if (effect.kind != effect_kind::expression) {
        return {};
    }
    return expression_reader(tree, use, effect, parameters).at(i);
}

}  // namespace idim::generator
