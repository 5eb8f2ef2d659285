#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "base_parameters/prime_field.hpp"
#include "base_parameters/standard_regressor.hpp"
#include "graph/evaluate.hpp"

namespace idim::generator {

/// A random state of the robot in exact numbers, where the standard regressor is evaluated over a field T (rationals,
/// or integers modulo a prime). Cosine and sine of an angle lie on the unit circle exactly: ((1-t^2)/(1+t^2),
/// 2t/(1+t^2)) with t rational. Signs are +1 or -1, abs(x) = sign(x) x; other functions are not rational and stand for
/// values of their own, but for the roots of closed loops: these are found modulo a prime, where they exist. The same
/// seed gives the same state for every T.
template <class T>
class sample_point {
  public:
    sample_point(const standard_regressor& W, std::uint64_t seed) : W_(W), random_(seed) {
        for (std::size_t i = 0; i < W.graph.symbols().size(); ++i) {
            symbols_.push_back(draw());
        }
    }

    /// The regressor's row at random virtual velocities. `evaluator`: of its graph; `constants`: of the robot. Nothing
    /// where a loop does not close.
    std::optional<std::vector<T>> combined_row(graph_evaluator<T>& evaluator, const std::vector<T>& constants) {
        closes_ = true;
        std::vector<T> row = evaluator.evaluate(with(constants), *this);
        return closes_ ? std::optional(std::move(row)) : std::nullopt;
    }

    /// All rows of W_st; none where a loop does not close.
    std::vector<std::vector<T>> rows(graph_evaluator<T>& evaluator, const std::vector<T>& constants) {
        std::vector<T> symbols = with(constants);
        const auto first = symbols.begin() + static_cast<std::ptrdiff_t>(W_.first_virtual());
        std::fill(first, symbols.end(), T());
        std::vector<std::vector<T>> rows;
        closes_ = true;
        for (auto v = first; v != symbols.end(); ++v) {
            *v = integer(1);
            rows.push_back(evaluator.evaluate(symbols, *this));
            *v = T();
        }
        return closes_ ? rows : std::vector<std::vector<T>>();
    }

    T function(function_kind kind, signed_node argument, const T& x, const T&) {
        const int node = argument.id;
        switch (kind) {
            case function_kind::cos:
                return circle(node).first;
            case function_kind::sin:
                return circle(node).second;
            case function_kind::sign:
                return sign(node);
            case function_kind::abs:
                return sign(node) * x;
            case function_kind::sqrt:
                return W_.is_root(node) ? root(x) : own_value(kind, node);
            default:
                return own_value(kind, node);
        }
    }

  private:
    static T integer(long value) {
        if constexpr (std::is_same_v<T, prime_field>) {
            const prime_field magnitude(static_cast<std::uint64_t>(std::abs(value)));
            return value < 0 ? -magnitude : magnitude;
        } else {
            return T(value);
        }
    }

    /// Small, so that exact evaluations stay short.
    T draw() {
        const auto numerator = static_cast<long>(random_() % 7) + 1;
        const auto denominator = static_cast<long>(random_() % 3) + 1;
        return integer(random_() % 2 == 0 ? numerator : -numerator) / integer(denominator);
    }

    std::vector<T> with(const std::vector<T>& constants) const {
        std::vector<T> symbols = symbols_;
        for (std::size_t i = 0; i < symbols.size(); ++i) {
            const graph_symbol& symbol = W_.graph.symbols()[i];
            if (symbol.role == symbol_role::constant) {
                symbols[i] = constants[static_cast<std::size_t>(symbol.index)];
            }
        }
        return symbols;
    }

    /// Cosine and sine.
    using circle_point = std::pair<T, T>;

    static circle_point sum(const circle_point& a, const circle_point& b) {
        return {a.first * b.first - a.second * b.second, a.second * b.first + a.first * b.second};
    }

    const circle_point& circle(int node) {
        const auto known = circles_.find(node);
        if (known != circles_.end()) {
            return known->second;
        }
        const composed_angle* angle = W_.angles.find(node);
        return circles_.emplace(node, angle == nullptr ? free_circle(node) : composed(*angle)).first->second;
    }

    circle_point composed(const composed_angle& angle) {
        circle_point result{integer(1), integer(0)};
        if (angle.constant) {
            result = {T(angle.constant->first), T(angle.constant->second)};
        }
        for (const auto& [node, multiple] : angle.terms) {
            const auto& [cosine, sine] = free_circle(node);
            for (int i = 0; i < std::abs(multiple); ++i) {
                result = sum(result, {cosine, multiple < 0 ? T(-sine) : sine});
            }
        }
        return result;
    }

    const circle_point& free_circle(int node) {
        const auto known = free_circles_.find(node);
        if (known != free_circles_.end()) {
            return known->second;
        }
        const T t = draw();
        const T norm = integer(1) + t * t;
        return free_circles_.emplace(node, std::pair((integer(1) - t * t) / norm, integer(2) * t / norm)).first->second;
    }

    /// Where there is none, any value: the evaluation is void.
    T root(const T& x) {
        if constexpr (std::is_same_v<T, prime_field>) {
            const std::optional<T> found = x.root();
            closes_ = closes_ && found && !x.is_zero();
            return closes_ ? *found : integer(1);
        } else {
            throw std::logic_error("loops have no exact states in rational numbers");
        }
    }

    T sign(int node) { return signs_.try_emplace(node, integer(random_() % 2 == 0 ? 1 : -1)).first->second; }

    T own_value(function_kind kind, int node) {
        const auto known = others_.find({kind, node});
        return known != others_.end() ? known->second : others_.emplace(std::pair(kind, node), draw()).first->second;
    }

    const standard_regressor& W_;
    std::mt19937_64 random_;
    std::vector<T> symbols_;
    std::map<int, circle_point> circles_, free_circles_;
    std::map<int, T> signs_;
    std::map<std::pair<function_kind, int>, T> others_;
    bool closes_ = true;
};

}  // namespace idim::generator
