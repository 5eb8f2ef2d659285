#include "comparison/model_difference.hpp"

#include <gtest/gtest.h>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

using name_list = std::vector<std::string>;

/// A planar arm of two links whose second has a rotor: chi = (ZZ1 + 0.25 M2, ZZ2 + Ia2, Fv1).
model_summary two_links() {
    model_summary model;
    model.content.robot = "arm";
    model.content.gravity = {"0", "0", "0"};
    model.content.constants = {{"L", 0.5}};
    model.content.joints = {{"j1", "revolute", "base", true, {{"theta", "q"}}, {}, {}, {}, {}},
                            {"j2", "revolute", "j1", true, {{"d", "L"}, {"theta", "q"}}, {}, {}, {}, {}}};
    model.content.effects = {{"rotor_inertia", {"j2"}, {}, {}, "Ia*qdd"},
                             {"viscous_friction", {"j1"}, {}, {}, "Fv*qd"}};
    model.content.operations = {{"regressor", {3, 2, 0, 2}}};
    model.standard = {"ZZ1", "Fv1", "ZZ2", "M2", "Ia2"};
    model.base = {{{"ZZ1R", "kg*m^2", "ZZ1 + L^2*M2"}, "ZZ1", {1.0, 0.0, 0.0, 0.25, 0.0}},
                  {{"ZZ2R", "kg*m^2", "ZZ2 + Ia2"}, "ZZ2", {0.0, 0.0, 1.0, 0.0, 1.0}},
                  {{"Fv1", "N*m*s/rad", "Fv1"}, "Fv1", {0.0, 1.0, 0.0, 0.0, 0.0}}};
    return model;
}

name_list texts(const std::vector<entry_change>& changes) {
    name_list result;
    for (const entry_change& change : changes) {
        result.push_back(change.what + "|" + change.field + "|" + change.before + "|" + change.after);
    }
    return result;
}

}  // namespace

TEST(ModelDifference, OfAModelWithItselfIsEmpty) {
    const model_difference difference = compare(two_links(), two_links());
    EXPECT_TRUE(difference.empty());
    EXPECT_EQ(difference.operations.size(), 1u);
}

TEST(ModelDifference, NamesTheCoefficientsThatAConstantChanges) {
    model_summary after = two_links();
    after.content.constants = {{"L", 0.6}, {"k", 2.0}};
    after.base[0].coefficients[3] = 0.36;
    const model_difference difference = compare(two_links(), after);
    EXPECT_FALSE(difference.empty());
    EXPECT_EQ(texts(difference.constants), (name_list{"L||0.5|0.6", "k|||2"}));
    ASSERT_EQ(difference.regrouped.size(), 1u);
    EXPECT_EQ(difference.regrouped[0].before.regroups, difference.regrouped[0].after.regroups);
    ASSERT_EQ(difference.regrouped[0].coefficients.size(), 1u);
    EXPECT_EQ(difference.regrouped[0].coefficients[0].standard, "M2");
    EXPECT_EQ(difference.regrouped[0].coefficients[0].before, 0.25);
    EXPECT_EQ(difference.regrouped[0].coefficients[0].after, 0.36);
}

TEST(ModelDifference, LoopsAreToldApartByTheJointsTheyDetermine) {
    const manifest_loop loop = {{{{"j2", {"L", "0", "0"}}, {"base", {"1", "0", "0"}}}}, {"j1", "j2"}, "1"};
    model_summary before = two_links();
    before.content.loops = {loop};
    EXPECT_EQ(texts(compare(before, two_links()).loops),
              (name_list{"j1, j2|assembly|1|", "j1, j2|cut|j2 [L, 0, 0]|", "j1, j2|cut, other side|base [1, 0, 0]|"}));
    model_summary after = before;
    after.content.loops[0].assembly = "-1";
    after.content.loops[0].cut[1].at[1] = "0.2";
    const model_difference difference = compare(before, after);
    EXPECT_FALSE(difference.empty());
    EXPECT_EQ(texts(difference.loops),
              (name_list{"j1, j2|assembly|1|-1", "j1, j2|cut, other side|base [1, 0, 0]|base [1, 0.2, 0]"}));
}

TEST(ModelDifference, RoundingOfACoefficientIsNoChange) {
    model_summary after = two_links();
    after.base[0].coefficients[3] = 0.25 * (1.0 + 4e-16);
    EXPECT_TRUE(compare(two_links(), after).empty());
}

