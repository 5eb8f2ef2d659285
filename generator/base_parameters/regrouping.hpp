#pragma once

#include <map>
#include <vector>

#include "base_parameters/angle_table.hpp"
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
    regrouping(const standard_regressor& W, const kinematic_tree& tree, const standard_parameters& parameters,
               const std::vector<std::size_t>& preference);

    /// Decision at the robot's own constants.
    const exact_selection& selection() const { return own_; }
    /// Number of rational points.
    int points() const { return points_; }

    /// All coefficients as polynomials in the constants, link by link as in the closed-form rules (Gautier and Khalil
    /// 1990): a dropped column of a link is a combination of the link's kept ones and of its antecedent's, with
    /// coefficients in the constants of this one joint, which eliminations at random constants determine. Inserted into
    /// each other from the base outward they give the coefficients in the kept columns. Where a column is no such
    /// combination its coefficients are numbers. `beta`: the same coefficients by QR, kept x dropped in the order of
    /// selection().
    std::vector<regrouped_column> columns(const Eigen::MatrixXd& beta) const;

    /// Inserts the coefficients at every rational point, in CLN rationals. Throws rank_disagreement where a dropped
    /// column is not this combination of the kept ones. Returns the number of dropped columns left out because a
    /// coefficient is no exact number: for these the elimination modulo a prime is the evidence.
    int prove(const std::vector<regrouped_column>& columns) const;

  private:
    using field_rows = std::vector<std::vector<prime_field>>;
    /// dropped -> kept -> coefficient
    using formula_table = std::map<std::size_t, std::map<std::size_t, constant_polynomial>>;
    /// The standard regressor modulo a prime, at several random constants.
    struct sampled_regressor {
        std::vector<std::vector<prime_field>> constants;
        std::vector<field_rows> rows;
    };

    /// Random constants, cosine and sine of one angle on the circle; `seed` 0 gives the robot's own.
    std::vector<rational> draw_constants(std::uint64_t seed) const;
    field_rows rows_at(const std::vector<rational>& constants) const;
    std::vector<std::vector<rational>> exact_rows(int point_number) const;

    /// Groups of the constants that enter one joint's transform: a length, or cosine and sine of an angle.
    std::vector<std::vector<std::size_t>> constants_of(const kinematic_joint& joint) const;
    std::vector<std::size_t> columns_of(const std::vector<std::size_t>& among, int link) const;
    /// Constants and rows number `s`: the joint's own constants are those of draw s, the others of draw s + variant *
    /// 1000.
    void sample(sampled_regressor& samples, std::size_t s, const std::vector<std::vector<std::size_t>>& own_groups,
                std::size_t variant) const;
    /// Dropped columns of one link in its kept ones and its antecedent's columns; empty where that is impossible. Each
    /// elimination takes the rows of so many draws of the other joints' constants: columns of the antecedent may depend
    /// on each other for one geometry of the inner links, but not for all.
    formula_table relate_to_antecedent(int link, std::size_t variants, sampled_regressor& samples) const;
    formula_table formulas() const;
    regrouped_column column(const formula_table& table, std::size_t k, std::size_t d, double by_qr) const;

    const standard_regressor& W_;
    angle_table angles_;
    const kinematic_tree& tree_;
    const standard_parameters& parameters_;
    const std::vector<std::size_t>& preference_;
    int points_ = 0;
    std::vector<rational> own_constants_;
    exact_selection own_;
};

}  // namespace idim::generator
