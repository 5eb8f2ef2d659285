// idim generate --check: what it says of a folder that is not what would be written, and that it writes nothing.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

class GenerateCheck : public testing::Test {
  protected:
    GenerateCheck() { EXPECT_EQ(run_idim({"generate", robot_file("emps"), "-o", path()}).status, 0); }

    std::string path() const { return (folder_.path() / "model").string(); }
    command_result check(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"generate", robot_file("emps"), "-o", path(), "--check"});
        return run_idim(more);
    }
    std::map<std::string, std::string> texts() const {
        std::map<std::string, std::string> result;
        for (const auto& entry : std::filesystem::directory_iterator(path())) {
            result[entry.path().filename().string()] = read_text(entry.path());
        }
        return result;
    }
    /// A hand edit, a missing file, and one that an earlier model left.
    void spoil() const {
        const std::string bias = read_text(path() + "/bias.hpp");
        folder_.write("model/bias.hpp", replaced(bias, "#include <cmath>\n", "#include <math.h>\n"));
        std::filesystem::remove(path() + "/gravity.hpp");
        folder_.write("model/friction.hpp", "// old\n");
        folder_.write("model/manifest.json", replaced(read_text(path() + "/manifest.json"), "\"regressor.hpp\"",
                                                      "\"friction.hpp\",\n    \"regressor.hpp\""));
    }

    temporary_folder folder_;
};

TEST_F(GenerateCheck, ACurrentFolderPassesInSilence) {
    const command_result result = check();
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(GenerateCheck, ListsFilesAndShowsWhatWouldChange) {
    spoil();
    const auto before = texts();
    const command_result result = check();
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(texts(), before);
    const std::string summary = path() + "/bias.hpp: differs\n" + path() + "/gravity.hpp: missing\n" + path() +
                                "/manifest.json: differs\n" + path() + "/friction.hpp: left over\n";
    EXPECT_EQ(result.out.rfind(summary + "--- a/bias.hpp\n+++ b/bias.hpp\n@@ -2,7 +2,7 @@\n", 0), 0u) << result.out;
    EXPECT_NE(result.out.find("\n-#include <math.h>\n+#include <cmath>\n"), std::string::npos);
    EXPECT_NE(result.out.find("\n--- /dev/null\n+++ b/gravity.hpp\n@@ -0,0 +1,"), std::string::npos);
    EXPECT_NE(result.out.find("\n--- a/friction.hpp\n+++ /dev/null\n@@ -1 +0,0 @@\n-// old\n"), std::string::npos);
    EXPECT_EQ(result.out.find("regressor.hpp\n+++"), std::string::npos) << "a file that is current is not shown";
}

TEST_F(GenerateCheck, KnowsTheTarget) {
    const std::string c = (folder_.path() / "c").string();
    ASSERT_EQ(run_idim({"generate", robot_file("emps"), "--target", "c", "-o", c}).status, 0);
    EXPECT_EQ(run_idim({"generate", robot_file("emps"), "--target", "c", "-o", c, "--check"}).status, 0);
    const command_result other = run_idim({"generate", robot_file("emps"), "-o", c, "--check"});
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.out.find("/emps.h: left over\n"), std::string::npos) << other.out;
    EXPECT_EQ(run_idim({"generate", robot_file("emps"), "--target", "fortran", "-o", c}).status, 2);
}

TEST_F(GenerateCheck, JsonHasTheFilesAndTheDiff) {
    spoil();
    const std::string file = (folder_.path() / "check.json").string();
    const command_result text = check({"--json", file});
    EXPECT_EQ(text.status, 1);
    const auto report = nlohmann::json::parse(read_text(file));
    EXPECT_EQ(report["current"], false);
    EXPECT_EQ(report["differences"][0], (nlohmann::json{{"file", "bias.hpp"}, {"state", "differs"}}));
    EXPECT_EQ(report["differences"].size(), 4u);
    const std::string diff = report["diff"];
    ASSERT_GE(text.out.size(), diff.size());
    EXPECT_EQ(text.out.substr(text.out.size() - diff.size()), diff);
    EXPECT_EQ(nlohmann::json::parse(check({"--json", "-"}).out), report);
}

TEST_F(GenerateCheck, JsonOfACurrentFolderIsEmptyOfDifferences) {
    const command_result result = check({"--json", "-"});
    EXPECT_EQ(result.status, 0);
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report["current"], true);
    EXPECT_TRUE(report["differences"].empty());
    EXPECT_EQ(report["diff"], "");
}

TEST_F(GenerateCheck, BytesThatAreNoTextDoNotBreakTheJson) {
    folder_.write("model/bias.hpp", "\xff\xfe not UTF-8\n");
    const command_result result = check({"--json", "-"});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(nlohmann::json::accept(result.out)) << result.err;
}

TEST_F(GenerateCheck, AFolderMadeCheapForAnotherTargetIsStaleAndOneForTheSameIsCurrent) {
    EXPECT_EQ(check({"--cost", "mcu"}).status, 1);
    EXPECT_EQ(run_idim({"generate", robot_file("emps"), "-o", path(), "--cost", "mcu"}).status, 0);
    EXPECT_NE(read_text(path() + "/manifest.json").find("\"cost\": \"mcu\""), std::string::npos);
    EXPECT_EQ(check({"--cost", "mcu"}).status, 0);
    EXPECT_EQ(check().status, 1);
    EXPECT_EQ(check({"--cost", "gpu"}).status, 2);
}

}  // namespace

}  // namespace idim::test
