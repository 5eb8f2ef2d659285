#include "graph/derivatives.hpp"

#include <algorithm>
#include <utility>

#include "graph/graph_copy.hpp"
#include "graph/operation_count.hpp"

namespace idim::generator {

namespace {

std::size_t place(signed_node node) {
    return static_cast<std::size_t>(node.id);
}

/// A model copied into the graph that receives its derivatives.
class differentiation {
  public:
    differentiation(const expression_graph& model, const std::vector<derivative_array>& wanted)
        : model_(model), wanted_(wanted), live_(model.live()), varies_(live_.size(), false) {
        graph_copy copy(model, result_);
        for (std::size_t id = 0; id < live_.size(); ++id) {
            values_.push_back(live_[id] ? copy.of({static_cast<int>(id), false}) : result_.zero());
            varies_[id] = live_[id] && depends(model.nodes()[id]);
        }
    }

    /// One sweep for each leaf, from it to the outputs.
    expression_graph outwards() {
        for (const derivative_array& array : wanted_) {
            for (int leaf = 0; leaf < array.size; ++leaf) {
                sweep_outwards(array, leaf);
            }
        }
        return std::move(result_);
    }

    /// One sweep for each output, from it to the leaves.
    expression_graph inwards() {
        for (const graph_output& out : model_.outputs()) {
            sweep_inwards(out);
        }
        return std::move(result_);
    }

  private:
    using tangents = std::vector<signed_node>;  ///< one for each node of the model
    using partials = std::pair<signed_node, signed_node>;

    bool is_wanted(const graph_symbol& leaf) const {
        return std::any_of(wanted_.begin(), wanted_.end(),
                           [&leaf](const derivative_array& array) { return array.by == leaf.role; });
    }

    bool depends(const graph_node& node) const {
        switch (node.kind) {
            case operation::constant:
                return false;
            case operation::symbol:
                return is_wanted(model_.symbols()[static_cast<std::size_t>(node.symbol)]);
            default:
                return varies_[place(node.a)] || varies_[place(node.b)];
        }
    }

    static signed_node signed_by(signed_node value, signed_node sign) { return sign.negative ? -value : value; }
    signed_node value(signed_node node) const { return signed_by(values_[place(node)], node); }

    void sweep_outwards(const derivative_array& array, int leaf) {
        tangents tangent(values_.size(), result_.zero());
        for (std::size_t id = 0; id < values_.size(); ++id) {
            const graph_node& node = model_.nodes()[id];
            if (!varies_[id]) {
                continue;
            }
            if (node.kind == operation::symbol) {
                const graph_symbol& symbol = model_.symbols()[static_cast<std::size_t>(node.symbol)];
                const bool is_leaf = symbol.role == array.by && symbol.index == leaf;
                tangent[id] = is_leaf ? result_.one() : result_.zero();
                continue;
            }
            const auto [by_a, by_b] = derive(id);
            const signed_node first = result_.multiply(by_a, signed_by(tangent[place(node.a)], node.a));
            const signed_node second = result_.multiply(by_b, signed_by(tangent[place(node.b)], node.b));
            tangent[id] = result_.add(first, second);
        }
        for (const graph_output& out : model_.outputs()) {
            result_.output(array.name, out.index * array.size + leaf, signed_by(tangent[place(out.value)], out.value));
        }
    }

    void sweep_inwards(const graph_output& out) {
        tangents adjoint(values_.size(), result_.zero());
        adjoint[place(out.value)] = signed_by(result_.one(), out.value);
        for (std::size_t id = place(out.value) + 1; id-- > 0;) {
            const graph_node& node = model_.nodes()[id];
            if (!varies_[id] || node.kind == operation::symbol || result_.is_zero(adjoint[id])) {
                continue;
            }
            const auto [by_a, by_b] = derive(id);
            add_to(adjoint, node.a, by_a, adjoint[id]);
            add_to(adjoint, node.b, by_b, adjoint[id]);
        }
        for (const derivative_array& array : wanted_) {
            output_leaves(array, out, adjoint);
        }
    }

    void add_to(tangents& adjoint, signed_node operand, signed_node partial, signed_node outer) {
        if (varies_[place(operand)]) {
            const signed_node term = signed_by(result_.multiply(partial, outer), operand);
            adjoint[place(operand)] = result_.add(adjoint[place(operand)], term);
        }
    }

