#pragma once

#include <map>
#include <vector>

#include "base_parameters/column_selection.hpp"
#include "base_parameters/constant_polynomial.hpp"
#include "base_parameters/standard_regressor.hpp"

namespace idim::generator {

/// One coefficient that is not zero: dropped column = ... + coefficient * kept column + ...
struct regrouped_column {
    std::size_t kept = 0;
    std::size_t dropped = 0;
    constant_polynomial coefficient;
    rational exact;  ///< its value at the robot's own constants
};

/// Exact side of the search for base parameters: which columns of the standard regressor depend on which, as formulas in the
/// robot's constants.
class regrouping {
  public:
    regrouping(const standard_regressor& W, const kinematic_tree& tree, const std::vector<std::size_t>& preference);

    /// Decision at the robot's own constants.
    const exact_selection& selection() const { return own_; }
    /// Number of rational points.
    int points() const { return points_; }

    /// All coefficients as polynomials in the constants: the elimination repeated at random constants shows on which of them a
    /// coefficient depends, and a linear system gives its monomials. Where the rank at the robot's own constants is a special
    /// case, or a coefficient is no such polynomial, it is a number.
    std::vector<regrouped_column> columns() const;

    /// Inserts the coefficients at every rational point, in CLN rationals. Throws rank_disagreement where the dropped columns are not
    /// these combinations of the kept ones.
    void prove(const std::vector<regrouped_column>& columns) const;

  private:
    using beta_matrix = std::vector<std::vector<prime_field>>;
    /// Random constants of the field, cosine and sine of one angle on the circle; `seed` 0 gives the robot's own.
    std::vector<rational> draw_constants(std::uint64_t seed) const;
    exact_selection select_at(const std::vector<rational>& constants) const;
    constant_polynomial number(prime_field residue) const;
    std::vector<std::vector<std::size_t>> constant_groups() const;

    const standard_regressor& W_;
    const kinematic_tree& tree_;
    const std::vector<std::size_t>& preference_;
    int points_ = 0;
    std::vector<rational> own_constants_;
    exact_selection own_;
};

}  // namespace idim::generator
