// Commands on .urdf files: notes on standard error, results as for any robot, nothing from the libraries.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/command.hpp"
#include "support/robot_files.hpp"
#include "support/urdf_text.hpp"

namespace idim::test {

namespace {

/// Two joints; the second is turned by 1.5708.
std::string two_joint_urdf() {
    std::mt19937_64 random(81);
    const std::vector<rigid_link> bodies = plausible_links(2, random);
    urdf_text urdf("two-joints");
    urdf.massless_link("l0").link("l1", bodies[0]).link("l2", bodies[1]);
    urdf.joint("j1", "continuous", "l0", "l1").joint("j2", "continuous", "l1", "l2", {{0.1, 0, 0}, {1.5708, 0, 0}});
    return urdf.text();
}

}  // namespace

TEST(UrdfCommand, BaseOfAUrdfPrintsItsParametersAndNotesWhatWasReadOtherwise) {
    const temporary_folder folder;
    const std::string file = folder.write("arm.urdf", two_joint_urdf());
    const command_result result = run_idim({"base", file});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out.rfind("two_joints: ", 0), 0u) << result.out;
    EXPECT_NE(result.out.find("  Fv2 [N*m*s/rad]"), std::string::npos) << result.out;
    const std::string note = "idim: " + file + ": note: ";
    EXPECT_EQ(result.err, note + "angles read as multiples of pi/2: 1.5708 as pi/2 (line 26)\n" + note +
                              "names read as identifiers: \"two-joints\" as two_joints\n");
}

TEST(UrdfCommand, GenerateOfAUrdfIsThatOfAYamlWhichNamesItButForTheFilesName) {
    const temporary_folder folder;
    const std::string bare = folder.write("arm.urdf", two_joint_urdf());
    const std::string named = folder.write(
        "yaml/arm.yaml", "urdf: ../arm.urdf\neffects: [rotor_inertia, viscous_friction, coulomb_friction]\n");
    const std::string first = (folder.path() / "first").string();
    const std::string second = (folder.path() / "second").string();
    EXPECT_EQ(run_idim({"generate", bare, "-o", first}).status, 0);
    EXPECT_EQ(run_idim({"generate", named, "-o", second}).status, 0);
    std::string text = read_text(first + "/regressor.hpp");
    text.replace(text.find("arm.urdf"), 8, "arm.yaml");
    EXPECT_EQ(text, read_text(second + "/regressor.hpp"));
}

TEST(UrdfCommand, BadUrdfIsBadInputInOneLineAndNothingIsWritten) {
    const temporary_folder folder;
    std::string text = two_joint_urdf();
    text.replace(text.find("value=\""), 7, "value=\"x");
    const std::string file = folder.write("arm.urdf", text);
    const std::filesystem::path out = folder.path() / "model";
    const command_result result = run_idim({"generate", file, "-o", out.string()});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.err.rfind("idim: " + file + ":3: link \"l1\": not URDF: ", 0), 0u) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(UrdfCommand, ValidateOfAUrdfReadsLogsOfItsJoints) {
    const temporary_folder folder;
    std::mt19937_64 random(82);
    urdf_text urdf("slide");
    urdf.massless_link("a").link("b", plausible_links(1, random).front());
    urdf.joint("x", "prismatic", "a", "b", {}, {1.0, 0.0, 0.0});
    const std::string robot = folder.write("slide.urdf", urdf.text());
    std::string log = "t,q_x,tau1\n";
    for (int k = 0; k < 2000; ++k) {
        const double t = 0.005 * k;
        // M qdd + Fv qd along q = sin(2 t), with Ia + M = 3 kg and Fv = 5 N s/m.
        log += fmt::format("{},{},{}\n", t, std::sin(2 * t), -12.0 * std::sin(2 * t) + 10.0 * std::cos(2 * t));
    }
    const std::string parameters = folder.write("parameters.yaml", "M1R: 3\nFv1: 5\nFc1: 0\n");
    const command_result result = run_idim({"validate", robot, parameters, folder.write("log.csv", log), "--cutoff",
                                            "20", "--decimation", "5", "--json", "-"});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t at = result.out.find("\"relative_error\": ");
    ASSERT_NE(at, std::string::npos) << result.out;
    EXPECT_LT(std::stod(result.out.substr(at + 18)), 1e-3);  // the filter's error at the ends of the log
}

}  // namespace idim::test
