#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "idim/estimate.hpp"
#include "idim/inertial_body.hpp"
#include "idim/model_interface.h"

namespace idim {

/// What is known of standard parameters beforehand.
struct physical_parameters {
    struct lower_bound {
        Eigen::Index place = 0;  ///< among the standard parameters, not one of a body
        double low = 0.0;
    };

    std::vector<inertial_body> bodies;
    std::vector<lower_bound> coefficients;  ///< frictions, rotor inertias ..: those of effects that must not be smaller
};

struct interval {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Optional bounds of one body.
struct body_bounds {
    interval mass;                   ///< [kg]
    std::array<interval, 3> centre;  ///< of mass, in the axes of the body's frame [m]
};

/// spatial: m > 0 and I_g > 0 (spatial_inertia), as published [CWLS 13]; full: the pseudo-inertia, triangle
/// inequalities too.
enum class consistency_kind { spatial, full };
/// weighted: |Sigma^-1/2 (Y - W chi)|^2; normal: |W' Sigma^-1 (Y - W chi)|^2, as published [CWLS 18].
enum class consistency_objective { weighted, normal };

struct consistency_request {
    consistency_kind kind = consistency_kind::full;
    consistency_objective objective = consistency_objective::weighted;
    std::vector<body_bounds> bodies = {};  ///< one for each body, or none at all
    interval total_mass = {};              ///< of all links [kg]
    /// [s] a-priori standard parameters; those of bodies are read. What the data does not determine comes out near
    /// them.
    std::optional<Eigen::VectorXd> prior = {};
    double prior_strength = 0.0;  ///< weight of the divergence from the prior in the objective; 0: it decides only what
                                  ///< the data leaves open
    /// Smallest eigenvalue that the matrix of a body may have [kg m^2 and kg]; default 1e-6 of the largest inertial
    /// parameter.
    std::optional<double> floor = {};
    bool weights_joints = true;  ///< false: the rows are whitened (periodic.hpp), in units of their own deviation
};

/// A body as identified.
struct consistent_body {
    std::string name;
    double mass = 0.0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of mass, in its frame [m]
    double central_eigenvalue = 0.0;                   ///< smallest of I_g [kg m^2]
    double pseudo_eigenvalue = 0.0;                    ///< smallest of the pseudo-inertia
};

/// A constraint that the data presses against.
struct active_constraint {
    std::string name;    ///< "link of j3: 1 of 4 eigenvalues at the floor", "Fv3 >= 0"
    double price = 0.0;  ///< what the objective would fall by per unit of the bound
};

/// Smallest eigenvalue of M(q) over configurations, and the share of them in which it is not positive.
struct inertia_scan {
    int configurations = 0;
    double smallest = std::numeric_limits<double>::quiet_NaN();
    double share_not_positive = 0.0;
};

/// Constrained weighted least squares and what it took. Without a result fit.chi is empty and fit.message says why.
struct consistent_estimate {
    estimate fit;            ///< deviations those of the constrained estimate, to first order
    estimate unconstrained;  ///< weighted least squares on the same rows
    std::vector<bool>
        at_bound;  ///< [b] held by active constraints: the data moves them by less than 1e-3 of what it would
    Eigen::VectorXd standard;  ///< [s] one consistent set, NaN for those that move no torque and are no body's
    std::vector<consistent_body> bodies;
    std::vector<active_constraint> active;
    double floor = 0.0;
    double objective = 0.0;  ///< at the result
    double unconstrained_objective = 0.0;
    double gap = 0.0;  ///< no consistent parameters have an objective below `objective - gap` (cone_program.hpp)
    int steps = 0;
    inertia_scan inertia, unconstrained_inertia;
};

/// Minimises the objective over all standard parameters that the constraints allow; chi = R theta is linear in these,
/// so that the problem is convex and its optimum unique in chi. Objectives count half squares, with rows of joint j
/// divided by its deviation as in least_squares_method::wls. The standard parameters are one of many sets with this
/// chi: the one nearest to the prior in log-det divergence, else to a reference body of the size of the largest
/// inertial parameter with a radius of gyration of 0.2 m.
///
/// Bodies are kept below some hundred times the mass of that reference, since a mass that no motion shows could else
/// grow without end to make room for first moments; where this matters it is among the active constraints.
///
/// Deviations are those of wls carried through the derivative of the solution: constraints that hold at the optimum are
/// taken to hold.
///
/// Throws input_error where no parameters can satisfy the bounds, naming them, and where the prior is not consistent.
consistent_estimate consistent_fit(const idim_model_interface& model, const observation& rows,
                                   const physical_parameters& known, const consistency_request& request);

/// M(q) at q = 0 and at random configurations, the same every time: a whole turn, [-1, 1] m.
inertia_scan scan_inertia(const idim_model_interface& model, const Eigen::VectorXd& chi, int configurations);

}  // namespace idim
