#include "description/inertial_parameters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>
#include <stdexcept>

#include "support/urdf_text.hpp"

namespace idim::generator {

namespace {

using test::draw;
using test::draw_triple;
using test::rotation_of;

link_placement random_placement(std::mt19937_64& random) {
    const Eigen::Matrix3d R = rotation_of(draw_triple(3.0, random));
    link_placement placement;
    placement.position = draw_triple(0.5, random);
    placement.rpy = draw_triple(3.0, random);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            placement.rotation[i][j] = R(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
    }
    return placement;
}

Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}

/// Eight point masses at the corners of a box, seen from any frame.
struct point_masses {
    std::array<double, 8> mass;
    std::array<Eigen::Vector3d, 8> at;

    explicit point_masses(std::mt19937_64& random) {
        for (std::size_t i = 0; i < 8; ++i) {
            mass[i] = 1.0 + draw(0.9, random);
            at[i] = vector_of(draw_triple(0.3, random));
        }
    }

    double total() const { return std::accumulate(mass.begin(), mass.end(), 0.0); }

    Eigen::Vector3d moments() const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < 8; ++i) {
            sum += mass[i] * at[i];
        }
        return sum;
    }

    Eigen::Matrix3d inertia() const {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < 8; ++i) {
            sum += mass[i] * (at[i].squaredNorm() * Eigen::Matrix3d::Identity() - at[i] * at[i].transpose());
        }
        return sum;
    }

    point_masses seen_from(const Eigen::Matrix3d& R, const Eigen::Vector3d& p) const {
        point_masses result = *this;
        for (Eigen::Vector3d& x : result.at) {
            x = R * x + p;
        }
        return result;
    }
};

}  // namespace

TEST(InertialParameters, AreThoseOfPointMassesSeenFromOurFrame) {
    std::mt19937_64 random(51);
    for (int k = 0; k < 50; ++k) {
        const link_placement placement = random_placement(random);
        const point_masses in_link(random);
        const Eigen::Vector3d centre = in_link.moments() / in_link.total();
        const Eigen::Matrix3d axes = rotation_of(placement.rpy);
        const Eigen::Matrix3d I = in_link.seen_from(axes.transpose(), -axes.transpose() * centre).inertia();
        const urdf_inertial inertial = {in_link.total(),
                                        {centre[0], centre[1], centre[2]},
                                        placement.rpy,
                                        {I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)}};
        Eigen::Matrix3d R;
        for (Eigen::Index i = 0; i < 3; ++i) {
            R.row(i) = vector_of(placement.rotation[static_cast<std::size_t>(i)]).transpose();
        }
        const point_masses ours = in_link.seen_from(R, vector_of(placement.position));
        const inertial_parameters found = parameters_of(inertial, placement);
        const Eigen::Matrix3d J = ours.inertia();
        const double expected[10] = {J(0, 0), J(0, 1),           J(0, 2),           J(1, 1),           J(1, 2),
                                     J(2, 2), ours.moments()[0], ours.moments()[1], ours.moments()[2], ours.total()};
        for (std::size_t i = 0; i < 10; ++i) {
            EXPECT_NEAR(found[i], expected[i], 1e-13 * in_link.total()) << i;  // rounding of the sums over the masses
        }
    }
}

TEST(InertialParameters, ReturnToTheUrdfTheyCameFrom) {
    std::mt19937_64 random(52);
    for (int k = 0; k < 50; ++k) {
        const link_placement placement = random_placement(random);
        const urdf_inertial inertial = {0.1 + std::abs(draw(8.0, random)),
                                        draw_triple(0.2, random),
                                        placement.rpy,
                                        {0.05, draw(0.01, random), draw(0.01, random), 0.06, draw(0.01, random), 0.07}};
        const urdf_inertial back = inertial_of(parameters_of(inertial, placement), placement);
        EXPECT_EQ(back.mass, inertial.mass);
        EXPECT_EQ(back.rpy, inertial.rpy);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(back.xyz[i], inertial.xyz[i], 1e-12);
        }
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_NEAR(back.inertia[i], inertial.inertia[i], 1e-12);
        }
    }
}

TEST(InertialParameters, OfALinkWithoutMassKeepTheInertia) {
    std::mt19937_64 random(53);
    const link_placement placement = random_placement(random);
    const urdf_inertial inertial = {0.0, {0.0, 0.0, 0.0}, placement.rpy, {0.05, 0.01, 0.02, 0.06, 0.003, 0.07}};
    const urdf_inertial back = inertial_of(parameters_of(inertial, placement), placement);
    EXPECT_EQ(back.xyz, inertial.xyz);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(back.inertia[i], inertial.inertia[i], 1e-15);
    }
    EXPECT_THROW(inertial_of({0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, placement), std::invalid_argument);
}

}  // namespace idim::generator
