#include "base_parameters/base_parameter_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "base_parameters/column_selection.hpp"
#include "base_parameters/regrouping.hpp"
#include "base_parameters/standard_regressor.hpp"
#include "graph/evaluate.hpp"

namespace idim::generator {

namespace {

/// A column whose part outside the span of the ones before it is below this share of its norm is dependent: rounding
/// leaves 1e-14, real robots' pivots stay above 1e-5 at states of order one.
constexpr double qr_tolerance = 1e-9;

int rank_of_preference(const kinematic_joint& joint, parameter_kind kind) {
    if (kind == parameter_kind::effect) {
        return 1;
    }
    if (joint.type == joint_type::fixed) {
        return 3;
    }
    const bool is_inertia = kind <= parameter_kind::ZZ;
    if (joint.type == joint_type::prismatic) {
        return is_inertia ? 2 : 0;
    }
    return kind == parameter_kind::YY || kind == parameter_kind::MZ || kind == parameter_kind::M ? 2 : 0;
}

std::vector<std::size_t> preference_order(const kinematic_tree& tree, const standard_parameters& parameters) {
    std::vector<std::size_t> order(parameters.all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t p) {
        const standard_parameter& parameter = parameters.all[p];
        const int rank = rank_of_preference(tree.joints[static_cast<std::size_t>(parameter.joint)], parameter.kind);
        // Outermost first, but what moves with a drive before what a loop carries along.
        const bool outward = rank != 0 || tree.joints[static_cast<std::size_t>(parameter.joint)].passive;
        return std::pair{rank, outward ? parameter.joint + 1 : -parameter.joint};
    };
    std::stable_sort(order.begin(), order.end(), [&key](std::size_t a, std::size_t b) { return key(a) < key(b); });
    return order;
}

/// Signs, exponentials and other functions that are not of angles, with values of their own as in exact arithmetic
/// (sample_point): an effect that acts in a narrow range only, such as exp(-(qd/0.001)^2), is zero at all states that
/// are drawn at random.
class free_functions {
  public:
    free_functions(const standard_regressor& W, std::uint64_t seed) : W_(W), random_(seed) {}

    double function(function_kind kind, signed_node argument, double x, double y) {
        switch (kind) {
            case function_kind::sin:
            case function_kind::cos:
                return double_arithmetic::function(kind, argument, x, y);
            case function_kind::abs:
                return sign(argument.id) * x;
            case function_kind::sign:
                return sign(argument.id);
            case function_kind::sqrt:
                return W_.is_root(argument.id) ? std::sqrt(x) : own_value(kind, argument.id);
            default:
                return own_value(kind, argument.id);
        }
    }
    void draw_again() {
        signs_.clear();
        others_.clear();
    }

  private:
    double own_value(function_kind kind, int node) {
        return others_.try_emplace({kind, node}, uniform()).first->second;
    }
    double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1.0; }
    double sign(int node) { return signs_.try_emplace(node, uniform() < 0.0 ? -1.0 : 1.0).first->second; }

