#include "dynamics/standard_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace idim::generator {

namespace {

using GiNaC::ex;

constexpr std::array<const char*, 10> inertial_names = {"XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"};

std::string inertial_unit(std::size_t kind) {
    return kind < 6 ? "kg*m^2" : kind < 9 ? "kg*m" : "kg";
}

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

GiNaC::ex decimal(double value, const input_location& where) {
    return parse_expression({fmt::format("({})", value), where}, {});
}

/// The terms of one effect at one joint.
class effect_reader {
  public:
    effect_reader(const kinematic_tree& tree, standard_parameters& parameters, const effect_use& use,
                  const effect_description& effect)
        : tree_(tree), parameters_(parameters), use_(use), effect_(effect) {
        if (effect.scope == effect_scope::robot) {
            throw input_error(use.where,
                              fmt::format("effect {} acts on the whole robot, expected one that acts on a joint "
                                          "or a pair of joints",
                                          effect.name));
        }
    }

    std::vector<standard_parameter> at(std::size_t i) {
        const int joint = use_.joints[i];
        const int from = effect_.scope == effect_scope::pair ? use_.from.at(i) : -1;
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
    named_values signals(int joint, int from) {
        named_values names = tree_.constant_names;
        names["t"] = parameters_.time;
        add_joint(names, joint, "");
        if (const kinematic_joint& at = at_index(joint); at.coordinate >= 0) {
            names["temp"] = parameters_.temperature[static_cast<std::size_t>(at.coordinate)];
        }
        if (from >= 0) {
            add_joint(names, from, "_from");
        }
        return names;
    }

    const kinematic_joint& at_index(int joint) const { return tree_.joints[static_cast<std::size_t>(joint)]; }

    /// Where an effect at a joint acts: on the joint's own coordinate, or else on all that move the joint.
    static std::vector<joint_rate> acts_on(const kinematic_joint& joint) {
        return joint.coordinate >= 0 ? std::vector<joint_rate>{{joint.coordinate, 1}} : joint.rates;
    }

    void add_joint(named_values& names, int index, const std::string& suffix) const {
        const kinematic_joint& joint = at_index(index);
        const auto sum = [&joint](const std::vector<GiNaC::symbol>& symbols) {
            ex value = 0;
            for (const joint_rate& rate : acts_on(joint)) {
                value += rate.factor * symbols[static_cast<std::size_t>(rate.coordinate)];
            }
            return value;
        };
        names["q" + suffix] = joint.coordinate >= 0 ? sum(tree_.q) : joint.variable;
        names["qd" + suffix] = sum(tree_.qd);
        names["qdd" + suffix] = sum(tree_.qdd);
    }

    ex shape_value(const shape_coefficient& shape) const {
        const auto given = use_.shape.find(shape.name);
        if (given == use_.shape.end()) {
            throw input_error(use_.where,
                              fmt::format("effect {} needs a value for its shape parameter {}, expected shape: "
                                          "{{{}: <number from {} to {}>}}",
                                          effect_.name, shape.name, shape.name, shape.range.first, shape.range.second));
        }
        return decimal(given->second, use_.where);
    }

    void note_signals(const ex& torque) {
        parameters_.uses_time = parameters_.uses_time || torque.has(parameters_.time);
        for (const GiNaC::symbol& temperature : parameters_.temperature) {
            parameters_.uses_temperature = parameters_.uses_temperature || torque.has(temperature);
        }
    }

    void add_columns(std::vector<standard_parameter>& parameters, int joint, int from) {
        named_values names = signals(joint, from);
        for (const shape_coefficient& shape : effect_.shape) {
            names[shape.name] = shape_value(shape);
        }
        std::vector<GiNaC::symbol> linear;
        for (const linear_coefficient& coefficient : effect_.linear) {
            linear.emplace_back(coefficient.name);
            names[coefficient.name] = linear.back();
        }
        const ex torque = parse_expression(effect_.torque, names);
        note_signals(torque);
        ex rest = torque.expand();
        for (std::size_t k = 0; k < linear.size(); ++k) {
            const ex column = torque.diff(linear[k]).expand();
            check_free_of(column, linear);
            check_affine_in_acceleration(column);
            rest -= linear[k] * column;
            for (const joint_rate& rate : acts_on(at_index(joint))) {
                parameters[k].columns.emplace_back(rate.coordinate, (rate.factor * column).expand());
            }
        }
        if (!rest.expand().is_zero()) {
            throw input_error(
                effect_.torque.where,
                fmt::format("expression \"{}\": expected a torque that is linear in its linear coefficients",
                            effect_.torque.text));
        }
    }

    void check_free_of(const ex& column, const std::vector<GiNaC::symbol>& linear) const {
        for (const GiNaC::symbol& coefficient : linear) {
            if (column.has(coefficient)) {
                throw input_error(effect_.torque.where, fmt::format("expression \"{}\": {} does not enter linearly",
                                                                    effect_.torque.text, coefficient.get_name()));
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
                        effect_.torque.where,
                        fmt::format("expression \"{}\": expected a torque that is affine in the accelerations",
                                    effect_.torque.text));
                }
            }
        }
    }

