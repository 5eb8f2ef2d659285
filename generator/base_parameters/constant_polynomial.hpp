#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base_parameters/prime_field.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// Product of powers of constants: (index into kinematic_tree::constants, exponent), by ascending index.
using monomial = std::vector<std::pair<std::size_t, int>>;

/// A coefficient of a regrouping, exact: a sum of rational multiples of monomials in the constants of the robot, such
/// as D3^2 + R3^2.
struct constant_polynomial {
    std::map<monomial, rational> terms;  ///< monomial -> coefficient, none of them zero

    constant_polynomial() = default;
    explicit constant_polynomial(const rational& number);

    bool is_zero() const { return terms.empty(); }
    void add(const rational& coefficient, const monomial& m);
    constant_polynomial& operator+=(const constant_polynomial& other);
    friend constant_polynomial operator*(const constant_polynomial& a, const constant_polynomial& b);

    rational value(const std::vector<rational>& constants) const;
    /// "L^2", "2*RL4", "D3^2 + R3^2"; a decimal number where a bare number of the description takes part.
    std::string text(const kinematic_tree& tree) const;
};

/// Values of the robot's constants, by their index in the tree.
std::vector<rational> constant_values(const kinematic_tree& tree);

/// Monomials that may occur in the given groups of constants: degree up to two in the lengths, and up to two in cosine
/// and sine of each angle (moving an inertia is quadratic in both). A group holds one length or the cosine and sine of
/// one angle.
std::vector<monomial> candidate_monomials(const std::vector<std::vector<std::size_t>>& groups);

prime_field evaluate(const monomial& m, const std::vector<prime_field>& constants);

}  // namespace idim::generator
