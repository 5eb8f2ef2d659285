// A robot with a soft transmission through the commands: its links swing behind their motors, and with the elasticity
// declared its own log gives the parameters back.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>

#include "support/command.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

constexpr const char* arm =
    "name: soft_arm\n"
    "joints:\n"
    "  - {name: j1, alpha: pi/2, theta: q}\n"
    "  - {name: j2, d: 0.4, theta: q}\n"
    "control: {law: pd_cascade, rate: 1000, wn: 30, zeta: 0.8}\n"
    "effects:\n"
    "  - rotor_inertia\n"
    "  - viscous_friction\n"
    "  - coulomb_friction\n";
const std::map<std::string, double> truth = {{"ZZ1R", 2.54}, {"MX1R", 3.6}, {"MY1", 0.0}, {"Fv1", 3.0},
                                             {"Fc1", 2.0},   {"ZZ2", 0.3},  {"MX2", 0.8}, {"MY2", 0.0},
                                             {"Ia2", 0.2},   {"Fv2", 1.0},  {"Fc2", 1.0}};
constexpr const char* elasticity = "  - {effect: joint_elasticity, joints: [j2], shape: {K: 1500}}\n";

class SoftRobot : public testing::Test {
  protected:
    SoftRobot() {
        std::ofstream(path("rigid.yaml")) << arm;
        std::ofstream(path("soft.yaml")) << arm << elasticity;
        std::ofstream file(path("reference.csv"));
        file << "t,qr1,qr2\n" << std::setprecision(12);
        for (int k = 0; k <= 20000; ++k) {
            const double t = k / 1000.0;
            const double slow = std::pow(std::sin(M_PI * t / 20.0), 2);
            file << t << "," << slow * (0.7 * std::sin(1.3 * t) + 0.3 * std::sin(5.1 * t)) << ","
                 << slow * (0.8 * std::sin(2.1 * t) + 0.3 * std::sin(7.3 * t)) << "\n";
        }
    }

    std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

    command_result simulate(const std::map<std::string, double>& parameters) const {
        std::ofstream(path("truth.json")) << json(parameters);
        return run_idim({"simulate", path("soft.yaml"), "--parameters", path("truth.json"), "--reference",
                         path("reference.csv"), "-o", path("log.csv"), "--torque-noise", "0.01", "0.01",
                         "--position-noise", "1e-7", "1e-7"});
    }

    double error_of(const char* robot) const {
        const command_result answer = run_idim({"identify", path(robot), path("log.csv"), "--cutoff", "15",
                                                "--decimation", "20", "--json", path("result.json")});
        EXPECT_EQ(answer.status, 0) << answer.err;
        const json result = json::parse(read_text(path("result.json")));
        parameters_.clear();
        for (const json& parameter : result["parameters"]) {
            parameters_[parameter["name"]] = parameter["value"];
        }
        return result["residual"]["joints"][1]["relative_error"];
    }

    temporary_folder folder_;
    mutable std::map<std::string, double> parameters_;
};

TEST_F(SoftRobot, IsIdentifiedFromItsOwnSimulationWithItsElasticityDeclared) {
    const command_result simulated = simulate(truth);
    ASSERT_EQ(simulated.status, 0) << simulated.err;
    const double rigid = error_of("rigid.yaml");
    const double soft = error_of("soft.yaml");
    EXPECT_LT(soft, 0.5 * rigid) << rigid;
}

TEST_F(SoftRobot, WithoutARotorIsRefusedBeforeAnythingIsWritten) {
    std::map<std::string, double> no_rotor = truth;
    no_rotor["Ia2"] = 0.0;
    const command_result simulated = simulate(no_rotor);
    EXPECT_EQ(simulated.status, 3);
    EXPECT_NE(simulated.err.find("joint j2: joint_elasticity without inertia"), std::string::npos) << simulated.err;
    EXPECT_FALSE(std::filesystem::exists(path("log.csv")));
}

}  // namespace

}  // namespace idim::test
