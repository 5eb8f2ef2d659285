#pragma once

#include <string>

#include "idim/compiled_model.hpp"

namespace idim::cli {

/// Folder that holds effects/ and cpp/: $IDIM_TEMPLATES, else share/idim/templates beside the command's folder bin/.
/// A build folder has the same layout as an installed tree. Throws input_error when there is none.
std::string templates_folder();

/// A header that compiled models include, such as "idim/model_interface.h", from the folder include beside the
/// command's.
model_source interface_header(const std::string& name);

}  // namespace idim::cli
