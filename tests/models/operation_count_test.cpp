// Operations of the rigid models, counted as the literature counts them (generator/graph/operation_count.hpp). The
// bounds are what the generator reached: fewer is progress (lower them), more is a regression.
#include <gtest/gtest.h>

#include <ostream>

#include "generator.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

using generator::operation_count;

struct bound {
    int mul, add, div;
};

struct bounds {
    bound inverse_dynamics, regressor, mass_matrix, forward_dynamics;
};

struct expected_counts {
    const char* robot;
    bounds reached;
    bounds study;  ///< of a study measured side by side with a published generator, which needs more in every case
};

std::ostream& operator<<(std::ostream& stream, const expected_counts& counts) {
    return stream << counts.robot;
}

const expected_counts counts_of_robots[] = {
    {"scara", {{15, 9, 0}, {14, 8, 0}, {3, 3, 0}, {17, 11, 1}}, {{19, 11, 0}, {14, 8, 0}, {4, 3, 0}, {22, 12, 2}}},
    {"denso_vp6242g",
     {{233, 207, 0}, {381, 282, 0}, {119, 106, 0}, {384, 309, 5}},
     {{257, 238, 0}, {395, 298, 0}, {140, 122, 0}, {476, 410, 6}}},
    {"puma560",
     {{230, 204, 0}, {386, 287, 0}, {126, 112, 0}, {392, 316, 5}},
     {{259, 240, 0}, {394, 297, 0}, {154, 132, 0}, {490, 420, 6}}},
    {"rx90",
     {{222, 196, 0}, {351, 256, 0}, {109, 95, 0}, {364, 288, 5}},
     {{247, 228, 0}, {367, 272, 0}, {129, 109, 0}, {455, 387, 6}}},
    {"stanford",
     {{208, 194, 0}, {333, 243, 0}, {93, 87, 0}, {334, 269, 5}},
     {{228, 209, 0}, {340, 249, 0}, {105, 90, 0}, {408, 347, 6}}},
    {"kuka_lwr",
     {{270, 250, 0}, {620, 434, 0}, {165, 136, 0}, {521, 411, 6}},
     {{297, 275, 0}, {644, 460, 0}, {178, 144, 0}, {595, 505, 7}}},
};

class OperationCount : public testing::TestWithParam<expected_counts> {
  protected:
    static generator::operation_table rigid() {
        return generator::generate(robot_file(GetParam().robot), templates_folder).rigid_operations;
    }
};

void expect_within(const operation_count& found, const bound& most, const char* model) {
    EXPECT_LE(found.mul, most.mul) << model;
    EXPECT_LE(found.add, most.add) << model;
    EXPECT_LE(found.div, most.div) << model;
}

TEST_P(OperationCount, IsNoneAboveWhatWasReached) {
    const generator::operation_table found = rigid();
    const bounds& most = GetParam().reached;
    expect_within(found.inverse_dynamics, most.inverse_dynamics, "inverse dynamics");
    expect_within(found.regressor, most.regressor, "regressor");
    expect_within(found.mass_matrix, most.mass_matrix, "mass matrix");
    expect_within(found.forward_dynamics, most.forward_dynamics, "forward dynamics");
}

TEST_P(OperationCount, SumsToNoMoreThanThatOfTheStudy) {
    const auto total = [](const auto& c) { return c.mul + c.add + c.div; };
    const generator::operation_table found = rigid();
    const bounds& study = GetParam().study;
    EXPECT_LE(total(found.inverse_dynamics), total(study.inverse_dynamics));
    EXPECT_LE(total(found.regressor), total(study.regressor));
    EXPECT_LE(total(found.mass_matrix), total(study.mass_matrix));
    EXPECT_LE(total(found.forward_dynamics), total(study.forward_dynamics));
}

INSTANTIATE_TEST_SUITE_P(Robots, OperationCount, testing::ValuesIn(counts_of_robots),
                         [](const testing::TestParamInfo<expected_counts>& counts) {
                             return std::string(counts.param.robot);
                         });

}  // namespace

}  // namespace idim::test
