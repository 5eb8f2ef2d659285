#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base_parameters/column_selection.hpp"
#include "base_parameters/constant_polynomial.hpp"
#include "base_parameters/sample_point.hpp"
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
    /// What is kept where the robot has no effects, in the order of preference.
    const std::vector<std::size_t>& kept_of_rigid() const { return kept_of_rigid_; }
    /// Number of rational points.
    int points() const { return points_; }

    /// All coefficients as polynomials in the constants, link by link as in the closed-form rules (Gautier and Khalil
    /// 1990): a dropped column of a link is a combination of the link's kept ones and of its antecedent's (across
    /// massless links: of the next one inward that has parameters), with coefficients in the constants of the joints
    /// between, which eliminations at random constants determine. Inserted into each other from the base outward they
    /// give the coefficients in the kept columns. Where a column is no such combination its coefficients are numbers.
    /// `sampled`: the regressor at random states, for their size by QR.
    std::vector<regrouped_column> columns(const Eigen::MatrixXd& sampled);

    /// Inserts the coefficients into the combined row of every rational point, in CLN rationals. Throws
    /// rank_disagreement where a dropped column is not this combination of the kept ones. Returns the number of dropped
    /// columns left out because a coefficient is no exact number: for these the elimination modulo a prime is the
    /// evidence, as for all of a robot with loops, at whose states roots stand that are not rational.
    int prove(const std::vector<regrouped_column>& columns) const;

  private:
    /// dropped -> kept -> coefficient
    using formula_table = std::map<std::size_t, std::map<std::size_t, constant_polynomial>>;
    /// The dropped columns of one link and those that may express them.
    struct link_relation {
        std::vector<std::size_t> columns;  ///< the dropped ones from `first_target` on
        std::size_t first_target = 0;
        std::vector<std::vector<std::size_t>> groups;  ///< of constants that the coefficients may depend on
    };
    /// The standard regressor modulo a prime, at one draw of constants.
    struct constants_draw {
        std::vector<prime_field> constants;
        field_matrix rows;
    };

    link_relation relation_of(int link) const;
    /// Groups of the constants that enter the transforms of some joints: a length, or cosine and sine of an angle.
    std::vector<std::vector<std::size_t>> constants_of(const std::vector<int>& joints) const;
    std::vector<std::size_t> columns_of(const std::vector<std::size_t>& among, int link) const;
    std::vector<std::size_t> without_effects(const std::vector<std::size_t>& columns) const;
    /// Those of links and of payloads.
    std::vector<std::size_t> inertial(const std::vector<std::size_t>& columns) const;

    /// Random constants, cosine and sine of one angle on the circle.
    std::vector<prime_field> draw_constants(std::uint64_t seed) const;
    /// Draw number `s`: the constants of `groups` are those of seed s, the others of seed s + variant * 1000.
    constants_draw draw(std::size_t s, const std::vector<std::vector<std::size_t>>& groups, std::size_t variant);

    /// The relation as formulas; empty where there are none. Each elimination takes the rows of so many draws of the
    /// other joints' constants: columns of the antecedent may depend on each other for one geometry of the inner links,
    /// but not for all. `draws` grows as needed.
    formula_table solve(const link_relation& relation, std::size_t variants, std::vector<constants_draw>& draws);
    formula_table formulas();
    void insert(const formula_table& relations, formula_table& table) const;
    /// By formula, if there is one that has the value of the elimination.
    std::optional<regrouped_column> formula(const formula_table& table, std::size_t k, std::size_t d) const;
    /// A short fraction if that is what the QR sees too, otherwise the QR's own number.
    regrouped_column number(std::size_t k, std::size_t d, double by_qr) const;

    const standard_regressor& W_;
    const kinematic_tree& tree_;
    const standard_parameters& parameters_;
    graph_evaluator<prime_field> evaluator_;
    std::vector<sample_point<prime_field>> states_;  ///< for eliminations within one link
    std::size_t rows_of_draw_ = 0;
    int points_ = 0;
    std::vector<rational> own_constants_;
    exact_selection own_;
    std::vector<bool> is_kept_;
    std::vector<std::size_t> kept_of_rigid_;
};

}  // namespace idim::generator
