#pragma once

#include <string>
#include <vector>

#include "backend/manifest.hpp"
#include "backend/template_context.hpp"
#include "idim/model_interface.h"

namespace idim::generator {

/// A base parameter with the standard parameter that is kept in it.
struct base_parameter_summary {
    parameter_context parameter;       ///< name, unit, formula
    std::string kept;                  ///< "ZZ1" of ZZ1R
    std::vector<double> coefficients;  ///< one per standard parameter
};

/// What a model is, without its equations: the manifest of its folder and what its compiled code says of its
/// parameters.
struct model_summary {
    manifest content;
    std::vector<base_parameter_summary> base;  ///< in the order of chi
    std::vector<std::string> standard;
};

/// Throws input_error, naming `file` (the model's manifest or description), where code and manifest are not of one
/// model.
model_summary summarise(const manifest& content, const idim_model_interface& model, const std::string& file);

}  // namespace idim::generator
