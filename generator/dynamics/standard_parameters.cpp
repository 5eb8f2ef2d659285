#include "dynamics/standard_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "description/inertial_parameters.hpp"
#include "dynamics/effect_terms.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

std::string inertial_unit(std::size_t kind) {
    return kind < 6 ? "kg*m^2" : kind < 9 ? "kg*m" : "kg";
}

void check_unique(const std::vector<standard_parameter>& parameters, const std::string& name, const effect_use& use) {
    const auto same = [&name](const standard_parameter& p) { return p.name == name; };
    if (std::any_of(parameters.begin(), parameters.end(), same)) {
        throw input_error(
            use.where, fmt::format("effect {} gives a second parameter {}, expected distinct names", use.effect, name));
    }
}

}  // namespace

ex standard_parameter::column_at(int coordinate) const {
    ex sum = 0;
    for (const auto& [acted_on, column] : columns) {
        sum += acted_on == coordinate ? column : ex(0);
    }
    return sum;
}

std::size_t standard_parameters::index(int link, parameter_kind kind) const {
    const auto found = std::find_if(all.begin(), all.end(), [link, kind](const standard_parameter& p) {
        return p.joint == link && p.kind == kind && p.gate < 0;
    });
    return static_cast<std::size_t>(found - all.begin());
}

bool standard_parameters::has_elastic_joint() const {
    return std::any_of(drives.begin(), drives.end(), [](const drive_model& drive) { return drive.is_elastic(); });
}

ex standard_parameters::without_elasticity(const kinematic_tree& tree, const ex& torque) const {
    GiNaC::exmap link;
    for (std::size_t i = 0; i < drives.size(); ++i) {
        if (drives[i].is_elastic()) {
            link[drives[i].motor[0]] = tree.q[i];
            link[drives[i].motor[1]] = tree.qd[i];
            link[drives[i].motor[2]] = tree.qdd[i];
        }
    }
    return link.empty() ? torque : torque.subs(link);
}

standard_parameters list_parameters(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                    const std::vector<effect_description>& descriptions) {
    standard_parameters parameters;
    for (int i = 0; i < tree.dof(); ++i) {
        parameters.temperature.emplace_back(fmt::format("temp{}", i + 1));
        parameters.rigid_torque.emplace_back(fmt::format("rigid{}", i + 1));
    }
    parameters.drives = read_drives(tree, uses, descriptions);
    std::vector<std::vector<standard_parameter>> of_joint(tree.joints.size());
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        for (std::size_t k = 0; k < inertial_names.size() && !tree.joints[j].massless; ++k) {
            of_joint[j].push_back({inertial_names[k] + tree.joints[j].label,
                                   static_cast<parameter_kind>(k),
                                   static_cast<int>(j),
                                   inertial_unit(k),
                                   std::nullopt,
                                   {}});
        }
    }
    for (std::size_t u = 0; u < uses.size(); ++u) {
        for (std::size_t i = 0; i < uses[u].joints.size(); ++i) {
            for (const standard_parameter& parameter : read_terms(tree, uses[u], descriptions[u], i, parameters)) {
                auto& list = of_joint[static_cast<std::size_t>(parameter.joint)];
                check_unique(list, parameter.name, uses[u]);
                list.push_back(parameter);
            }
        }
    }
    for (const auto& list : of_joint) {
        parameters.all.insert(parameters.all.end(), list.begin(), list.end());
    }
    return parameters;
}

}  // namespace idim::generator
