#include "oracles/effect_terms.hpp"

#include <regex>
#include <stdexcept>

#include "support/sign.hpp"

namespace idim::test {

namespace {

double at_one_joint(const std::string& kind, const joint_state& state, Eigen::Index j) {
    if (kind == "Ia") {
        return state.qdd[j];
    }
    return kind == "Fv" ? state.qd[j] : kind == "Fc" ? sign(state.qd[j]) : 1.0;
}

}  // namespace

Eigen::VectorXd effect_torque(const value_table& parameters, const joint_state& state) {
    static const std::regex inertial("(XX|XY|XZ|YY|YZ|ZZ|MX|MY|MZ|M)[0-9]+");
    static const std::regex effect("(Ia|Fv|Fc|off)([0-9]+)");
    static const std::regex direct_drive("Ia([0-9]+)_([0-9]+)");
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(state.q.size());
    for (const auto& [name, value] : parameters) {
        std::smatch part;
        if (std::regex_match(name, part, effect)) {
            const auto j = static_cast<Eigen::Index>(std::stoi(part[2]) - 1);
            torque[j] += value * at_one_joint(part[1], state, j);
        } else if (std::regex_match(name, part, direct_drive)) {
            const auto j = static_cast<Eigen::Index>(std::stoi(part[1]) - 1);
            const auto k = static_cast<Eigen::Index>(std::stoi(part[2]) - 1);
            torque[j] += value * (state.qdd[j] + state.qdd[k]);
            torque[k] += value * (state.qdd[j] + state.qdd[k]);
        } else if (!std::regex_match(name, inertial)) {
            throw std::runtime_error("tests/oracles/effect_terms.cpp has no closed form of parameter " + name);
        }
    }
    return torque;
}

}  // namespace idim::test
