#pragma once

#include <string>

namespace idim::cli {

/// Folder that holds effects/ and cpp/: $IDIM_TEMPLATES, else share/idim/templates beside the command's folder bin/.
/// A build folder has the same layout as an installed tree. Throws input_error when there is none.
std::string templates_folder();

/// Folder that holds idim/model_interface.h: include beside the command's folder.
std::string include_folder();

}  // namespace idim::cli
