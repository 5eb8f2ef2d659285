// Geometry in numbers that no fraction is: pi, roots, sines of angles.
#include <gtest/gtest.h>

#include "generator.hpp"
#include "support/robot_files.hpp"

namespace idim::generator {

namespace {

/// Base parameters of a revolute-revolute-prismatic arm with some entries replaced.
struct arm {
    std::string theta1 = "q", alpha2 = "pi/2", d2 = "0.3", r2 = "0.2", r3 = "q", gravity = "[0, 0, -9.81]";

    base_report base() const {
        const test::temporary_folder folder;
        return find_base(
            folder.write("arm.yaml", "name: arm\ngravity: " + gravity +
                                         "\nconstants: {L: 0.5, a: 0.7}\njoints:\n  - {name: j1, theta: \"" + theta1 +
                                         "\"}\n  - {name: j2, alpha: \"" + alpha2 + "\", d: \"" + d2 + "\", r: \"" +
                                         r2 + "\", theta: q}\n  - {name: j3, type: prismatic, alpha: pi/2, r: \"" + r3 +
                                         "\"}\n"),
            test::templates_folder);
    }

    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const parameter_context& parameter : base().parameters) {
            result.push_back(parameter.name);
        }
        return result;
    }
};

}  // namespace

TEST(IrrationalGeometry, LengthsDoNotChangeWhatIsIdentifiable) {
    const std::vector<std::string> expected = arm().names();
    for (const char* length : {"sqrt(2)", "pi", "L*sqrt(2)", "pi/4", "L*cos(pi/5)", "L*sin(a)", "0.5*cos(0.3)",
                               "exp(1)", "L^0.5", "tan(a)", "atan(1)", "L/3", "1/(L + 1)", "L*a"}) {
        arm in_d, in_r;
        in_d.d2 = length;
        in_r.r2 = length;
        EXPECT_EQ(in_d.names(), expected) << "d: " << length;
        EXPECT_EQ(in_r.names(), expected) << "r: " << length;
    }
}

TEST(IrrationalGeometry, NorDoZeroPositionsAndRatesOfJoints) {
    const std::vector<std::string> expected = arm().names();
    for (const char* theta : {"q + pi/6", "q + a", "q + sqrt(2)", "pi*q", "q/3 + pi/7", "-q", "sqrt(2)*q"}) {
        arm turned;
        turned.theta1 = theta;
        EXPECT_EQ(turned.names(), expected) << theta;
    }
    for (const char* r : {"q + pi/6", "q + L*sin(a)", "-q", "q*pi", "q*sqrt(2) + L*pi"}) {
        arm moved;
        moved.r3 = r;
        EXPECT_EQ(moved.names(), expected) << r;
    }
}

TEST(IrrationalGeometry, GravityMayBeGivenByAnAngle) {
    arm tilted, in_numbers;
    tilted.gravity = "[9.81*sin(pi/7), 0, -9.81*cos(pi/7)]";
    in_numbers.gravity = "[4.3, 0, -8.8]";
    EXPECT_EQ(tilted.names(), in_numbers.names());
    EXPECT_GT(tilted.names().size(), arm().names().size());  // link 1 now has moments about its axis
}

}  // namespace idim::generator
