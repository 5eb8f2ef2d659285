// Frames laid on a URDF cost no more operations than the tables of robots/, from which the URDF is written.
#include <gtest/gtest.h>

#include <random>

#include "description/robot_description.hpp"
#include "generator.hpp"
#include "support/robot_files.hpp"
#include "support/urdf_text.hpp"

namespace idim::test {

namespace {

class UrdfOperationCount : public testing::TestWithParam<const char*> {};

int total(const generator::operation_count& count) {
    return count.mul + count.add + count.div;
}

TEST_P(UrdfOperationCount, IsNotAboveThatOfTheTable) {
    const generator::robot_description robot = generator::read_robot(robot_file(GetParam()));
    const mdh_table table = mdh_table_of(robot);
    std::mt19937_64 random(71);
    const temporary_folder folder;
    folder.write("robot.urdf", urdf_of(table, plausible_links(static_cast<int>(table.rows.size()), random)));
    const std::string file = folder.write(
        "robot.yaml",
        fmt::format("urdf: robot.urdf\ngravity: [{}, {}, {}]\n", table.gravity[0], table.gravity[1], table.gravity[2]));
    const generator::operation_table laid = generator::generate(file, templates_folder).rigid_operations;
    const generator::operation_table written =
        generator::generate(robot_file(GetParam()), templates_folder).rigid_operations;
    EXPECT_LE(total(laid.inverse_dynamics), total(written.inverse_dynamics));
    EXPECT_LE(total(laid.regressor), total(written.regressor));
    EXPECT_LE(total(laid.mass_matrix), total(written.mass_matrix));
    EXPECT_LE(total(laid.forward_dynamics), total(written.forward_dynamics));
}

INSTANTIATE_TEST_SUITE_P(Robots, UrdfOperationCount,
                         testing::Values("scara", "emps", "puma560", "rx90", "stanford", "tx40", "denso_vp6242g",
                                         "panda", "kuka_lwr"),
                         [](const testing::TestParamInfo<const char*>& robot) { return std::string(robot.param); });

}  // namespace

}  // namespace idim::test
