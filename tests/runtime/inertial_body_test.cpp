#include "idim/inertial_body.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace idim {
namespace {

/// Point masses: their sums are the definition of all of these.
struct point_masses {
    explicit point_masses(std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        for (int k = 0; k < 6; ++k) {
            mass[k] = std::abs(normal(random));
            place.col(k) << normal(random), normal(random), normal(random);
        }
    }
    body_parameters parameters() const {
        body_parameters body = body_parameters::Zero();
        for (int k = 0; k < 6; ++k) {
            const Eigen::Vector3d r = place.col(k);
            const double x = r.x(), y = r.y(), z = r.z();
            body_parameters one;
            one << y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y, x, y, z, 1.0;
            body += mass[k] * one;
        }
        return body;
    }

    Eigen::Matrix<double, 6, 1> mass;
    Eigen::Matrix<double, 3, 6> place;
};

TEST(InertialBody, PseudoInertiaIsTheSecondMomentOfHomogeneousPlaces) {
    const point_masses body(1);
    Eigen::Matrix4d expected = Eigen::Matrix4d::Zero();
    for (int k = 0; k < 6; ++k) {
        Eigen::Vector4d p;
        p << body.place.col(k), 1.0;
        expected += body.mass[k] * p * p.transpose();
    }
    EXPECT_LT((pseudo_inertia(body.parameters()) - expected).norm(), 1e-13);
    EXPECT_LT((parameters_of_pseudo_inertia(expected) - body.parameters()).norm(), 1e-13);
}

TEST(InertialBody, SpatialInertiaGivesTheKineticEnergy) {
    const point_masses body(2);
    const Eigen::Vector3d w(0.3, -1.0, 0.7), v(1.1, 0.2, -0.4);
    double energy = 0.0;
    for (int k = 0; k < 6; ++k) {
        energy += body.mass[k] * (v + w.cross(Eigen::Vector3d(body.place.col(k)))).squaredNorm();
    }
    Eigen::Matrix<double, 6, 1> twist;
    twist << w, v;
    EXPECT_NEAR(twist.dot(spatial_inertia(body.parameters()) * twist), energy, 1e-13 * energy);
}

TEST(InertialBody, CentralInertiaIsThatOfTheMassesFromTheirCentre) {
    point_masses body(3);
    const Eigen::Matrix3d actual = central_inertia(body.parameters());
    body.place.colwise() -= Eigen::Vector3d(body.place * body.mass / body.mass.sum());
    const body_parameters moved = body.parameters();
    EXPECT_NEAR(actual(0, 0), moved[0], 1e-13);
    EXPECT_NEAR(actual(0, 1), moved[1], 1e-13);
    EXPECT_NEAR(actual(2, 1), moved[4], 1e-13);
    EXPECT_NEAR(actual(2, 2), moved[5], 1e-13);
}

/// Central moments 1, 1, 3: a triangle that does not close, so that no density has them.
TEST(InertialBody, TriangleInequalityIsSeenByThePseudoInertiaAlone) {
    body_parameters body;
    body << 1.0, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 2.0;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(spatial_inertia(body)).eigenvalues()[0], 0.0);
    EXPECT_NEAR(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(pseudo_inertia(body)).eigenvalues()[0], -0.5, 1e-14);
}

}  // namespace
}  // namespace idim
