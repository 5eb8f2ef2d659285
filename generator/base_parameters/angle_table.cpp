#include "base_parameters/angle_table.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <optional>
#include <set>

#include "kinematics/expression_parser.hpp"

namespace idim::generator {

namespace {

constexpr int largest_power = 16;

/// constant + sum of factor times symbol node.
struct linear_form {
    rational constant = 0;
    std::map<int, rational> factors;
};

void add_scaled(linear_form& sum, const linear_form& other, const rational& scale) {
    sum.constant = sum.constant + scale * other.constant;
    for (const auto& [symbol, factor] : other.factors) {
        sum.factors[symbol] = sum.factors[symbol] + scale * factor;
    }
}

std::optional<linear_form> linear(const expression_graph& graph, signed_node value) {
    const graph_node& node = graph[value];
    const rational sign = value.negative ? -1 : 1;
    linear_form form;
    if (node.kind == operation::constant) {
        form.constant = sign * node.value;
        return form;
    }
    if (node.kind == operation::symbol) {
        form.factors[value.id] = sign;
        return form;
    }
    const bool is_scaled = node.kind == operation::multiply && graph.is_constant(node.a);
    if (node.kind != operation::add && !is_scaled) {
        return std::nullopt;
    }
    const auto b = linear(graph, node.b);
    const auto a = is_scaled ? std::optional(linear_form{}) : linear(graph, node.a);
    if (!a || !b) {
        return std::nullopt;
    }
    add_scaled(form, *a, sign);
    add_scaled(form, *b, is_scaled ? sign * graph[node.a].value : sign);
    return form;
}

std::set<int> angles_of(const expression_graph& graph) {
    std::set<int> angles;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        const graph_node& node = graph.nodes()[id];
        if (live[id] && node.kind == operation::function &&
            (node.function == function_kind::cos || node.function == function_kind::sin)) {
            angles.insert(node.a.id);
        }
    }
    return angles;
}

/// Angles in terms of symbols: those that share none with another angle are left out.
std::map<int, linear_form> related_angles(const expression_graph& graph) {
    std::map<int, linear_form> forms;
    std::map<int, int> uses;
    for (const int angle : angles_of(graph)) {
        if (const auto form = linear(graph, {angle, false})) {
            forms[angle] = *form;
            for (const auto& [symbol, factor] : form->factors) {
                ++uses[symbol];
            }
        }
    }
    for (auto at = forms.begin(); at != forms.end();) {
        const auto& factors = at->second.factors;
        const bool shares =
            std::any_of(factors.begin(), factors.end(), [&uses](const auto& entry) { return uses[entry.first] > 1; });
        at = shares ? std::next(at) : forms.erase(at);
    }
    return forms;
}

/// The smallest number by which all factors of a symbol become integers.
std::map<int, cln::cl_I> denominators(const std::map<int, linear_form>& forms) {
    std::map<int, cln::cl_I> result;
    for (const auto& [angle, form] : forms) {
        for (const auto& [symbol, factor] : form.factors) {
            const auto [at, fresh] = result.try_emplace(symbol, 1);
            at->second = cln::lcm(at->second, cln::denominator(factor));
        }
    }
    return result;
}

void set_constant(angle_form& form, const rational& angle) {
    if (cln::zerop(angle)) {
        return;
    }
    const GiNaC::numeric half = GiNaC::numeric(cln::cl_N(angle)) / 2;
    const GiNaC::numeric tangent = constant_value(GiNaC::tan(half), {});
    const rational t = cln::the<rational>(tangent.to_cl_N());
    form.cos = (1 - t * t) / (1 + t * t);
    form.sin = 2 * t / (1 + t * t);
}

}  // namespace

angle_table::angle_table(const expression_graph& graph) {
    const std::map<int, linear_form> related = related_angles(graph);
    const std::map<int, cln::cl_I> parts = denominators(related);
    for (const int angle : angles_of(graph)) {
        angle_form& form = forms_[angle];
        form.terms = {{angle, 1}};
        const auto found = related.find(angle);
        if (found == related.end()) {
            continue;
        }
        std::vector<angle_form::term> terms;
        bool is_short = true;
        for (const auto& [symbol, factor] : found->second.factors) {
            const cln::cl_I power = cln::numerator(factor * parts.at(symbol));
            is_short = is_short && cln::abs(power) <= largest_power;
            if (is_short && !cln::zerop(power)) {
                terms.push_back({symbol, cln::cl_I_to_int(power)});
            }
        }
        if (is_short) {
            form.terms = terms;
            set_constant(form, found->second.constant);
        }
    }
}

}  // namespace idim::generator