TEST(ModelDifference, AnEffectThatGoesTakesItsParameterAndLeavesTheRest) {
    model_summary after = two_links();
    after.content.effects.erase(after.content.effects.begin());
    after.standard.pop_back();
    for (base_parameter_summary& base : after.base) {
        base.coefficients.pop_back();
    }
    after.base[1].parameter = {"ZZ2", "kg*m^2", "ZZ2"};
    const model_difference difference = compare(two_links(), after);
    ASSERT_EQ(difference.effects_removed.size(), 1u);
    EXPECT_EQ(difference.effects_removed[0].effect, "rotor_inertia");
    EXPECT_EQ(difference.standard_dropped, name_list{"Ia2"});
    EXPECT_TRUE(difference.base_added.empty() && difference.base_dropped.empty()) << "ZZ2R and ZZ2 both keep ZZ2";
    ASSERT_EQ(difference.regrouped.size(), 1u);
    EXPECT_EQ(difference.regrouped[0].before.name, "ZZ2R");
    EXPECT_EQ(difference.regrouped[0].after.name, "ZZ2");
    EXPECT_EQ(difference.regrouped[0].coefficients[0].standard, "Ia2");
    EXPECT_EQ(difference.regrouped[0].coefficients[0].after, 0.0);
}

TEST(ModelDifference, ColumnsThatMakeRoomMoveTogether) {
    model_summary after = two_links();
    after.content.effects.push_back({"torque_offset", {"j1"}, {}, {}, "off"});
    after.standard.insert(after.standard.begin() + 1, "off1");
    for (base_parameter_summary& base : after.base) {
        base.coefficients.insert(base.coefficients.begin() + 1, 0.0);
    }
    after.base.insert(after.base.begin() + 1, {{"off1", "N*m", "off1"}, "off1", {0.0, 1.0, 0.0, 0.0, 0.0, 0.0}});
    const model_difference difference = compare(two_links(), after);
    EXPECT_EQ(difference.standard_added, name_list{"off1"});
    ASSERT_EQ(difference.base_added.size(), 1u);
    EXPECT_EQ(difference.base_added[0].name, "off1");
    EXPECT_TRUE(difference.regrouped.empty());
    ASSERT_EQ(difference.columns.size(), 1u);
    EXPECT_EQ(difference.columns[0].first, "ZZ2R");
    EXPECT_EQ(difference.columns[0].last, "Fv1");
    EXPECT_EQ(difference.columns[0].before, 1);
    EXPECT_EQ(difference.columns[0].after, 2);
    EXPECT_EQ(difference.columns[0].columns, 2);
}

TEST(ModelDifference, ColumnsThatChangePlacesMoveApart) {
    model_summary after = two_links();
    std::swap(after.base[0], after.base[1]);
    const model_difference difference = compare(two_links(), after);
    ASSERT_EQ(difference.columns.size(), 2u);
    EXPECT_EQ(difference.columns[0].first, "ZZ2R");
    EXPECT_EQ(difference.columns[0].before, 1);
    EXPECT_EQ(difference.columns[1].last, "ZZ1R");
}

TEST(ModelDifference, AnEffectIsNewOnlyWhereItDidNotAct) {
    model_summary before = two_links();
    model_summary after = two_links();
    before.content.effects = {{"coupling", {"j1"}, {"j2"}, {{"k", 1.0}}, "F*qd_from"}};
    after.content.effects = {{"coupling", {"j1", "j2"}, {"j2", "j1"}, {{"k", 1.5}}, "F*qd_from"}};
    const model_difference difference = compare(before, after);
    EXPECT_TRUE(difference.effects_removed.empty());
    ASSERT_EQ(difference.effects_added.size(), 1u);
    EXPECT_EQ(difference.effects_added[0].joints, name_list{"j2"});
    EXPECT_EQ(difference.effects_added[0].from, name_list{"j1"});
    EXPECT_EQ(texts(difference.effects_changed), name_list{"coupling at j1 from j2|shape k|1|1.5"});
}

