#include "idim/motion_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace idim {
namespace {

filtered_samples constant(double q, double qd, double qdd) {
    filtered_samples samples;
    samples.t = Eigen::VectorXd::LinSpaced(11, 0.0, 10.0);
    samples.q = Eigen::MatrixXd::Constant(11, 1, q);
    samples.qd = Eigen::MatrixXd::Constant(11, 1, qd);
    samples.qdd = Eigen::MatrixXd::Constant(11, 1, qdd);
    return samples;
}

TEST(MotionDistance, IsRelativeToTheSecondMotion) {
    const motion_distance d = distances({constant(1.1, 4.0, 0.0)}, {constant(1.0, 2.0, 0.0)}, 0.0).front();
    EXPECT_NEAR(d.q, 0.1, 1e-12);
    EXPECT_NEAR(d.qd, 1.0, 1e-12);
    EXPECT_EQ(d.qdd, 0.0);
}

TEST(MotionDistance, LeavesOutTheStart) {
    filtered_samples moved = constant(1.0, 1.0, 1.0);
    moved.q.topRows(3).setConstant(100.0);  // 0, 1 and 2 s
    EXPECT_EQ(distances({moved}, {constant(1.0, 1.0, 1.0)}, 3.0).front().q, 0.0);
    EXPECT_GT(distances({moved}, {constant(1.0, 1.0, 1.0)}, 2.0).front().q, 1.0);
}

}  // namespace
}  // namespace idim
