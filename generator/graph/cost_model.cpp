#include "graph/cost_model.hpp"

#include <algorithm>
#include <list>
#include <stdexcept>

#include "graph/operation_count.hpp"

namespace idim::generator {

namespace {

bool is_arithmetic(const graph_node& node) {
    return node.kind == operation::add || node.kind == operation::multiply || node.kind == operation::divide;
}

std::vector<int> uses(const expression_graph& graph, const std::vector<bool>& live) {
    std::vector<int> count(live.size(), 0);
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (live[id] && is_arithmetic(node)) {
            ++count[static_cast<std::size_t>(node.a.id)];
            ++count[static_cast<std::size_t>(node.b.id)];
        }
    }
    for (const graph_output& out : graph.outputs()) {
        ++count[static_cast<std::size_t>(out.value.id)];
    }
    return count;
}

/// A sum takes a product that nothing else needs into one instruction.
int x86_cost(const expression_graph& graph) {
    constexpr int division = 8;  // as long as eight other instructions, in throughput
    constexpr int latency = 4, division_latency = 13;
    const std::vector<bool> live = graph.live();
    const std::vector<int> used = uses(graph, live);
    std::vector<int> ready(live.size(), 0);
    int instructions = 0;
    int longest = 0;
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (!live[id] || node.kind == operation::constant || node.kind == operation::symbol) {
            continue;
        }
        const auto a = static_cast<std::size_t>(node.a.id);
        const auto b = static_cast<std::size_t>(node.b.id);
        int start = std::max(ready[a], ready[b]);
        if (node.kind == operation::add) {
            const auto fuses = [&](std::size_t operand) {
                return graph.nodes()[operand].kind == operation::multiply && used[operand] == 1;
            };
            const std::size_t product = fuses(a) && (!fuses(b) || ready[a] >= ready[b]) ? a : b;
            if (fuses(product)) {
                --instructions;
                const std::size_t other = product == a ? b : a;
                start = std::max(ready[product] - latency, ready[other]);
            }
        }
        instructions += node.kind == operation::divide ? division : is_arithmetic(node) ? 1 : 0;
        ready[id] = start + (node.kind == operation::divide ? division_latency : latency);
        longest = std::max(longest, ready[id]);
    }
    return instructions + 2 * longest;
}

/// Registers that hold the values used last.
class register_file {
  public:
    /// Half cycles to have a value at hand: none if it is in a register.
    int fetch(std::size_t value) {
        const auto at = std::find(held_.begin(), held_.end(), value);
        if (at != held_.end()) {
            held_.splice(held_.begin(), held_, at);
            return 0;
        }
        return load + put(value);
    }
    /// Half cycles for room for a result: a store where a value has to leave.
    int put(std::size_t value) {
        held_.push_front(value);
        if (held_.size() <= registers) {
            return 0;
        }
        held_.pop_back();
        return store;
    }

  private:
    static constexpr std::size_t registers = 28;  // of 32: some carry arguments and addresses
    static constexpr int load = 4, store = 2;
    std::list<std::size_t> held_;
};

int mcu_cost(const expression_graph& graph) {
    constexpr int one = 2, division = 28;
    const std::vector<bool> live = graph.live();
    register_file registers;
    int total = 0;
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (!live[id] || !is_arithmetic(node)) {
            continue;
        }
        total += registers.fetch(static_cast<std::size_t>(node.a.id));
        total += registers.fetch(static_cast<std::size_t>(node.b.id));
        total += node.kind == operation::divide ? division : one;
        total += registers.put(id);
    }
    return total;
}

}  // namespace

const std::vector<std::string>& cost_target_names() {
    static const std::vector<std::string> names = {"ops", "x86", "mcu"};
    return names;
}

cost_target cost_target_of(const std::string& name) {
    const auto& names = cost_target_names();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
        throw std::invalid_argument("no cost model \"" + name + "\"");
    }
    return static_cast<cost_target>(at - names.begin());
}

std::string to_string(cost_target target) {
    return cost_target_names()[static_cast<std::size_t>(target)];
}

int cost(const expression_graph& graph, cost_target target) {
    switch (target) {
        case cost_target::x86:
            return x86_cost(graph);
        case cost_target::mcu:
            return mcu_cost(graph);
        case cost_target::operations:
            break;
    }
    const operation_count count = count_operations(graph);
    return count.mul + count.add + count.div;
}

}  // namespace idim::generator
