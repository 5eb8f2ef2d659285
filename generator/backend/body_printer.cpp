#include "backend/body_printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace idim::generator {

namespace {

/// How tightly the printed text binds.
enum class binding { sum, product, atom };

struct printed_value {
    std::string text;
    binding tightness = binding::atom;
};

class body_printer {
  public:
    body_printer(const expression_graph& graph, const language& spelling, const std::set<std::string>& reserved,
                 const element_names& names)
        : graph_(graph),
          spelling_(spelling),
          names_(names),
          live_(graph.live()),
          uses_(graph.nodes().size(), 0),
          used_(spelling.reserved()),
          variable_(graph.nodes().size()) {
        used_.insert(reserved.begin(), reserved.end());
        count_uses();
    }

    std::vector<std::string> run() {
        for (std::size_t id = 0; id < live_.size(); ++id) {
            name_leaf(static_cast<int>(id));
        }
        for (std::size_t id = 0; id < live_.size(); ++id) {
            const graph_node& node = graph_.nodes()[id];
            if (live_[id] && !is_leaf(node) && !node.name.empty()) {
                define(static_cast<int>(id), node.name);
            }
        }
        std::vector<graph_output> outputs = graph_.outputs();
        std::stable_sort(outputs.begin(), outputs.end(), [](const graph_output& a, const graph_output& b) {
            return std::pair(a.array, a.index) < std::pair(b.array, b.index);
        });
        for (const graph_output& out : outputs) {
            owner_ = fmt::format("{}{}", out.array, out.index + 1);
            declare_shared(out.value.id);
            emit(spelling_.assignment(spelling_.element(names_, out.array, out.index), with_sign(out.value)));
        }
        return std::move(lines_);
    }

  private:
    static bool is_leaf(const graph_node& node) {
        return node.kind == operation::constant || node.kind == operation::symbol;
    }
    static bool has_second(const graph_node& node) {
        return node.kind != operation::function || node.function == function_kind::pow;
    }

    void count_uses() {
        for (std::size_t id = 0; id < live_.size(); ++id) {
            const graph_node& node = graph_.nodes()[id];
            if (live_[id] && !is_leaf(node)) {
                ++uses_[static_cast<std::size_t>(node.a.id)];
                uses_[static_cast<std::size_t>(node.b.id)] += has_second(node) ? 1 : 0;
            }
        }
        for (const graph_output& out : graph_.outputs()) {
            ++uses_[static_cast<std::size_t>(out.value.id)];
        }
    }

    std::string unique(const std::string& wanted) {
        std::string name = wanted;
        for (int i = 2; !used_.insert(name).second; ++i) {
            name = fmt::format("{}_v{}", wanted, i);
        }
        return name;
    }

    /// Parameters and given sines are known by name; signals by their place in the argument.
    void name_leaf(int id) {
        const graph_node& node = graph_.nodes()[static_cast<std::size_t>(id)];
        const bool has_name = node.role == symbol_role::parameter || node.role == symbol_role::sine;
        if (!live_[static_cast<std::size_t>(id)] || node.kind != operation::symbol || !has_name) {
            return;
        }
        const std::string element = leaf(node).text;
        variable_[static_cast<std::size_t>(id)] = unique(graph_.symbols()[static_cast<std::size_t>(node.symbol)].name);
        emit(spelling_.alias(variable_of(id), element));
    }

    /// Gives every shared, unnamed node below `id` a variable before the line that needs it.
    void declare_shared(int id) {
        const graph_node& node = graph_.nodes()[static_cast<std::size_t>(id)];
        if (is_leaf(node) || !variable_of(id).empty()) {
            return;
        }
        declare_operands(node);
        if (uses_[static_cast<std::size_t>(id)] > 1) {
            define(id, fmt::format("{}_t{}", owner_, ++temporaries_[owner_]));
        }
    }

    void declare_operands(const graph_node& node) {
        declare_shared(node.a.id);
        if (has_second(node)) {
            declare_shared(node.b.id);
        }
    }

