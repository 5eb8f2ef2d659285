#pragma once

#include <functional>
#include <map>
#include <optional>
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
    bool is_exact = true;  ///< otherwise a number from the QR, proven modulo a prime only
    rational exact;        ///< its value at the robot's own constants
};

/// Exact side of the search for base parameters: which columns of the standard regressor depend on which, as formulas
/// in the robot's constants.
class regrouping {
  public:
    regrouping(const standard_regressor& W, const kinematic_tree& tree, const std::vector<std::size_t>& preference);

    /// Decision at the robot's own constants.
    const exact_selection& selection() const { return own_; }
    /// Number of rational points.
    int points() const { return points_; }

    /// All coefficients as polynomials in the constants: the elimination repeated at random constants shows on which of
    /// them a coefficient depends, and a linear system gives its monomials. Where the rank at the robot's own constants
    /// is a special case, or a coefficient is no such polynomial, it is a number.
    /// `beta`: the same coefficients by QR, kept x dropped in the order of selection().
    std::vector<regrouped_column> columns(const Eigen::MatrixXd& beta) const;

    /// Inserts the coefficients at every rational point, in CLN rationals. Throws rank_disagreement where a dropped
    /// column is not this combination of the kept ones. Returns the number of dropped columns left out because a
    /// coefficient is no exact number (oblique axes with many constants): for these the elimination modulo a prime is
    /// the evidence.
    int prove(const std::vector<regrouped_column>& columns) const;

  private:
    /// The elimination repeated at random constants: `samples` at all of them drawn anew, `changed` with one group
    /// changed.
    struct elimination_series {
        std::vector<std::vector<std::size_t>> groups;  ///< one length, or cosine and sine of one angle
        std::vector<exact_selection> samples, changed;
        std::vector<std::vector<prime_field>> constants;  ///< of `samples`
        std::map<std::vector<std::size_t>, std::vector<monomial>> candidates;
    };

    /// Random constants, cosine and sine of one angle on the circle; `seed` 0 gives the robot's own.
    std::vector<rational> draw_constants(std::uint64_t seed) const;
    std::vector<std::vector<std::size_t>> constant_groups() const;
    exact_selection select_at(const std::vector<rational>& constants) const;
    std::vector<std::vector<rational>> exact_rows(int point_number) const;
    /// Calls visit(k, d) for every coefficient that is not zero.
    void for_each_coefficient(const std::function<void(std::size_t, std::size_t)>& visit) const;

    /// Empty where the rank at the robot's own constants is a special case.
    elimination_series eliminate_at_random_constants() const;
    /// Groups of constants that coefficient (k, d) depends on.
    std::vector<std::size_t> dependence(const elimination_series& series, std::size_t k, std::size_t d) const;
    const std::vector<monomial>& candidates(elimination_series& series, const std::vector<std::size_t>& set) const;
    std::optional<constant_polynomial> formula(elimination_series& series, std::size_t k, std::size_t d) const;
    regrouped_column column(elimination_series& series, std::size_t k, std::size_t d, double by_qr) const;

    const standard_regressor& W_;
    const kinematic_tree& tree_;
    const std::vector<std::size_t>& preference_;
    int points_ = 0;
    std::vector<rational> own_constants_;
    exact_selection own_;
};

}  // namespace idim::generator
