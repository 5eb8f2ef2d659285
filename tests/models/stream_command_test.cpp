// identify --stream: the same result as in memory, and what it refuses.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "support/command.hpp"
#include "support/rail_robot.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

/// One mass of 5 kg on a rail at 1 kHz, tau = 5 qdd + 2 qd + 0.7 sign(qd) + noise of 0.5 N, periods of 8 s.
class StreamCommand : public ::testing::Test {
  protected:
    void SetUp() override {
        robot_ = folder_.write("rail.yaml", rail_text("viscous_friction, coulomb_friction"));
        log_ = folder_.write("log.csv", rail_log(50000));
    }
    static std::string rail_log(int rows) {
        std::string text = "t,q1,tau1\n";
        std::mt19937 random(3);
        std::normal_distribution<double> noise;
        for (int k = 0; k < rows; ++k) {
            const double w = 0.25 * std::numbers::pi;
            const double t = k / 1000.0;
            const double q = std::sin(w * t) + 0.5 * std::sin(3.0 * w * t);
            const double qd = w * (std::cos(w * t) + 1.5 * std::cos(3.0 * w * t));
            const double qdd = -w * w * (std::sin(w * t) + 4.5 * std::sin(3.0 * w * t));
            const double tau = 5.0 * qdd + 2.0 * qd + (qd > 0.0 ? 0.7 : -0.7) + 0.5 * noise(random);
            text += fmt::format("{},{},{}\n", t, q + 1e-6 * noise(random), tau);
        }
        return text;
    }
    json result_of(std::vector<std::string> options) const {
        const std::string file = (folder_.path() / "result.json").string();
        options.insert(options.begin(), {"identify", robot_, log_, "--json", file});
        const command_result answer = run_idim(options);
        EXPECT_EQ(answer.status, 0) << answer.err;
        return answer.status == 0 ? json::parse(read_text(file)) : json();
    }
    /// Numbers of two results agree to `tolerance` of their size, all else exactly.
    static void expect_same(const json& a, const json& b, double tolerance, const std::string& place = "") {
        ASSERT_EQ(a.type(), b.type()) << place;
        if (a.is_number_float()) {
            const double size = std::max(std::abs(a.get<double>()), 1e-9);
            EXPECT_NEAR(a.get<double>(), b.get<double>(), tolerance * size) << place;
        } else if (a.is_structured()) {
            ASSERT_EQ(a.size(), b.size()) << place;
            for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) {
                const std::string key = a.is_object() ? i.key() : std::to_string(i - a.begin());
                expect_same(*i, *j, tolerance, place + "/" + key);
            }
        } else {
            EXPECT_EQ(a, b) << place;
        }
    }
    void expect_same_result(const std::vector<std::string>& options) const {
        json in_memory = result_of(options);
        std::vector<std::string> streaming = options;
        streaming.emplace_back("--stream");
        json in_parts = result_of(streaming);
        EXPECT_EQ(in_memory["streamed"], false);
        EXPECT_EQ(in_parts["streamed"], true);
        in_memory.erase("streamed");
        in_parts.erase("streamed");
        // Parts are filtered to 1e-16 of the position, which the second difference at 1 kHz makes 1e-9 of the
        // acceleration; p-values and correlation lengths magnify what they get.
        expect_same(in_memory, in_parts, 1e-6);
    }
    std::string refusal(std::vector<std::string> options) const {
        options.insert(options.begin(), {"identify", robot_, log_, "--stream"});
        const command_result answer = run_idim(options);
        EXPECT_EQ(answer.status, 2);
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        return answer.err;
    }

    temporary_folder folder_;
    std::string robot_, log_;
};

TEST_F(StreamCommand, GivesTheResultInMemory) {
    expect_same_result({"--cutoff", "40", "--decimation", "1"});
    expect_same_result({"--method", "ols"});
}

TEST_F(StreamCommand, GivesTheResultOfAveragedPeriods) {
    expect_same_result({"--period", "auto", "--cutoff", "40", "--decimation", "3"});
    expect_same_result({"--period", "8", "--cutoff", "40", "--decimation", "3", "--method", "cwls"});
}

TEST_F(StreamCommand, RefusesWhatNeedsTheLogInMemory) {
    EXPECT_NE(refusal({"--method", "iv"}).find("--stream: not with --method iv, expected ols or wls"),
              std::string::npos);
    EXPECT_NE(refusal({"--method", "cwls"}).find("or cwls with --period"), std::string::npos);
    EXPECT_NE(refusal({"--compare"}).find("--stream: not with --compare"), std::string::npos);
}

TEST_F(StreamCommand, NamesTheLineOfAFaultBehindTheFirstBlock) {
    std::string text = rail_log(30000);
    text += "30.0001,oops,1\n";
    log_ = folder_.write("faulty.csv", text);
    EXPECT_NE(refusal({}).find("faulty.csv:30002: q1: 'oops' where a finite number was expected"), std::string::npos);
}

TEST_F(StreamCommand, SaysThatThereIsNoFolderForTemporaryFiles) {
    const command_result answer =
        run_program({"env", "TMPDIR=/nowhere", IDIM_COMMAND, "identify", robot_, log_, "--stream"});
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, "idim: TMPDIR: names no folder, expected one for temporary files\n");
}

TEST_F(StreamCommand, LeavesNothingInTheTemporaryFolder) {
    const std::filesystem::path scratch = folder_.path() / "scratch";
    std::filesystem::create_directory(scratch);
    const command_result done =
        run_program({"env", "TMPDIR=" + scratch.string(), IDIM_COMMAND, "identify", robot_, log_, "--stream"});
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_TRUE(std::filesystem::is_empty(scratch));
}

}  // namespace

}  // namespace idim::test
