// idim diff: what it reports of two models, in numbers that can be known beforehand.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

using nlohmann::json;

class DiffCommand : public testing::Test {
  protected:
    /// The scara with one change; its own effect stands beside it.
    std::string variant(const std::string& from, const std::string& to) const {
        folder_.write("variant/direct_drive_rotor.yaml",
                      read_text(source_folder + "/robots/scara/direct_drive_rotor.yaml"));
        return folder_.write("variant/scara.yaml", replaced(read_text(robot_file("scara")), from, to));
    }
    /// A folder of generated code with one change in one file.
    std::string edited(const std::string& file, const std::string& from, const std::string& to) const {
        const std::string path = (folder_.path() / "model").string();
        EXPECT_EQ(run_idim({"generate", robot_file("scara"), "-o", path}).status, 0);
        folder_.write("model/" + file, replaced(read_text(path + "/" + file), from, to));
        return path;
    }
    static json compared(const std::string& before, const std::string& after) {
        const command_result result = run_idim({"diff", before, after, "--json", "-"});
        EXPECT_EQ(result.status, 0) << result.err;
        return json::parse(result.out);
    }

    const std::string scara_ = robot_file("scara");
    const std::string generated_ = source_folder + "/generated/scara";
    temporary_folder folder_;
};

std::vector<std::string> names(const json& list) {
    std::vector<std::string> result;
    for (const json& entry : list) {
        result.push_back(entry["name"]);
    }
    return result;
}

using name_list = std::vector<std::string>;

TEST_F(DiffCommand, AFolderAndItsDescriptionAreTheSame) {
    const json found = compared(generated_, scara_);
    EXPECT_EQ(found["same"], true);
    EXPECT_EQ(found["torque"]["verdict"], "same");
    EXPECT_EQ(found["torque"]["absolute"]["difference"], 0.0);
    EXPECT_EQ(run_idim({"diff", generated_, scara_, "--exit-code"}).status, 0);
}

TEST_F(DiffCommand, ALengthChangesTheTorqueAndTheRegrouping) {
    const std::string longer = variant("L: 0.5", "L: 0.6");
    const json found = compared(scara_, longer);
    EXPECT_EQ(found["same"], false);
    EXPECT_EQ(found["torque"]["verdict"], "different");
    EXPECT_EQ(found["constants"], (json{{{"constant", "L"}, {"old", "0.5"}, {"new", "0.6"}}}));
    const json& regrouped = found["base_parameters"]["regrouped"];
    ASSERT_EQ(regrouped.size(), 1u);
    EXPECT_EQ(regrouped[0]["new"]["regroups"], "ZZ1 + Ia1 + L^2*M2");
    EXPECT_EQ(regrouped[0]["coefficients"], (json{{{"standard", "M2"}, {"old", 0.25}, {"new", 0.36}}}));
    EXPECT_EQ(run_idim({"diff", scara_, longer}).status, 0) << "a report, not a check";
    EXPECT_EQ(run_idim({"diff", scara_, longer, "--exit-code"}).status, 1);
}

TEST_F(DiffCommand, AnEffectMovesItsJointAloneAndNoTorqueOfTheRest) {
    const json found = compared(scara_, variant("  - coulomb_friction", "  - coulomb_friction\n  - torque_offset"));
    EXPECT_EQ(found["same"], false);
    EXPECT_EQ(found["torque"]["verdict"], "same");
    EXPECT_EQ(found["torque"]["only_new"],
              (json{{{"name", "off1"}, {"moves", {"j1"}}}, {{"name", "off2"}, {"moves", {"j2"}}}}));
    EXPECT_EQ(names(found["base_parameters"]["added"]), (name_list{"off1", "off2"}));
    EXPECT_EQ(found["standard_parameters"]["added"], (json{"off1", "off2"}));
    EXPECT_EQ(found["effects"]["added"],
              (json{{{"effect", "torque_offset"}, {"joints", {"j1", "j2"}}, {"torque", "off"}}}));
    EXPECT_EQ(found["operations"]["inverse_dynamics"]["difference"]["add"], 2);
    EXPECT_EQ(found["operations"]["mass_matrix"]["difference"]["add"], 0);
    EXPECT_EQ(found["regressor_columns"]["moved"],
              (json{{{"first", "ZZ2R"}, {"last", "Fc2"}, {"columns", 5}, {"old", 3}, {"new", 4}}}));
}

