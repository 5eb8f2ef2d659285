#include "support/test_model.hpp"

#include <cmath>

#include "support/robot_files.hpp"
#include "support/test_interface.h"

namespace idim::test {

namespace {

/// Compiled in the place of model_interface.cpp, which it includes under another name.
const char* const interface_source = R"(#define IDIM_MODEL_SYMBOL generated_model
#include "model_interface.inc"
#include "test_interface.h"

namespace {

FLOAT_FUNCTION

const idim_test_interface extended = {interface, FLOAT_POINTER};

}  // namespace

extern "C" const idim_model_interface* idim_model() { return &extended.model; }
)";

const char* const float_function =
    "void in_float(const float* q, const float* qd, const float* qdd, const float* chi, float* tau) {\n"
    "    model::inverse_dynamics(q, qd, qdd, chi, tau);\n"
    "}\n";

std::vector<model_source> sources_of(const generator::generated_model& generated) {
    std::vector<model_source> sources;
    bool needs_signals = false;
    for (const auto& file : generated.files) {
        const bool is_interface = file.name == "model_interface.cpp";
        sources.push_back({is_interface ? "model_interface.inc" : file.name, file.text});
        const bool is_dynamics = file.name == "inverse_dynamics.hpp";
        for (const char* signal : {"Scalar& t,", "Scalar* temp,", "Scalar* state,", "Scalar* motor,"}) {
            needs_signals = needs_signals || (is_dynamics && file.text.find(signal) != std::string::npos);
        }
    }
    const std::string source = replaced(interface_source, "FLOAT_FUNCTION", needs_signals ? "" : float_function);
    sources.push_back(
        {"test_interface.cpp", replaced(source, "FLOAT_POINTER", needs_signals ? "nullptr" : "in_float")});
    sources.push_back({"test_interface.h", read_text(source_folder + "/tests/support/test_interface.h")});
    sources.push_back({"idim/model_interface.h", read_text(source_folder + "/runtime/include/idim/model_interface.h")});
    return sources;
}

}  // namespace

test_model::test_model(const std::string& robot_file)
    : generated_(generator::generate(robot_file, templates_folder)),
      compiled_(compile_model(sources_of(generated_), generated_.input_hash, {IDIM_TEST_CACHE, ""})) {}

const idim_test_interface& test_model::extended() const {
    return reinterpret_cast<const idim_test_interface&>(interface());
}

std::vector<std::string> test_model::standard_names() const {
    return {interface().standard_names, interface().standard_names + interface().n_standard};
}

std::vector<std::string> test_model::parameter_names() const {
    return {interface().parameter_names, interface().parameter_names + interface().n_base};
}

Eigen::VectorXd test_model::regroup(const value_table& standard) const {
    std::vector<double> values;
    for (const std::string& name : standard_names()) {
        const auto known = standard.find(name);
        values.push_back(known == standard.end() ? 0.0 : known->second);
    }
    Eigen::VectorXd chi(n_base());
    interface().regroup(values.data(), chi.data());
    return chi;
}

Eigen::MatrixXd test_model::regressor(const joint_state& s, double t, const Eigen::VectorXd& temp) const {
    row_major W = row_major::Constant(dof(), n_base(), std::nan(""));
    interface().regressor(s.q.data(), s.qd.data(), s.qdd.data(), t, temp.data(), W.data());
    return W;
}

Eigen::VectorXd test_model::inverse_dynamics(const joint_state& s, const Eigen::VectorXd& chi, double t,
                                             const Eigen::VectorXd& temp) const {
    Eigen::VectorXd tau = Eigen::VectorXd::Constant(dof(), std::nan(""));
    interface().inverse_dynamics(s.q.data(), s.qd.data(), s.qdd.data(), t, temp.data(), chi.data(), tau.data());
    return tau;
}

Eigen::VectorXf test_model::inverse_dynamics_float(const joint_state& s, const Eigen::VectorXd& chi) const {
    const Eigen::VectorXf q = s.q.cast<float>();
    const Eigen::VectorXf qd = s.qd.cast<float>();
    const Eigen::VectorXf qdd = s.qdd.cast<float>();
    const Eigen::VectorXf parameters = chi.cast<float>();
    Eigen::VectorXf tau(dof());
    extended().inverse_dynamics_float(q.data(), qd.data(), qdd.data(), parameters.data(), tau.data());
    return tau;
}

Eigen::MatrixXd test_model::mass_matrix(const Eigen::VectorXd& q, const Eigen::VectorXd& chi) const {
    row_major M = row_major::Constant(dof(), dof(), std::nan(""));
    interface().mass_matrix(q.data(), chi.data(), M.data());
    return M;
}

Eigen::VectorXd test_model::bias(const joint_state& s, const Eigen::VectorXd& chi, double t,
                                 const Eigen::VectorXd& temp) const {
    Eigen::VectorXd N = Eigen::VectorXd::Constant(dof(), std::nan(""));
    interface().bias(s.q.data(), s.qd.data(), t, temp.data(), chi.data(), N.data());
    return N;
}

Eigen::VectorXd test_model::gravity(const Eigen::VectorXd& q, const Eigen::VectorXd& chi) const {
    Eigen::VectorXd G = Eigen::VectorXd::Constant(dof(), std::nan(""));
    interface().gravity(q.data(), chi.data(), G.data());
    return G;
}

Eigen::VectorXd test_model::forward_dynamics(const joint_state& s, const Eigen::VectorXd& tau,
                                             const Eigen::VectorXd& chi, int& pivot, double t,
                                             const Eigen::VectorXd& temp) const {
    Eigen::VectorXd qdd = Eigen::VectorXd::Constant(dof(), std::nan(""));
    pivot = interface().forward_dynamics(s.q.data(), s.qd.data(), tau.data(), t, temp.data(), chi.data(), qdd.data());
    return qdd;
}

}  // namespace idim::test
