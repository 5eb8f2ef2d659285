#include "comparison/model_summary.hpp"

#include <algorithm>

#include "idim/input_error.hpp"

namespace idim::generator {

namespace {

std::vector<std::string> driven_joints(const manifest& content) {
    std::vector<std::string> names;
    for (const manifest_joint& joint : content.joints) {
        if (joint.driven) {
            names.push_back(joint.name);
        }
    }
    return names;
}

/// The kept parameter gives its name to the base parameter, with R behind it if others are regrouped into it.
std::string kept_in(const std::string& name, const std::vector<std::string>& standard) {
    const bool as_it_is = std::find(standard.begin(), standard.end(), name) != standard.end();
    return as_it_is || name.empty() || name.back() != 'R' ? name : name.substr(0, name.size() - 1);
}

/// Row k of the regrouping: chi_k of the robot whose only standard parameter is the s-th, one. Column by column.
void add_coefficients(model_summary& summary, const idim_model_interface& model) {
    std::vector<double> standard(summary.standard.size(), 0.0);
    std::vector<double> chi(summary.base.size(), 0.0);
    for (double& parameter : standard) {
        parameter = 1.0;
        model.regroup(standard.data(), chi.data());
        parameter = 0.0;
        for (std::size_t k = 0; k < chi.size(); ++k) {
            summary.base[k].coefficients.push_back(chi[k]);
        }
    }
}

}  // namespace

model_summary summarise(const manifest& content, const idim_model_interface& model, const std::string& file) {
    if (driven_joints(content) != std::vector<std::string>(model.joint_names, model.joint_names + model.dof)) {
        throw input_error({file, 0, "joints"}, "not those of the code beside it, regenerate the folder");
    }
    model_summary result{content, {}, {model.standard_names, model.standard_names + model.n_standard}};
    for (int k = 0; k < model.n_base; ++k) {
        const parameter_context parameter{model.parameter_names[k], model.parameter_units[k], model.regroupings[k]};
        result.base.push_back({parameter, kept_in(parameter.name, result.standard), {}});
    }
    add_coefficients(result, model);
    return result;
}

}  // namespace idim::generator
