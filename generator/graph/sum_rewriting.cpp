#include "graph/sum_rewriting.hpp"

#include <algorithm>
#include <map>

#include "graph/graph_copy.hpp"

namespace idim::generator {

namespace {

class sum_rewriter {
  public:
    explicit sum_rewriter(const expression_graph& from)
        : from_(from), live_(from.live()), uses_(live_.size(), 0), is_term_(live_.size(), false), copy_(from, to_) {
        count_uses();
    }

    expression_graph run() {
        to_.reserve(live_.size());
        for (std::size_t id = 0; id < live_.size(); ++id) {
            const signed_node node{static_cast<int>(id), false};
            if (live_[id] && !is_term_[id] && from_[node].kind == operation::add) {
                rewrite(node);
            } else if (live_[id]) {
                copy_.of(node);  // in the order of the original, so that operands keep theirs
            }
        }
        for (const graph_output& out : from_.outputs()) {
            to_.output(out.array, out.index, copy_.of(out.value));
        }
        return std::move(to_);
    }

  private:
    static std::size_t index(signed_node n) { return static_cast<std::size_t>(n.id); }

    void count_uses() {
        for (std::size_t id = 0; id < live_.size(); ++id) {
            const graph_node& node = from_.nodes()[id];
            if (live_[id] && node.kind != operation::constant && node.kind != operation::symbol) {
                ++uses_[index(node.a)];
                ++uses_[index(node.b)];
            }
        }
        for (const graph_output& out : from_.outputs()) {
            ++uses_[index(out.value)];
        }
        for (std::size_t id = 0; id < live_.size(); ++id) {
            const graph_node& node = from_.nodes()[id];
            if (live_[id] && node.kind == operation::add && !of_parameters(node)) {
                is_term_[index(node.a)] = is_term_[index(node.a)] || joins(node.a);
                is_term_[index(node.b)] = is_term_[index(node.b)] || joins(node.b);
            }
        }
    }

    static bool of_parameters(const graph_node& node) { return node.role <= symbol_role::parameter; }

    /// A sum that only the sum above it needs. One with a name stays on a line of its own unless it has parameters to
    /// give away.
    bool joins(signed_node n) const {
        const graph_node& node = from_[n];
        return node.kind == operation::add && uses_[index(n)] == 1 && !of_parameters(node) &&
               (node.name.empty() || of_parameters(from_[node.a]) || of_parameters(from_[node.b]));
    }

    void collect(signed_node n, std::vector<signed_node>& terms) const {
        const graph_node& node = from_[n];
        for (const signed_node operand : {node.a, node.b}) {
            const signed_node term{operand.id, operand.negative != n.negative};
            if (joins(operand)) {
                collect(term, terms);
            } else {
                terms.push_back(term);
            }
        }
    }

    /// Gives the sum in the copy, term by term, those of parameters alone first.
    void rewrite(signed_node root) {
        std::vector<signed_node> terms;
        collect(root, terms);
        std::vector<signed_node> copies;
        const auto parameters = std::stable_partition(terms.begin(), terms.end(),
                                                      [this](signed_node term) { return of_parameters(from_[term]); });
        const bool gathers = parameters - terms.begin() > 1;
        std::vector<signed_node> factored = take_common_factors(terms);
        if (!gathers && factored.empty()) {
            copy_.of(root);
            return;
        }
        signed_node sum = to_.zero();
        for (const signed_node term : terms) {
            sum = to_.add(sum, copy_.of(term));
        }
        for (const signed_node product : factored) {
            sum = to_.add(sum, product);
        }
        copy_.replace(root, sum);
        const std::string& name = from_[root].name;
        if (!name.empty()) {
            to_.name(sum, sum.negative ? name + "n" : name);
        }
    }

    /// Removes products with a common factor from the terms and returns what they make, in the copy.
    std::vector<signed_node> take_common_factors(std::vector<signed_node>& terms) {
        std::vector<signed_node> result;
        for (;;) {
            std::map<int, int> count;  // of products that hold a node as factor
            for (const signed_node term : terms) {
                if (is_own_product(term)) {
                    ++count[from_[term].a.id];
                    ++count[from_[term].b.id];
                }
            }
            const auto most = std::max_element(count.begin(), count.end(),
                                               [](const auto& a, const auto& b) { return a.second < b.second; });
            if (most == count.end() || most->second < 2) {
                return result;
            }
            const int factor = most->first;
            signed_node others = to_.zero();
            std::vector<signed_node> left;
            for (const signed_node term : terms) {
                const graph_node& node = from_[term];
                if (is_own_product(term) && (node.a.id == factor || node.b.id == factor)) {
                    const signed_node other = copy_.of(node.a.id == factor ? node.b : node.a);
                    others = to_.add(others, term.negative ? -other : other);
                } else {
                    left.push_back(term);
                }
            }
            terms = left;
            result.push_back(to_.multiply(copy_.of({factor, false}), others));
        }
    }

    bool is_own_product(signed_node n) const {
        return from_[n].kind == operation::multiply && uses_[index(n)] == 1 && from_[n].a.id != from_[n].b.id &&
               !from_.is_constant(from_[n].a) && !of_parameters(from_[n]);
    }

    const expression_graph& from_;
    expression_graph to_;
    std::vector<bool> live_;
    std::vector<int> uses_;
    std::vector<bool> is_term_;  ///< joins another sum
    graph_copy copy_;
};

}  // namespace

expression_graph with_rewritten_sums(const expression_graph& graph) {
    return sum_rewriter(graph).run();
}

}  // namespace idim::generator
