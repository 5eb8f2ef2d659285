// What idim export writes, read by others: MuJoCo, a C compiler and a C++ compiler, and idim itself.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "description/robot_description.hpp"
#include "oracles/mujoco_robot.hpp"
#include "oracles/rigid_link.hpp"
#include "support/command.hpp"
#include "support/test_model.hpp"
#include "support/urdf_text.hpp"

namespace idim::test {

namespace {

using json = nlohmann::json;

/// A result as identify --method cwls leaves it, of a robot whose standard parameters are known.
std::string result_of(const test_model& model, const std::string& file, const value_table& standard) {
    const Eigen::VectorXd chi = model.regroup(standard);
    json base = json::array(), all = json::array();
    for (Eigen::Index k = 0; k < chi.size(); ++k) {
        base.push_back(
            {{"name", model.parameter_names()[static_cast<std::size_t>(k)]}, {"value", chi[k]}, {"unit", "kg"}});
    }
    for (const std::string& name : model.standard_names()) {
        all.push_back({{"name", name}, {"value", standard.count(name) > 0 ? standard.at(name) : 0.0}, {"unit", "kg"}});
    }
    return json{{"idim_version", "0.1.0"},
                {"robot", model.generated().robot},
                {"description", file},
                {"input_hash", model.generated().input_hash},
                {"method", "cwls"},
                {"parameters", base},
                {"consistency", {{"standard_parameters", all}}}}
        .dump();
}

value_table inertias(int links, unsigned seed) {
    std::mt19937_64 random(seed);
    return standard_parameters_of(plausible_links(links, random));
}

/// Torques of a URDF in MuJoCo, and of the model at the parameters that were put into it.
void expect_same_torques(const std::string& urdf, const test_model& model, const Eigen::VectorXd& chi) {
    std::vector<std::string> joints;
    for (const auto& joint : model.generated().joints) {
        joints.push_back(joint.name);
    }
    const mujoco_robot other(urdf, joints);
    std::mt19937_64 random(3);
    for (int k = 0; k < 20; ++k) {
        const joint_state state = random_state(model.dof(), random);
        // MuJoCo turns inertia tensors to principal axes with an error of 1e-6 rad.
        EXPECT_LT(deviation(model.inverse_dynamics(state, chi), other.inverse_dynamics(state)), 1e-6);
    }
}

class ExportCommand : public ::testing::Test {
  protected:
    std::string export_as(const std::string& format, const std::string& result) {
        const std::string output = (folder_.path() / ("exported." + format)).string();
        const command_result answer = run_idim({"export", result, "--format", format, "-o", output});
        EXPECT_EQ(answer.status, 0) << answer.err;
        notes_ = answer.err;
        return read_text(output);
    }