TEST(ModelDifference, NamesTheEntriesOfAJointThatChanged) {
    model_summary after = two_links();
    after.content.joints[1].row = {{"alpha", "pi/2"}, {"d", "L"}, {"theta", "q"}};
    after.content.joints[1].position = {-1.0, 2.0};
    after.content.joints.push_back({"tool", "fixed", "j2", false, {}, {}, {}, {}, {}});
    after.content.gravity = {"0", "0", "-9.81"};
    const model_difference difference = compare(two_links(), after);
    EXPECT_EQ(texts(difference.joints), (name_list{"j2|alpha|0|pi/2", "j2|position limits||[-1, 2]", "tool|||fixed"}));
    EXPECT_EQ(texts(difference.gravity), name_list{"gravity||[0, 0, 0]|[0, 0, -9.81]"});
    EXPECT_EQ(difference.not_comparable, std::nullopt) << "a fixed joint moves no torque to another place";
}

TEST(ModelDifference, TorquesOfOtherJointsAreNotComparable) {
    const auto reason = [](const model_summary& after) {
        return compare(two_links(), after).not_comparable.value_or("comparable");
    };
    model_summary more = two_links();
    more.content.joints.push_back({"j3", "revolute", "j2", true, {}, {}, {}, {}, {}});
    EXPECT_EQ(reason(more), "2 driven joints before, 3 after");
    model_summary renamed = two_links();
    renamed.content.joints[1].name = "elbow";
    EXPECT_EQ(reason(renamed), "the driven joints were j1, j2, are j1, elbow");
    model_summary prismatic = two_links();
    prismatic.content.joints[1].type = "prismatic";
    EXPECT_EQ(reason(prismatic), "joint j2 was revolute, is prismatic");
}

TEST(ModelDifference, OperationsAreComparedFunctionByFunction) {
    model_summary after = two_links();
    after.content.operations = {{"regressor", {2, 2, 0, 2}}, {"gravity", {1, 0, 0, 0}}};
    const model_difference difference = compare(two_links(), after);
    EXPECT_FALSE(difference.empty());
    ASSERT_EQ(difference.operations.size(), 2u);
    EXPECT_EQ(difference.operations[0].before.mul, 3);
    EXPECT_EQ(difference.operations[0].after.mul, 2);
    EXPECT_TRUE(difference.operations[0].in_both);
    EXPECT_FALSE(difference.operations[1].in_both);
}

namespace {

const char* const joint_list[] = {"j1"};
const char* const base_list[] = {"ZZ1R", "M_tipR"};
const char* const unit_list[] = {"kg*m^2", "kg"};
const char* const formula_list[] = {"ZZ1 + 2*Ia1", "M_tipR"};
const char* const standard_list[] = {"ZZ1", "Ia1", "M_tipR"};

idim_model_interface small_interface() {
    idim_model_interface model{};
    model.dof = 1;
    model.n_base = 2;
    model.n_standard = 3;
    model.joint_names = joint_list;
    model.parameter_names = base_list;
    model.parameter_units = unit_list;
    model.regroupings = formula_list;
    model.standard_names = standard_list;
    model.regroup = [](const double* standard, double* chi) {
        chi[0] = standard[0] + 2.0 * standard[1];
        chi[1] = standard[2];
    };
    return model;
}

}  // namespace

TEST(ModelSummary, KeepsWhatIsRegroupedByNumbers) {
    manifest content;
    content.joints = {{"j1", "revolute", "base", true, {}, {}, {}, {}, {}},
                      {"tipR", "fixed", "j1", false, {}, {}, {}, {}, {}}};
    const model_summary summary = summarise(content, small_interface(), "folder");
    ASSERT_EQ(summary.base.size(), 2u);
    EXPECT_EQ(summary.base[0].kept, "ZZ1");
    EXPECT_EQ(summary.base[1].kept, "M_tipR") << "an R of the joint's own name stays";
    EXPECT_EQ(summary.base[0].coefficients, (std::vector<double>{1.0, 2.0, 0.0}));
    EXPECT_EQ(summary.base[1].coefficients, (std::vector<double>{0.0, 0.0, 1.0}));
}

TEST(ModelSummary, CodeOfAnotherRobotThanTheManifestIsRefused) {
    manifest content;
    content.joints = {{"elbow", "revolute", "base", true, {}, {}, {}, {}, {}}};
    EXPECT_THROW(summarise(content, small_interface(), "folder"), input_error);
}

}  // namespace idim::generator
