// The same description gives the same bytes on every run. GiNaC orders its terms by hashes of addresses, so runs of one
// process prove nothing: each is a fresh one, with address randomisation on.
#include <gtest/gtest.h>

#include <map>

#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

constexpr int repeated_runs = 20;

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files[entry.path().filename().string()] = read_text(entry.path());
    }
    return files;
}

/// First file that differs, with both sizes, or nothing.
std::string difference(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
    for (const auto& [name, text] : a) {
        const auto other = b.find(name);
        if (other == b.end() || other->second != text) {
            return name + (other == b.end() ? " is missing" : " differs");
        }
    }
    return a.size() == b.size() ? "" : "more files";
}

class Determinism : public testing::TestWithParam<std::string> {};
class GeneratedFolder : public testing::TestWithParam<std::string> {};

TEST(AddressRandomisation, IsOnSoThatTheseTestsMeanSomething) {
    const std::string setting = read_text("/proc/sys/kernel/randomize_va_space");
    EXPECT_NE(setting.front(), '0') << "addresses are not randomised here: equal bytes would prove nothing";
}

TEST_P(Determinism, FreshProcessesWriteTheSameBytes) {
    const temporary_folder folder;
    std::map<std::string, std::string> first;
    for (int run = 0; run < repeated_runs; ++run) {
        const std::string out = (folder.path() / std::to_string(run)).string();
        const command_result result = run_idim({"generate", robot_file(GetParam()), "-o", out});
        ASSERT_EQ(result.status, 0) << result.err;
        const auto files = files_in(out);
        if (run == 0) {
            first = files;
            EXPECT_GE(files.size(), 10u);
        }
        ASSERT_EQ(difference(first, files), "") << "run " << run;
    }
}

INSTANTIATE_TEST_SUITE_P(Robots, Determinism, testing::Values("denso_vp6242g", "scara", "five_bar"));

TEST_P(GeneratedFolder, IsWhatTheGeneratorWritesNow) {
    const std::string folder = source_folder + "/generated/" + GetParam();
    const bool is_c = GetParam().size() > 2 && GetParam().substr(GetParam().size() - 2) == "_c";
    const std::string robot = GetParam().substr(0, GetParam().size() - (is_c ? 2 : 0));
    std::vector<std::string> arguments = {"generate", robot_file(robot), "--target", is_c ? "c" : "cpp", "-o", folder};
    arguments.emplace_back("--check");
    const command_result check = run_idim(arguments);
    EXPECT_EQ(check.status, 0) << "refresh with: ./dev generated\n" << check.out << check.err;
    const temporary_folder fresh;
    const std::string out = (fresh.path() / "model").string();
    arguments.pop_back();
    arguments.back() = out;
    ASSERT_EQ(run_idim(arguments).status, 0);
    EXPECT_EQ(difference(files_in(out), files_in(folder)), "");
}

INSTANTIATE_TEST_SUITE_P(Robots, GeneratedFolder, testing::ValuesIn(folders_in("generated")));

}  // namespace

}  // namespace idim::test