    temporary_folder folder_;
    std::string notes_;
};

TEST_F(ExportCommand, AUrdfOfFramesHasTheTorquesOfTheModel) {
    for (const std::string robot : {"denso_vp6242g", "tx40", "kuka_lwr"}) {
        const temporary_folder folder;
        const std::string file = write_variant(folder, robot, "[]");
        const test_model model(file);
        const value_table standard = inertias(static_cast<int>(model.dof()), 11);
        const std::string result = folder.write("result.json", result_of(model, file, standard));
        expect_same_torques(export_as("urdf", result), model, model.regroup(standard));
    }
}

TEST_F(ExportCommand, AUrdfComesBackWithItsInertiasReplacedAndAllElseKept) {
    std::mt19937_64 random(5);
    urdf_text urdf("arm");
    urdf.massless_link("root").principal_link("a", random).principal_link("b", random).principal_link("c", random);
    urdf.joint("j1", "continuous", "root", "a", random_origin(random), {0.0, 1.0, 0.0});
    urdf.joint("j2", "revolute", "a", "b", random_origin(random), {0.6, 0.0, 0.8});
    urdf.joint("j3", "prismatic", "b", "c", random_origin(random), {1.0, 0.0, 0.0},
               "    <dynamics damping=\"1\" friction=\"2\"/>\n");
    folder_.write("arm.urdf", urdf.text());
    const std::string file = folder_.write("arm.yaml", "name: arm\nurdf: arm.urdf\neffects: [viscous_friction]\n");
    const test_model model(file);
    value_table standard = inertias(3, 12);
    const Eigen::VectorXd chi = model.regroup(standard);
    standard["Fv3"] = 7.5;
    const std::string text = export_as("urdf", folder_.write("result.json", result_of(model, file, standard)));
    expect_same_torques(text, model, chi);
    EXPECT_NE(text.find("<limit lower=\"-9\" upper=\"9\" effort=\"50\" velocity=\"3\"/>"), std::string::npos) << text;
    EXPECT_NE(text.find("<dynamics damping=\"7.5\"/>"), std::string::npos) << text;
    // Read again it gives the parameters that were put in.
    const auto again = generator::read_robot(folder_.write("again.urdf", text)).parameters;
    for (const auto& [name, value] : standard) {
        EXPECT_NEAR(again.at(name), value, 1e-12) << name;
    }
}

TEST_F(ExportCommand, WhatAUrdfCannotHoldIsNamed) {
    const std::string file = write_variant(folder_, "denso_vp6242g", "[rotor_inertia, torque_offset]");
    const test_model model(file);
    value_table standard = inertias(6, 13);
    standard["Ia2"] = 0.3;
    export_as("urdf", folder_.write("result.json", result_of(model, file, standard)));
    EXPECT_NE(notes_.find("a URDF has no place for Ia2\n"), std::string::npos) << notes_;
}

TEST_F(ExportCommand, ResultsWithoutLinksGiveNoUrdf) {
    const std::string file = robot_file("scara");
    const test_model model(file);
    json result = json::parse(result_of(model, file, inertias(2, 14)));
    result.erase("consistency");
    const command_result answer = run_idim({"export", folder_.write("wls.json", result.dump()), "--format", "urdf"});
    EXPECT_EQ(answer.status, 2);
    EXPECT_NE(answer.err.find("wls.json: consistency: missing, expected a result of identify --method cwls"),
              std::string::npos)
        << answer.err;
    EXPECT_EQ(run_idim({"export", folder_.write("no.json", "{}"), "--format", "yaml"}).status, 2);
    EXPECT_EQ(run_idim({"export", folder_.write("no.json", "no"), "--format", "header"}).status, 2);
    EXPECT_EQ(run_idim({"export", (folder_.path() / "none.json").string(), "--format", "yaml"}).status, 2);
}

TEST_F(ExportCommand, TheHeaderIsTheSameNumbersInCAndInCpp) {
    const std::string file = robot_file("scara");
    const test_model model(file);
    const value_table standard = inertias(2, 15);
    const std::string result = folder_.write("result.json", result_of(model, file, standard));
    folder_.write("identified.h", export_as("header", result));
    const std::string hash = model.generated().input_hash;
    const auto last = static_cast<std::size_t>(model.n_base()) - 1;
    const double chi = model.regroup(standard)[0];
    const std::string c = folder_.write(
        "c.c",
        fmt::format("#include \"identified.h\"\n#include <string.h>\nint main(void) {{ return scara_base_parameters[0] "
                    "== {} && "
                    "sizeof scara_base_parameters == {} * sizeof(double) && scara_standard_parameters[5] == {} && "
                    "strcmp(scara_input_hash, \"{}\") == 0 ? 0 : 1; }}\n",
                    chi, last + 1, standard.at("ZZ1"), hash));
    const std::string cpp = folder_.write(
        "cpp.cpp",
        fmt::format(
            "#include \"identified.h\"\nnamespace id = idim_models::scara::identified;\nstatic_assert("
            "id::base_parameters[0] == {} && sizeof id::base_parameters == {} * sizeof(double));\nint main() {{}}\n",
            chi, last + 1));
    const std::string program = (folder_.path() / "program").string();
    const command_result in_c =
        run_program({IDIM_C_COMPILER, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", c, "-o", program});
    ASSERT_EQ(in_c.status, 0) << in_c.err;
    EXPECT_EQ(run_program({program}).status, 0);
    const command_result in_cpp =
        run_program({IDIM_CXX_COMPILER, "-std=c++17", "-Wall", "-Wextra", "-Werror", cpp, "-o", program});
    EXPECT_EQ(in_cpp.status, 0) << in_cpp.err;
}

TEST_F(ExportCommand, TheYamlIsReadByOtherCommands) {
    const std::string file = robot_file("scara");
    const test_model model(file);
    const std::string text = export_as("yaml", folder_.write("result.json", result_of(model, file, inertias(2, 16))));
    EXPECT_NE(text.find("parameters:\n  ZZ1R: "), std::string::npos) << text;
    const std::string parameters = folder_.write("parameters.yaml", text);
    std::string reference = "t,qr1,qr2\n";
    for (int k = 0; k < 200; ++k) {
        reference += fmt::format("{},{},{}\n", k / 200.0, 0.1 * std::sin(k / 20.0), 0.0);
    }
    const command_result answer =
        run_idim({"simulate", file, "--parameters", parameters, "--reference",
                  folder_.write("reference.csv", reference), "-o", (folder_.path() / "log.csv").string()});
    EXPECT_EQ(answer.status, 0) << answer.err;
}

}  // namespace

}  // namespace idim::test
