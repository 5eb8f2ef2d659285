#include "catalogue/effect_functions.hpp"

#include <fmt/format.h>

#include "dynamics/symbolic_model.hpp"
#include "kinematics/expression_parser.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Symbols an effect's expressions may use.
class effect_symbols {
  public:
    effect_symbols(const effect_description& effect, const kinematic_tree& tree) : tree_(tree) {
        add("t", symbol_role::time, 0);
        add("temp", symbol_role::temperature, 0);
        add("q", symbol_role::position, 0);
        add("qd", symbol_role::velocity, 0);
        add("qdd", symbol_role::acceleration, 0);
        add("tau_rigid", symbol_role::torque, 0);
        if (effect.scope == effect_scope::pair) {
            add("q_from", symbol_role::position, 1);
            add("qd_from", symbol_role::velocity, 1);
            add("qdd_from", symbol_role::acceleration, 1);
        }
        for (std::size_t s = 0; s < effect.shape.size(); ++s) {
            add(effect.shape[s].name, symbol_role::parameter, static_cast<int>(s));
        }
        add("dt", symbol_role::parameter, static_cast<int>(effect.shape.size()));
        for (std::size_t s = 0; s < effect.states.size(); ++s) {
            add(effect.states[s].name, symbol_role::standard, static_cast<int>(s));
        }
    }

    named_values names() const {
        named_values all = tree_.constant_names;
        for (const auto& [name, leaf] : leaves_) {
            all[name] = leaf.first;
        }
        return all;
    }

    symbolic_model model() const {
        symbolic_model result(tree_);
        for (const std::string& name : order_) {
            const auto& [symbol, declared] = leaves_.at(name);
            result.declare(symbol, declared);
        }
        return result;
    }

    bool uses(const ex& expression, const std::string& name) const {
        const auto found = leaves_.find(name);
        return found != leaves_.end() && expression.has(found->second.first);
    }

  private:
    void add(const std::string& name, symbol_role role, int index) {
        leaves_.emplace(name, std::pair(GiNaC::symbol(name), graph_symbol{name, role, index}));
        order_.push_back(name);
    }

    const kinematic_tree& tree_;
    std::map<std::string, std::pair<GiNaC::symbol, graph_symbol>> leaves_;
    std::vector<std::string> order_;
};

std::vector<ex> columns_of(const effect_description& effect, const expression_text& source,
                           const effect_symbols& symbols) {
    named_values names = symbols.names();
    std::vector<GiNaC::symbol> linear;
    for (const linear_coefficient& coefficient : effect.linear) {
        linear.emplace_back(coefficient.name);
        names[coefficient.name] = linear.back();
    }
    const ex torque = parse_expression(source, names);
    std::vector<ex> columns;
    ex rest = torque.expand();
    for (const GiNaC::symbol& coefficient : linear) {
        columns.push_back(torque.diff(coefficient).expand());
        rest -= coefficient * columns.back();
    }
    bool is_linear = rest.expand().is_zero();
    for (const ex& column : columns) {
        for (const GiNaC::symbol& coefficient : linear) {
            is_linear = is_linear && !column.has(coefficient);
        }
    }
    if (!is_linear) {
        throw input_error(
            source.where,
            fmt::format("expression \"{}\": expected a torque that is linear in its linear coefficients", source.text));
    }
    return columns;
}

expression_graph graph_of(const std::string& array, const std::vector<ex>& values, const effect_symbols& symbols) {
    symbolic_model model = symbols.model();
    for (std::size_t k = 0; k < values.size(); ++k) {
        model.output(array, static_cast<int>(k), values[k]);
    }
    return build_graph(model, constants_as::values);
}

effect_functions functions_with(const effect_description& effect, const expression_text& torque,
                                const kinematic_tree& tree) {
    const effect_symbols symbols(effect, tree);
    const std::vector<ex> columns = columns_of(effect, torque, symbols);
    std::vector<ex> start;
    std::vector<ex> next;
    std::vector<ex> all = columns;
    for (const effect_state& state : effect.states) {
        start.push_back(parse_expression(state.start, symbols.names()));
        next.push_back(parse_expression(state.next, symbols.names()));
        all.push_back(start.back());
        all.push_back(next.back());
    }
    effect_functions result;
    result.symbol = effect.name;
    result.description = effect;
    result.linear = effect.linear;
    result.shape = effect.shape;
    result.columns = graph_of("X", columns, symbols);
    result.start = graph_of("next", start, symbols);
    result.next = graph_of("next", next, symbols);
    for (const ex& expression : all) {
        result.uses_rigid_torque = result.uses_rigid_torque || symbols.uses(expression, "tau_rigid");
        result.uses_temperature = result.uses_temperature || symbols.uses(expression, "temp");
        result.uses_time = result.uses_time || symbols.uses(expression, "t");
    }
    return result;
}

/// The shapes that an expression names.
std::vector<shape_coefficient> shapes_in(const effect_description& effect, const expression_text& torque,
                                         const kinematic_tree& tree) {
    effect_description all = effect;
    const effect_symbols symbols(all, tree);
    const std::vector<ex> columns = columns_of(effect, torque, symbols);
    std::vector<shape_coefficient> used;
    for (const shape_coefficient& shape : effect.shape) {
        for (const ex& column : columns) {
            if (symbols.uses(column, shape.name)) {
                used.push_back(shape);
                break;
            }
        }
    }
    return used;
}

}  // namespace

std::vector<effect_functions> functions_of(const effect_description& effect, const kinematic_tree& tree) {
    if (effect.kind != effect_kind::expression) {
        effect_functions none;
        none.symbol = effect.name;
        none.description = effect;
        none.linear = effect.linear;
        none.shape = effect.shape;
        return {std::move(none)};
    }
    if (!effect.torque_without_temperature) {
        return {functions_with(effect, effect.torque, tree)};
    }
    std::vector<effect_functions> forms;
    for (const expression_text& torque : {effect.torque, *effect.torque_without_temperature}) {
        effect_description form = effect;
        form.shape = shapes_in(effect, torque, tree);
        forms.push_back(functions_with(form, torque, tree));
    }
    forms.back().symbol += "_without_temperature";
    return forms;
}

}  // namespace idim::generator