    void define(int id, const std::string& wanted) {
        const graph_node& node = graph_.nodes()[static_cast<std::size_t>(id)];
        if (!node.name.empty()) {
            owner_ = node.name;
        }
        declare_operands(node);
        const std::string text = expression(node).text;
        const std::string name = unique(wanted);
        emit(spelling_.definition(name, text));
        variable_[static_cast<std::size_t>(id)] = name;
    }

    printed_value leaf(const graph_node& node) const {
        if (node.kind == operation::constant) {
            return {spelling_.number(node.value)};
        }
        const graph_symbol& symbol = graph_.symbols()[static_cast<std::size_t>(node.symbol)];
        const std::string argument = argument_name(symbol.role);
        const bool is_scalar = symbol.role == symbol_role::time || symbol.role == symbol_role::step;
        return {is_scalar ? argument : spelling_.element(names_, argument, symbol.index)};
    }

    const std::string& variable_of(int id) const { return variable_[static_cast<std::size_t>(id)]; }

    printed_value operand(int id) const {
        if (!variable_of(id).empty()) {
            return {variable_of(id)};
        }
        const graph_node& node = graph_.nodes()[static_cast<std::size_t>(id)];
        return is_leaf(node) ? leaf(node) : expression(node);
    }

    /// Text of an operand, in parentheses unless it binds at least as tightly as `least`.
    std::string inside(int id, binding least) const {
        const printed_value value = operand(id);
        return value.tightness < least ? "(" + value.text + ")" : value.text;
    }

    std::string with_sign(signed_node value) const {
        return value.negative ? "-" + inside(value.id, binding::atom) : operand(value.id).text;
    }

    printed_value expression(const graph_node& node) const {
        switch (node.kind) {
            case operation::add:
                return {inside(node.a.id, binding::sum) + (node.b.negative ? " - " : " + ") +
                            inside(node.b.id, binding::product),
                        binding::sum};
            case operation::multiply:
                return {inside(node.a.id, binding::product) + " * " + inside(node.b.id, binding::atom),
                        binding::product};
            case operation::divide:
                return {inside(node.a.id, binding::product) + " / " + inside(node.b.id, binding::atom),
                        binding::product};
            default:
                break;
        }
        std::string arguments = with_sign(node.a);
        if (has_second(node)) {
            arguments += ", " + with_sign(node.b);
        }
        return {spelling_.call(node.function, arguments)};
    }

    /// Breaks long statements at blanks, which only stand around operators.
    void emit(std::string rest) {
        std::string text;
        while (rest.size() > line_width) {
            const std::size_t at = rest.rfind(' ', line_width);
            if (at == std::string::npos || at < 16) {
                break;
            }
            text += rest.substr(0, at) + "\n        ";
            rest = "    " + rest.substr(at + 1);
        }
        lines_.push_back(text.empty() ? std::move(rest) : text + rest);
    }

    const expression_graph& graph_;
    const language& spelling_;
    const element_names& names_;
    std::vector<bool> live_;
    std::vector<int> uses_;
    std::set<std::string> used_;
    std::vector<std::string> variable_;  ///< by id of the node, empty where it has none
    std::map<std::string, int> temporaries_;
    std::string owner_;
    std::vector<std::string> lines_;
};

}  // namespace

std::string argument_name(symbol_role role) {
    switch (role) {
        case symbol_role::parameter:
            return "chi";
        case symbol_role::standard:
            return "standard";
        case symbol_role::time:
            return "t";
        case symbol_role::temperature:
            return "temp";
        case symbol_role::position:
            return "q";
        case symbol_role::velocity:
            return "qd";
        case symbol_role::acceleration:
            return "qdd";
        case symbol_role::torque:
            return "tau";
        case symbol_role::rigid_torque:
            return "tau_rigid";
        case symbol_role::motor:
            return "motor";
        case symbol_role::state:
            return "state";
        case symbol_role::step:
            return "dt";
        case symbol_role::sine:
            return "sc";
        case symbol_role::constant:
        case symbol_role::intermediate:
            break;
    }
    throw std::logic_error("a leaf of this role is no argument");
}

std::vector<std::string> print_body(const expression_graph& graph, const language& spelling,
                                    const std::set<std::string>& reserved, const element_names& names) {
    return body_printer(graph, spelling, reserved, names).run();
}

}  // namespace idim::generator
