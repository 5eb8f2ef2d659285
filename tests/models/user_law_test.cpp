// A control law that the user wrote, compiled in: the same motion as the built-in law of the same equation, and clear
// words where the header is wrong.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oracles/scara_loop.hpp"
#include "support/command.hpp"
#include "support/robot_files.hpp"

namespace idim::test {

namespace {

const char* const cascade = R"(#include "idim/law_interface.h"

struct control_law {
    static constexpr const char* values[] = {"kv", "kp"};

    void command(const idim_law_sample& s, double* v) {
        for (int j = 0; j < s.n; ++j) {
            v[j] = s.values[0][j] * (s.values[1][j] * (s.qr[j] - s.q[j]) - s.qd[j]);
        }
    }
};
)";

/// v = kp e + ki sum(e T) + kd (qdr - qd), the sum still while the command is limited: a law with memory.
const char* const integrating = R"(#include <vector>

#include "idim/law_interface.h"

struct control_law {
    static constexpr const char* values[] = {"kp", "ki", "kd"};
    std::vector<double> sum, step;

    void command(const idim_law_sample& s, double* v) {
        sum.resize(s.n);
        step.resize(s.n);
        for (int j = 0; j < s.n; ++j) {
            const double error = s.qr[j] - s.q[j];
            step[j] = error / (1.0 / s.period);
            sum[j] += step[j];
            v[j] = s.values[0][j] * error + s.values[1][j] * sum[j] + s.values[2][j] * (s.qdr[j] - s.qd[j]);
        }
    }
    void limited(const double* wanted, const double* given) {
        for (std::size_t j = 0; j < sum.size(); ++j) {
            sum[j] -= wanted[j] == given[j] ? 0.0 : step[j];
        }
    }
};
)";

class UserLaw : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_.write("direct_drive_rotor.yaml", read_text(source_folder + "/robots/scara/direct_drive_rotor.yaml"));
        truth_ = folder_.write("truth.yaml", read_text(source_folder + "/runtime/demo/scara_truth.yaml"));
        reference_ = (folder_.path() / "reference.csv").string();
        scara_loop robot;
        write_log(reference_, robot.record(scara_reference(5.0), 1));
    }

    /// The SCARA under this law.
    std::string robot(const std::string& name, const std::string& control) {
        std::string text = read_text(robot_file("scara"));
        const std::size_t begin = text.find("control:");
        const std::size_t end = text.find('\n', begin);
        return folder_.write(name, text.substr(0, begin) + "control: {" + control + "}" + text.substr(end));
    }
    command_result simulate(const std::string& file, const std::string& log) {
        return run_idim({"simulate", file, "--parameters", truth_, "--reference", reference_, "-o",
                         (folder_.path() / log).string(), "--position-noise", "1e-5", "--seed", "3"});
    }
    /// Of a law that is not as it should be, without the folder.
    std::string error_of(const std::string& header, const std::string& control) {
        folder_.write("mine.hpp", header);
        const command_result answer = simulate(robot("bad.yaml", control), "bad.csv");
        EXPECT_EQ(answer.status, 2) << answer.out;
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / "bad.csv"));
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        return answer.err;
    }

    temporary_folder folder_;
    std::string truth_, reference_;
};

TEST_F(UserLaw, MovesTheRobotAsTheBuiltInLawOfTheSameEquation) {
    folder_.write("cascade.hpp", cascade);
    folder_.write("integrating.hpp", integrating);
    const std::string pd = ", rate: 200, delay: 0.005, kp: [5, 5], kv: [20, 0.5]";
    const std::string pid = ", rate: 200, kp: [100, 2], ki: [50, 1], kd: [20, 0.4], saturation: [2, 0.4]";
    for (const auto& [name, header, values] :
         {std::tuple{"pd_cascade", "cascade.hpp", pd}, {"pid", "integrating.hpp", pid}}) {
        const command_result built_in = simulate(robot("built_in.yaml", std::string("law: ") + name + values), "a.csv");
        ASSERT_EQ(built_in.status, 0) << built_in.err;
        const command_result own = simulate(robot("own.yaml", std::string("law: ") + header + values), "b.csv");
        ASSERT_EQ(own.status, 0) << own.err;
        EXPECT_EQ(read_text((folder_.path() / "a.csv").string()), read_text((folder_.path() / "b.csv").string()))
            << name;
    }
}

TEST_F(UserLaw, GivesTheInstrumentsOfTheBuiltInOne) {
    folder_.write("cascade.hpp", cascade);
    const std::string values = ", rate: 200, kp: [5, 5], kv: [20, 0.5]";
    nlohmann::json results[2];
    const std::string laws[2] = {"pd_cascade", "cascade.hpp"};
    const std::string log = (folder_.path() / "log.csv").string();
    ASSERT_EQ(simulate(robot("r.yaml", "law: pd_cascade" + values), "log.csv").status, 0);
    for (int k = 0; k < 2; ++k) {
        const std::string result_file = (folder_.path() / "result.json").string();
        const command_result answer = run_idim(
            {"identify", robot("r.yaml", "law: " + laws[k] + values), log, "--method", "iv", "--json", result_file});
        ASSERT_EQ(answer.status, 0) << answer.err;
        results[k] = nlohmann::json::parse(read_text(result_file))["parameters"];
    }
    EXPECT_EQ(results[0], results[1]);
}

TEST_F(UserLaw, ThatIsWrongIsBadInputInOneLine) {
    const std::string values = "law: mine.hpp, rate: 200, kp: [5, 5], kv: [20, 0.5]";
    EXPECT_NE(error_of("struct control_law {\n    int values = 1\n};\n", values)
                  .find("control.law: mine.hpp cannot be compiled, expected a header that defines struct control_law "
                        "(idim/law_interface.h): mine.hpp:2:"),
              std::string::npos);
    EXPECT_NE(error_of(cascade, "law: mine.hpp, rate: 200, kp: [5, 5]").find("kv: missing"), std::string::npos);
    EXPECT_NE(error_of(cascade, values + ", ki: [1, 1]").find("ki: no value of the law mine.hpp"), std::string::npos);
    EXPECT_NE(error_of(cascade, "law: other.hpp, rate: 200").find("other.hpp is not there, expected a header"),
              std::string::npos);
    EXPECT_NE(error_of(cascade, "law: ../mine.hpp, rate: 200").find("control.law"), std::string::npos);
}

}  // namespace

}  // namespace idim::test