TEST_F(DiffCommand, AnEffectThatGoesIsNamedWithTheJointsItMoved) {
    const json found = compared(scara_, variant("  - {effect: direct_drive_rotor, joints: [j2], from: [j1]}", "  #"));
    EXPECT_EQ(found["torque"]["verdict"], "same");
    // The rotor of the direct drive turns with both joints, and its torque acts on both.
    EXPECT_EQ(found["torque"]["only_old"], (json{{{"name", "Ia2_1"}, {"moves", {"j1", "j2"}}}}));
    const json& regrouped = found["base_parameters"]["regrouped"];
    ASSERT_EQ(regrouped.size(), 1u);
    EXPECT_EQ(regrouped[0]["old"]["regroups"], "ZZ2 + Ia2_1");
    EXPECT_EQ(regrouped[0]["new"]["name"], "ZZ2");
}

TEST_F(DiffCommand, TheSameRobotWrittenOtherwiseComputesTheSame) {
    const json found = compared(scara_, variant("d: L, theta: q", "d: 2*L - L, theta: q + 2*pi"));
    EXPECT_EQ(found["torque"]["verdict"], "same");
    EXPECT_EQ(found["joints"].size(), 2u);
    EXPECT_EQ(found["same"], false) << "the description changed";
}

TEST_F(DiffCommand, TheSameTorqueByAnotherSumIsTheSameUpToRounding) {
    const std::string folder = edited("model_interface.cpp", "    model::inverse_dynamics(q, qd, qdd, chi, tau);\n",
                                      "    double W[model::dof * model::base_parameters];\n"
                                      "    model::regressor(q, qd, qdd, W);\n"
                                      "    for (int j = 0; j < model::dof; ++j) {\n"
                                      "        tau[j] = 0.0;\n"
                                      "        for (int k = 0; k < model::base_parameters; ++k) {\n"
                                      "            tau[j] += W[j * model::base_parameters + k] * chi[k];\n"
                                      "        }\n"
                                      "    }\n");
    const json found = compared(scara_, folder);
    EXPECT_EQ(found["torque"]["verdict"], "same_up_to_rounding");
    EXPECT_LT(found["torque"]["relative"]["difference"], 1e-14);  // a dozen terms, each rounded to 1.1e-16
    EXPECT_EQ(run_idim({"diff", scara_, folder, "--exit-code"}).status, 0);
}

TEST_F(DiffCommand, AConstantEditedByHandInTheTenthDigitIsFound) {
    const std::string folder =
        edited("inverse_dynamics.hpp", "nb2_at_3 = N2_3 + Scalar(0.5)", "nb2_at_3 = N2_3 + Scalar(0.5000000001)");
    const json found = compared(scara_, folder);
    EXPECT_EQ(found["torque"]["verdict"], "different");
    EXPECT_EQ(found["torque"]["absolute"]["joint"], "j1") << "n1 alone has a part in it";
    EXPECT_EQ(found["constants"].size() + found["base_parameters"]["regrouped"].size(), 0u);
    EXPECT_EQ(found["same"], false);
}

TEST_F(DiffCommand, TheStatesStayWithinThePositionLimits) {
    const std::string limited =
        variant("d: L, theta: q, r: 0", "d: 1.1*L, theta: q, r: 0, limits: {position: [0.2, 0.3], velocity: 0.5}");
    const json largest = compared(scara_, limited)["torque"]["absolute"];
    EXPECT_GE(largest["q"][1], 0.2);
    EXPECT_LE(largest["q"][1], 0.3);
    EXPECT_LE(std::abs(largest["qd"][1].get<double>()), 0.5);
}

TEST_F(DiffCommand, OtherJointsAreReportedAndTheirTorquesNotCompared) {
    const json found = compared(scara_, robot_file("emps"));
    EXPECT_EQ(found["torque"], (json{{"verdict", "not_comparable"}, {"reason", "2 driven joints before, 1 after"}}));
    EXPECT_EQ(found["same"], false);
    const command_result text = run_idim({"diff", scara_, robot_file("emps")});
    EXPECT_NE(text.out.find("torque: cannot be compared: 2 driven joints before, 1 after"), std::string::npos);
}

