#include "consistency/consistency_program.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "idim/input_error.hpp"

namespace idim {

namespace {

constexpr double relative_floor = 1e-6;
constexpr double size_limit = 25.0;  // of bodies: masses up to 100 times the reference's, if they are nothing but mass
constexpr double gyration = 0.2;     // [m] of the reference body about each plane through its centre

Eigen::MatrixXd matrix_of(consistency_kind kind, const body_parameters& body) {
    return kind == consistency_kind::full ? Eigen::MatrixXd(pseudo_inertia(body))
                                          : Eigen::MatrixXd(spatial_inertia(body));
}

double smallest_eigenvalue(const Eigen::MatrixXd& F) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(F, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// A mass at `centre` whose second moments about it are mass radius^2.
body_parameters ball(double mass, const Eigen::Vector3d& centre, double radius) {
    Eigen::Matrix4d P;
    P << mass * (radius * radius * Eigen::Matrix3d::Identity() + centre * centre.transpose()), mass * centre,
        mass * centre.transpose(), mass;
    return parameters_of_pseudo_inertia(P);
}

bool is_bounded(const interval& range) {
    return std::isfinite(range.low) || std::isfinite(range.high);
}

std::string describe(const interval& range, const std::string& unit) {
    if (!std::isfinite(range.high)) {
        return fmt::format("at least {:g} {}", range.low, unit);
    }
    return std::isfinite(range.low) ? fmt::format("{:g} to {:g} {}", range.low, range.high, unit)
                                    : fmt::format("at most {:g} {}", range.high, unit);
}

void check(const interval& range, const std::string& what, const std::string& unit) {
    if (!(range.low < range.high)) {
        throw input_error({"", 0, what}, fmt::format("{:g}:{:g} {}, expected a lower bound below the upper one",
                                                     range.low, range.high, unit));
    }
}

/// The constraints of one robot, as they are collected.
class collector {
  public:
    collector(const physical_parameters& known, const consistency_request& request, const parameter_scale& scale,
              const std::vector<std::string>& names)
        : known_(known), request_(request), scale_(scale), names_(names) {
        result_.floor = request.floor.value_or(relative_floor * scale.inertial);
        if (!(result_.floor > 0.0)) {
            throw input_error({"", 0, "floor"}, fmt::format("{:g}, expected a positive number", result_.floor));
        }
        result_.start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
    }

    consistency_program collect() {
        for (std::size_t i = 0; i < known_.bodies.size(); ++i) {
            add_matrix(known_.bodies[i]);
            add_bounds(known_.bodies[i], bounds_of(i));
        }
        add_total_mass();
        for (const physical_parameters::lower_bound& coefficient : known_.coefficients) {
            result_.program.bounds.push_back({fmt::format("{} >= {:g}", name(coefficient.place), coefficient.low),
                                              {{coefficient.place, 1.0}},
                                              coefficient.low,
                                              scale_.coefficient});
            result_.start[coefficient.place] = coefficient.low + scale_.coefficient;
        }
        start_inside();
        return std::move(result_);
    }

  private:
    const std::string& name(Eigen::Index place) const { return names_[static_cast<std::size_t>(place)]; }
    body_bounds bounds_of(std::size_t body) const {
        return request_.bodies.empty() ? body_bounds() : request_.bodies[body];
    }

    void add_matrix(const inertial_body& body) {
        matrix_constraint constraint;
        constraint.name = body.name;
        constraint.places.assign(body.places.begin(), body.places.end());
        for (int k = 0; k < 10; ++k) {
            constraint.basis.push_back(matrix_of(request_.kind, body_parameters::Unit(k)));
        }
        constraint.floor = result_.floor;
        constraint.reference = matrix_of(request_.kind, reference_of(body));
        if (const double smallest = smallest_eigenvalue(constraint.reference); !(smallest > result_.floor)) {
            throw input_error(
                {"", 0, "prior"},
                fmt::format("{} is not consistent: the smallest eigenvalue of its {} is {:.3g}, expected more than "
                            "{:.3g}",
                            body.name, request_.kind == consistency_kind::full ? "pseudo-inertia" : "spatial inertia",
                            smallest, result_.floor));
        }
        constraint.prior = request_.prior ? request_.prior_strength : 0.0;
        result_.program.matrices.push_back(std::move(constraint));
    }

    body_parameters reference_of(const inertial_body& body) const {
        const double mass = std::max(scale_.inertial, 4.0 * result_.floor);
        return request_.prior
                   ? body.of(*request_.prior)
                   : ball(mass, Eigen::Vector3d::Zero(), std::max(gyration, std::sqrt(4.0 * result_.floor / mass)));
    }

    void add_bound(const std::string& what, std::vector<linear_constraint::term> terms, double low) {
        if (std::isfinite(low)) {
            result_.program.bounds.push_back({what, std::move(terms), low, 0.0});
        }
    }

    void add_bounds(const inertial_body& body, const body_bounds& bounds) {
        check(bounds.mass, "mass of the " + body.name, "kg");
        const Eigen::Index mass = body.places[9];
        add_bound(fmt::format("mass of the {} >= {:g} kg", body.name, bounds.mass.low), {{mass, 1.0}}, bounds.mass.low);
        add_bound(fmt::format("mass of the {} <= {:g} kg", body.name, bounds.mass.high), {{mass, -1.0}},
                  -bounds.mass.high);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const interval& range = bounds.centre[axis];
            const std::string what = fmt::format("centre of the {} along {}", body.name, "xyz"[axis]);
            check(range, what, "m");
            const Eigen::Index moment = body.places[6 + axis];
            if (std::isfinite(range.low)) {
                add_bound(fmt::format("{} >= {:g} m", what, range.low), {{moment, 1.0}, {mass, -range.low}}, 0.0);
            }
            if (std::isfinite(range.high)) {
                add_bound(fmt::format("{} <= {:g} m", what, range.high), {{moment, -1.0}, {mass, range.high}}, 0.0);
            }
        }
    }

    void add_total_mass() {
        check(request_.total_mass, "total mass", "kg");
        std::vector<linear_constraint::term> sum, minus;
        for (const inertial_body& body : known_.bodies) {
            sum.push_back({body.places[9], 1.0});
            minus.push_back({body.places[9], -1.0});
        }
        add_bound(fmt::format("total mass >= {:g} kg", request_.total_mass.low), sum, request_.total_mass.low);
        add_bound(fmt::format("total mass <= {:g} kg", request_.total_mass.high), minus, -request_.total_mass.high);
    }

    /// Masses between their bounds whose sum is between its own.
    Eigen::VectorXd masses_inside() const {
        const auto n = static_cast<Eigen::Index>(known_.bodies.size());
        Eigen::VectorXd low(n), usual(n), high(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const interval mass = bounds_of(static_cast<std::size_t>(i)).mass;
            low[i] = std::max(mass.low, 2.0 * result_.floor);
            high[i] = std::isfinite(mass.high) ? mass.high
                                               : 10.0 * std::max({scale_.inertial, low[i], request_.total_mass.low});
            if (!(low[i] < high[i])) {
                throw input_error({"", 0, "mass of the " + known_.bodies[static_cast<std::size_t>(i)].name},
                                  fmt::format("{}, expected room above twice the floor of {:g}", describe(mass, "kg"),
                                              result_.floor));
            }
            usual[i] = std::clamp(scale_.inertial, 0.9 * low[i] + 0.1 * high[i], 0.1 * low[i] + 0.9 * high[i]);
        }
        const interval& total = request_.total_mass;
        if (!is_bounded(total)) {
            return usual;
        }
        if (!(low.sum() < total.high) || !(high.sum() > total.low)) {
            throw input_error({"", 0, "total mass"},
                              fmt::format("{}, but the bounds of the masses sum to {:g} to {:g} kg",
                                          describe(total, "kg"), low.sum(), high.sum()));
        }
        const double least = std::max(total.low, low.sum());
        const double most = std::min(total.high, high.sum());
        const double share = (0.5 * (least + most) - low.sum()) / (high.sum() - low.sum());
        return low + share * (high - low);
    }

    /// Beside a centre far out the smallest eigenvalue of a small ball is less than m radius^2.
    body_parameters ball_above_floor(double m, const Eigen::Vector3d& centre, const std::string& name) const {
        constexpr double largest = 1e6;
        double radius = gyration;
        body_parameters body = ball(m, centre, radius);
        while (smallest_eigenvalue(matrix_of(request_.kind, body)) <= result_.floor) {
            radius *= 2.0;
            if (radius > largest) {
                throw input_error({"", 0, "floor"},
                                  fmt::format("{:g}, expected one that the {} can have", result_.floor, name));
            }
            body = ball(m, centre, radius);
        }
        return body;
    }

    /// Balls with these masses, their centres amid their boxes, large enough for the floor.
    void start_inside() {
        const Eigen::VectorXd mass = masses_inside();
        for (std::size_t i = 0; i < known_.bodies.size(); ++i) {
            const body_bounds bounds = bounds_of(i);
            Eigen::Vector3d centre = Eigen::Vector3d::Zero();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const interval& range = bounds.centre[axis];
                const double low = std::isfinite(range.low) ? range.low : std::min(0.0, range.high) - 1.0;
                const double high = std::isfinite(range.high) ? range.high : std::max(0.0, range.low) + 1.0;
                centre[static_cast<Eigen::Index>(axis)] = 0.5 * (low + high);
            }
            const double m = mass[static_cast<Eigen::Index>(i)];
            const body_parameters body = ball_above_floor(m, centre, known_.bodies[i].name);
            result_.start(known_.bodies[i].places) = body;
            matrix_constraint& constraint = result_.program.matrices[i];
            const double needed = constraint.reference.llt().solve(matrix_of(request_.kind, body)).trace() /
                                  static_cast<double>(constraint.reference.rows());
            constraint.size = std::max(size_limit, 10.0 * needed);
        }
    }

    const physical_parameters& known_;
    const consistency_request& request_;
    const parameter_scale& scale_;
    const std::vector<std::string>& names_;
    consistency_program result_;
};

}  // namespace

consistency_program constrain(const physical_parameters& known, const consistency_request& request,
                              const parameter_scale& scale, const std::vector<std::string>& names) {
    return collector(known, request, scale, names).collect();
}

}  // namespace idim
