#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "base_parameters/angle_table.hpp"
#include "graph/evaluate.hpp"
#include "graph/expression_graph.hpp"

namespace idim::generator {

/// Values for the constants of a graph, one per graph symbol (others ignored).
using constant_values = std::vector<rational>;

/// A random state of the robot in exact numbers, from which a graph is evaluated over a field T (rationals, or integers
/// modulo a prime). Cosine and sine of a base angle lie on the unit circle exactly: ((1-t^2)/(1+t^2), 2t/(1+t^2)) with
/// t rational; other angles follow by the addition theorems. Signs are +1 or -1, abs(x) = sign(x) x; other functions
/// are not rational and stand for values of their own. The same seed gives the same state for every T.
template <class T>
class sample_point {
  public:
    sample_point(const angle_table& angles, std::uint64_t seed, std::uint64_t height)
        : angles_(angles), random_(seed), height_(height) {}

    /// Values of all outputs of the graph.
    std::vector<T> evaluate_at(const expression_graph& graph, const constant_values& constants) {
        std::vector<T> values;
        for (std::size_t i = 0; i < graph.symbols().size(); ++i) {
            const rational drawn = draw();
            values.push_back(T(graph.symbols()[i].role == symbol_role::constant ? constants[i] : drawn));
        }
        return evaluate(graph, values, *this);
    }

    static T number(const rational& value) { return T(value); }

    T function(function_kind kind, signed_node argument, const T& x, const T&) {
        const int node = argument.id;
        switch (kind) {
            case function_kind::cos:
                return angle(node).first;
            case function_kind::sin:
                return angle(node).second;
            case function_kind::sign:
                return T(rational(sign(node)));
            case function_kind::abs:
                return T(rational(sign(node))) * x;
            default:
                return T(own_value(kind, node));
        }
    }

  private:
    rational draw() {
        const auto numerator = static_cast<long>(random_() % height_) + 1;
        const auto denominator = static_cast<long>(random_() % 3) + 1;
        return rational(numerator) / rational(random_() % 2 == 0 ? denominator : -denominator);
    }

    using turn = std::pair<T, T>;  ///< cosine and sine

    static turn add(const turn& a, const turn& b) {
        return {a.first * b.first - a.second * b.second, a.first * b.second + a.second * b.first};
    }

    turn angle(int argument) {
        const angle_form& form = angles_[argument];
        turn sum = {T(form.cos), T(form.sin)};
        for (const angle_form::term& term : form.terms) {
            const auto [cos, sin] = base_circle(term.base);
            const turn step = {T(cos), T(term.power < 0 ? -sin : sin)};
            for (int k = 0; k < std::abs(term.power); ++k) {
                sum = add(sum, step);
            }
        }
        return sum;
    }

    std::pair<rational, rational> base_circle(int base) {
        const auto [at, fresh] = circles_.try_emplace(base);
        if (fresh) {
            const rational t = draw();
            const rational norm = 1 + t * t;
            at->second = {(1 - t * t) / norm, 2 * t / norm};
        }
        return at->second;
    }

    int sign(int node) { return signs_.try_emplace(node, random_() % 2 == 0 ? 1 : -1).first->second; }

    rational own_value(function_kind kind, int node) {
        const auto [at, fresh] = others_.try_emplace({kind, node});
        if (fresh) {
            at->second = draw();
        }
        return at->second;
    }

    const angle_table& angles_;
    std::mt19937_64 random_;
    std::uint64_t height_;
    std::map<int, std::pair<rational, rational>> circles_;
    std::map<int, int> signs_;
    std::map<std::pair<function_kind, int>, rational> others_;
};

}  // namespace idim::generator