    void output_leaves(const derivative_array& array, const graph_output& out, const tangents& adjoint) {
        tangents by_leaf(static_cast<std::size_t>(array.size), result_.zero());
        for (std::size_t id = 0; id < adjoint.size(); ++id) {
            const graph_node& node = model_.nodes()[id];
            if (!varies_[id] || node.kind != operation::symbol) {
                continue;
            }
            const graph_symbol& symbol = model_.symbols()[static_cast<std::size_t>(node.symbol)];
            if (symbol.role == array.by) {
                by_leaf[static_cast<std::size_t>(symbol.index)] = adjoint[id];
            }
        }
        for (int leaf = 0; leaf < array.size; ++leaf) {
            result_.output(array.name, out.index * array.size + leaf, by_leaf[static_cast<std::size_t>(leaf)]);
        }
    }

    /// By both operands, signs of the operands not included; zero by an operand that does not vary.
    partials derive(std::size_t id) {
        const graph_node& node = model_.nodes()[id];
        const signed_node a = value(node.a), b = value(node.b), zero = result_.zero(), one = result_.one();
        const bool a_varies = varies_[place(node.a)], b_varies = varies_[place(node.b)];
        switch (node.kind) {
            case operation::add:
                return {a_varies ? one : zero, b_varies ? one : zero};
            case operation::multiply:
                if (node.a.id == node.b.id) {
                    return {result_.add(a, b), zero};
                }
                return {a_varies ? b : zero, b_varies ? a : zero};
            case operation::divide: {
                const signed_node reciprocal = result_.divide(one, b);
                return {a_varies ? reciprocal : zero, b_varies ? -result_.multiply(values_[id], reciprocal) : zero};
            }
            default:
                return node.function == function_kind::pow ? derive_power(id, a, b)
                                                           : partials{derive_function(id, a), zero};
        }
    }

    partials derive_power(std::size_t id, signed_node base, signed_node exponent) {
        const graph_node& node = model_.nodes()[id];
        partials result{result_.zero(), result_.zero()};
        if (varies_[place(node.a)]) {
            const signed_node lower = result_.function_pow(base, result_.subtract(exponent, result_.one()));
            result.first = result_.multiply(exponent, lower);
        }
        if (varies_[place(node.b)]) {
            result.second = result_.multiply(values_[id], result_.function(function_kind::log, base));
        }
        return result;
    }

    signed_node derive_function(std::size_t id, signed_node x) {
        const signed_node f = values_[id], one = result_.one();
        const auto reciprocal = [&](signed_node y) { return result_.divide(one, y); };
        const auto square = [&](signed_node y) { return result_.multiply(y, y); };
        switch (model_.nodes()[id].function) {
            case function_kind::sin:
                return result_.function(function_kind::cos, x);
            case function_kind::cos:
                return -result_.function(function_kind::sin, x);
            case function_kind::tan:
                return result_.add(one, square(f));
            case function_kind::exp:
                return f;
            case function_kind::log:
                return reciprocal(x);
            case function_kind::sqrt:
                return reciprocal(result_.add(f, f));
            case function_kind::abs:
                return result_.function(function_kind::sign, x);
            case function_kind::tanh:
                return result_.subtract(one, square(f));
            case function_kind::atan:
                return reciprocal(result_.add(one, square(x)));
            default:
                return result_.zero();  // sign
        }
    }

    const expression_graph& model_;
    const std::vector<derivative_array>& wanted_;
    std::vector<bool> live_;
    std::vector<bool> varies_;  ///< depends on a leaf that derivatives are wanted by
    expression_graph result_;
    std::vector<signed_node> values_;  ///< of the nodes of the model, in the result
};

int cost(const expression_graph& graph) {
    const operation_count count = count_operations(graph);
    return count.mul + count.add + count.div + count.functions;
}

}  // namespace

expression_graph differentiate(const expression_graph& model, const std::vector<derivative_array>& wanted) {
    expression_graph outwards = differentiation(model, wanted).outwards();
    expression_graph inwards = differentiation(model, wanted).inwards();
    expression_graph& best = cost(inwards) < cost(outwards) ? inwards : outwards;
    best.assert_invariants();
    return std::move(best);
}

}  // namespace idim::generator
