#include <fmt/format.h>

#include <map>
#include <string>

#include "idim/input_error.hpp"
#include "idim/loop_identification.hpp"

namespace idim {

Eigen::VectorXd regular_start(const idim_model_interface& model) {
    std::map<std::string, int> place;
    for (int s = 0; s < model.n_standard; ++s) {
        place[model.standard_names[s]] = s;
    }
    Eigen::VectorXd standard = Eigen::VectorXd::Zero(model.n_standard);
    for (int j = 0; j < model.dof; ++j) {
        const std::string number = std::to_string(j + 1);
        auto inertia = place.find("Ia" + number);
        if (inertia == place.end()) {
            inertia = place.find((model.joint_is_prismatic[j] != 0 ? "M" : "ZZ") + number);
        }
        if (inertia == place.end()) {
            throw data_error(
                fmt::format("no regular start: joint {} has neither a rotor inertia nor one of its own "
                            "link; give the values to start from",
                            model.joint_names[j]));
        }
        standard[inertia->second] = 1.0;
    }
    Eigen::VectorXd chi(model.n_base);
    model.regroup(standard.data(), chi.data());
    return chi;
}

}  // namespace idim