    standard_parameter named(const linear_coefficient& coefficient, int joint, int from) const {
        const kinematic_joint& at = at_index(joint);
        std::string name = coefficient.name + at.label;
        if (from >= 0) {
            name += "_" + at_index(from).label;
        }
        return {name, parameter_kind::effect, joint, unit_for(at, coefficient.unit), coefficient.min, {}};
    }

    const kinematic_tree& tree_;
    standard_parameters& parameters_;
    const effect_use& use_;
    const effect_description& effect_;
};

void check_unique(const std::vector<standard_parameter>& parameters, const std::string& name, const effect_use& use) {
    const auto same = [&name](const standard_parameter& p) { return p.name == name; };
    if (std::any_of(parameters.begin(), parameters.end(), same)) {
        throw input_error(
            use.where, fmt::format("effect {} gives a second parameter {}, expected distinct names", use.effect, name));
    }
}

}  // namespace

ex standard_parameter::column_at(int coordinate) const {
    ex sum = 0;
    for (const auto& [acted_on, column] : columns) {
        sum += acted_on == coordinate ? column : ex(0);
    }
    return sum;
}

std::size_t standard_parameters::index(int link, parameter_kind kind) const {
    const auto found = std::find_if(all.begin(), all.end(), [link, kind](const standard_parameter& p) {
        return p.joint == link && p.kind == kind;
    });
    return static_cast<std::size_t>(found - all.begin());
}

standard_parameters list_parameters(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                    const std::vector<effect_description>& descriptions) {
    standard_parameters parameters;
    for (int i = 0; i < tree.dof(); ++i) {
        parameters.temperature.emplace_back(fmt::format("temp{}", i + 1));
    }
    std::vector<std::vector<standard_parameter>> of_joint(tree.joints.size());
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        for (std::size_t k = 0; k < inertial_names.size() && !tree.joints[j].massless; ++k) {
            of_joint[j].push_back({inertial_names[k] + tree.joints[j].label,
                                   static_cast<parameter_kind>(k),
                                   static_cast<int>(j),
                                   inertial_unit(k),
                                   std::nullopt,
                                   {}});
        }
    }
    for (std::size_t u = 0; u < uses.size(); ++u) {
        effect_reader reader(tree, parameters, uses[u], descriptions[u]);
        for (std::size_t i = 0; i < uses[u].joints.size(); ++i) {
            for (const standard_parameter& parameter : reader.at(i)) {
                auto& list = of_joint[static_cast<std::size_t>(parameter.joint)];
                check_unique(list, parameter.name, uses[u]);
                list.push_back(parameter);
            }
        }
    }
    for (const auto& list : of_joint) {
        parameters.all.insert(parameters.all.end(), list.begin(), list.end());
    }
    return parameters;
}

}  // namespace idim::generator
