#pragma once

#include <string>

namespace idim::cli {

/// Folder that holds effects/ and cpp/: $IDIM_TEMPLATES, else share/idim/templates beside the installed command, else
/// the source tree. Throws input_error when there is none.
std::string templates_folder();

/// Folder that holds idim/model_interface.h, found likewise.
std::string include_folder();

}  // namespace idim::cli
