#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "base_parameters/constant_polynomial.hpp"
#include "dynamics/dynamic_models.hpp"

namespace idim::generator {

/// coefficient * (standard parameter)
struct regrouped_term {
    std::size_t standard = 0;
    constant_polynomial coefficient;
    rational exact;  ///< the coefficient at the robot's own constants
};

/// chi_base = chi_kept + sum of beta chi_dropped (Gautier 1991).
struct base_parameter {
    std::size_t standard = 0;  ///< the parameter that is kept
    std::string name;          ///< its name, with R behind it if others are regrouped into it: "ZZ1R"
    std::string unit;
    std::optional<double> min;
    std::vector<regrouped_term> regrouped;
    std::string formula;  ///< "ZZ1 + Ia1 + L^2*M2"
};

/// Why the rank is what it is.
struct rank_evidence {
    int qr_rank = 0;
    double smallest_kept = 0.0;    ///< relative pivot
    double largest_dropped = 0.0;  ///< relative pivot
    int exact_rank = 0;            ///< of the regressor at rational points, proven from both sides
    int exact_points = 0;
    int modulo_prime_only = 0;  ///< dropped columns whose dependence is shown modulo a prime but not in rationals
};

/// QR and exact arithmetic do not agree; what() gives both figures.
class rank_disagreement : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct base_parameter_set {
    std::vector<base_parameter> parameters;  ///< link by link, inertial parameters before effects
    int standard = 0;                        ///< number of standard parameters
    std::vector<std::size_t> without_effect;
    rank_evidence evidence;
    parameter_selection rigid;  ///< base parameters of the same links without effects, under their standard names

    parameter_selection selection() const;
};

/// Finds the base parameters of a tree with effects.
///
/// The regressor of the standard parameters is sampled at random states and its columns are taken in an order of
/// preference by QR (Gautier 1991): so that the names come out as in the literature, first XX XY XZ YZ ZZ MX MY of
/// revolute and MX MY MZ M of prismatic links from the last link to the first, then the effects, then the rest. The
/// decision is proven in exact arithmetic at rational points: independence of the kept columns modulo a prime (a lower
/// bound of the rank over the rationals); dependence of the dropped ones modulo that prime in every row, and over the
/// rationals by inserting the regrouping formulas in CLN rationals into the rows' combination by random virtual
/// velocities (an upper bound; but see rank_evidence::modulo_prime_only). The formulas come link by link, see
/// regrouping. Throws rank_disagreement where QR and exact rank differ.
///
/// Time for n joints: evaluations grow with n^2 (rows times links), the QR and the elimination with n^3, which shows
/// beyond some fifty joints.
base_parameter_set find_base_parameters(const kinematic_tree& tree, const standard_parameters& parameters);

}  // namespace idim::generator