    const standard_regressor& W_;
    std::mt19937_64 random_;
    std::map<int, double> signs_;
    std::map<std::pair<function_kind, int>, double> others_;
};

/// The functions themselves.
struct true_functions {
    static double function(function_kind kind, signed_node argument, double x, double y) {
        return double_arithmetic::function(kind, argument, x, y);
    }
    void draw_again() {}
};

/// Rows at one state as small or large as they are there, or nothing where a loop does not close. Near singular
/// positions of loops they are large beyond measure: then scaled.
bool is_usable(const standard_regressor& W, Eigen::Ref<Eigen::MatrixXd> rows) {
    if (W.has_roots) {
        for (auto row : rows.rowwise()) {
            row /= std::max(1.0, row.cwiseAbs().maxCoeff());
        }
    }
    return rows.allFinite();
}

/// W_st at random states of order one, rows at least twice the columns.
template <class Functions>
Eigen::MatrixXd sample_regressor(const standard_regressor& W, const kinematic_tree& tree, Functions functions) {
    const std::size_t samples = 2 * (W.columns / W.dof + 1);
    Eigen::MatrixXd sampled(static_cast<Eigen::Index>(samples * W.dof), static_cast<Eigen::Index>(W.columns));
    std::mt19937_64 random(1);
    const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
    graph_evaluator<double> evaluator(W.graph, double_arithmetic::number);
    const std::vector<graph_symbol>& symbols = W.graph.symbols();
    const auto dof = static_cast<Eigen::Index>(W.dof);
    std::size_t tries = 0;
    for (Eigen::Index row = 0; row < sampled.rows();) {
        if (++tries > 1000 * samples) {
            throw rank_disagreement("base parameters: too few states are found where all loops close");
        }
        std::vector<double> values(symbols.size(), 0.0);
        functions.draw_again();
        for (std::size_t i = 0; i < W.first_virtual(); ++i) {
            const double drawn = symbols[i].role == symbol_role::position ? 3.0 * uniform() : 2.0 * uniform();
            values[i] = symbols[i].role == symbol_role::constant
                            ? tree.constants[static_cast<std::size_t>(symbols[i].index)].value.to_double()
                            : drawn;
        }
        for (std::size_t v = W.first_virtual(); v < values.size(); ++v) {
            values[v] = 1.0;
            const std::vector<double> columns = evaluator.evaluate(values, functions);
            sampled.row(row + static_cast<Eigen::Index>(v - W.first_virtual())) =
                Eigen::Map<const Eigen::RowVectorXd>(columns.data(), sampled.cols());
            values[v] = 0.0;
        }
        row += is_usable(W, sampled.middleRows(row, dof)) ? dof : 0;
    }
    return sampled;
}

void compare(const column_selection& by_qr, const exact_selection& exact) {
    if (by_qr.kept != exact.kept) {
        throw rank_disagreement(fmt::format(
            "base parameters: rank {} by QR (smallest kept pivot {:.1e}, largest dropped {:.1e}) but {} in exact "
            "arithmetic; the geometry is close to a special case, give its constants exactly",
            by_qr.kept.size(), by_qr.smallest_kept, by_qr.largest_dropped, exact.kept.size()));
    }
}

std::string formula(const kinematic_tree& tree, const standard_parameters& parameters, const base_parameter& base) {
    std::string text = parameters.all[base.standard].name;
    for (const regrouped_term& term : base.regrouped) {
        std::string coefficient = term.coefficient.text(tree);
        const bool is_sum = coefficient.find(' ') != std::string::npos;
        const bool negative = !is_sum && coefficient.front() == '-';
        coefficient = is_sum ? "(" + coefficient + ")" : coefficient.substr(negative ? 1 : 0);
        text += negative ? " - " : " + ";
        text += (coefficient == "1" ? "" : coefficient + "*") + parameters.all[term.standard].name;
    }
    return text;
}

}  // namespace

parameter_selection base_parameter_set::selection() const {
    parameter_selection chosen;
    for (const base_parameter& parameter : parameters) {
        chosen.kept.push_back(parameter.standard);
        chosen.names.push_back(parameter.name);
    }
    return chosen;
}

base_parameter_set find_base_parameters(const kinematic_tree& tree, const standard_parameters& parameters) {
    const standard_regressor W = build_standard_regressor(tree, parameters);
    const std::vector<std::size_t> preference = preference_order(tree, parameters);
    Eigen::MatrixXd sampled = sample_regressor(W, tree, true_functions{});
    column_selection by_qr = select_by_qr(sampled, preference, qr_tolerance);
    regrouping groups(W, tree, parameters, preference);
    if (by_qr.kept != groups.selection().kept) {
        sampled = sample_regressor(W, tree, free_functions(W, 2));
        by_qr = select_by_qr(sampled, preference, qr_tolerance);
    }
    compare(by_qr, groups.selection());
    const std::vector<regrouped_column> columns = groups.columns(sampled);
    const int modulo_prime_only = groups.prove(columns);

    base_parameter_set result;
    result.standard = static_cast<int>(W.columns);
    result.evidence = {static_cast<int>(by_qr.kept.size()),
                       by_qr.smallest_kept,
                       by_qr.largest_dropped,
                       static_cast<int>(groups.selection().kept.size()),
                       groups.points(),
                       modulo_prime_only};
    std::vector<std::size_t> kept = by_qr.kept;
    std::sort(kept.begin(), kept.end());
    for (const std::size_t p : kept) {
        const standard_parameter& parameter = parameters.all[p];
        base_parameter base{p, parameter.name, parameter.unit, parameter.min, {}, {}};
        for (const regrouped_column& column : columns) {
            if (column.kept == p) {
                base.regrouped.push_back({column.dropped, column.coefficient, column.exact});
            }
        }
        std::sort(base.regrouped.begin(), base.regrouped.end(),
                  [](const regrouped_term& a, const regrouped_term& b) { return a.standard < b.standard; });
        base.name += base.regrouped.empty() ? "" : "R";
        base.formula = formula(tree, parameters, base);
        result.parameters.push_back(base);
    }
    result.rigid.kept = groups.kept_of_rigid();
    std::sort(result.rigid.kept.begin(), result.rigid.kept.end());
    for (const std::size_t p : result.rigid.kept) {
        result.rigid.names.push_back(parameters.all[p].name);
    }
    for (std::size_t p = 0; p < parameters.all.size(); ++p) {
        const auto in = [p](const std::vector<std::size_t>& list) {
            return std::find(list.begin(), list.end(), p) != list.end();
        };
        if (!in(by_qr.kept) && !in(by_qr.dropped)) {
            result.without_effect.push_back(p);
        }
    }
    return result;
}

}  // namespace idim::generator