TEST_F(DiffCommand, TextSaysTheVerdictFirstAndOmitsWhatDidNotChange) {
    const command_result same = run_idim({"diff", generated_, scara_});
    EXPECT_NE(same.out.find("  torque: the same to the last bit at 2000 random states\n"), std::string::npos)
        << same.out;
    EXPECT_EQ(same.out.find("\n\n"), std::string::npos) << "no table";
    const command_result longer = run_idim({"diff", scara_, variant("L: 0.5", "L: 0.6")});
    EXPECT_NE(longer.out.find("\nconstants\n  constant  old  new\n  L         0.5  0.6\n"), std::string::npos)
        << longer.out;
    EXPECT_EQ(longer.out.find("effects"), std::string::npos);
}

TEST_F(DiffCommand, MarkdownFoldsDetailsAndLetsNoNameBeMarkup) {
    const std::string path = (folder_.path() / "a|b_*c*").string();
    ASSERT_EQ(run_idim({"generate", scara_, "-o", path}).status, 0);
    const command_result result = run_idim({"diff", path, variant("L: 0.5", "L: 0.6"), "--markdown"});
    ASSERT_EQ(result.status, 0);
    EXPECT_EQ(result.out.rfind("### Model of scara\n\n- **old**: ", 0), 0u) << result.out;
    EXPECT_NE(result.out.find("a\\|b\\_\\*c\\*"), std::string::npos);
    EXPECT_NE(result.out.find("\n| constant | old | new |\n|---|---|---|\n| `L` | `0.5` | `0.6` |\n"),
              std::string::npos);
    const auto count = [&](const std::string& what) {
        std::size_t n = 0;
        for (std::size_t at = result.out.find(what); at != std::string::npos; at = result.out.find(what, at + 1)) {
            ++n;
        }
        return n;
    };
    EXPECT_GE(count("<details><summary>"), 2u);
    EXPECT_EQ(count("<details>"), count("</details>"));
}

struct bad_folder {
    const char* name;
    const char* file;
    const char* from;
    const char* to;
    const char* message;  ///< behind "idim: <folder>"
};

std::ostream& operator<<(std::ostream& stream, const bad_folder& folder) {
    return stream << folder.name;
}

class BadFolder : public DiffCommand, public testing::WithParamInterface<bad_folder> {};

const bad_folder bad_folders[] = {
    {"OfAnotherFormat", "manifest.json", "\"format\": 3", "\"format\": 1", "/manifest.json: format: expected 3"},
    {"OfAnotherInterface", "manifest.json", "\"interface\": ", "\"interface\": 1",
     "/manifest.json: interface: expected "},
    {"OfAnotherTarget", "manifest.json", "\"target\": \"cpp\"", "\"target\": \"c\"",
     ": target: code of c, expected that of cpp"},
    {"WithTheManifestOfAnother", "model.hpp", "input_hash = \"", "input_hash = \"0",
     ": the code in this folder cannot be used: the compiled model cannot be used: its input hash is"},
    {"ThatDoesNotCompile", "bias.hpp", "#pragma once", "#error edited",
     ": the code in this folder cannot be used: the model does not compile"},
    {"WithOtherJointsInTheCode", "model.hpp", "    \"j1\",\n    \"j2\",\n", "    \"j1\",\n    \"j3\",\n",
     ": joints: not those of the code beside it, regenerate the folder"},
    {"ThatNamesAFileElsewhere", "manifest.json", "\"regressor.hpp\"", "\"../regressor.hpp\"",
     "/manifest.json: files: expected plain file names"},
    {"ThatTakesTheNameOfOurHeader", "manifest.json", "\"regressor.hpp\"", "\"model.hpp\"",
     ": the code in this folder cannot be used: "},
};

TEST_P(BadFolder, IsRefusedInOneLineThatSaysWhy) {
    const std::string folder = edited(GetParam().file, GetParam().from, GetParam().to);
    const command_result result = run_idim({"diff", folder, scara_});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.err.rfind("idim: " + folder + GetParam().message, 0), 0u) << result.err;
}

INSTANTIATE_TEST_SUITE_P(DiffCommand, BadFolder, testing::ValuesIn(bad_folders),
                         [](const testing::TestParamInfo<bad_folder>& bad) { return std::string(bad.param.name); });

TEST_F(DiffCommand, WhatIsNeitherFolderNorDescriptionIsBadInput) {
    for (const std::string& path : {std::string("/no/such/robot.yaml"), folder_.path().string()}) {
        EXPECT_EQ(run_idim({"diff", scara_, path}).status, 2) << path;
        EXPECT_EQ(run_idim({"diff", path, scara_}).status, 2) << path;
    }
}

}  // namespace

}  // namespace idim::test
