#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/urdf/urdf_tree.hpp"
#include "description/urdf/xml_element.hpp"

namespace idim::generator {

/// Links and joints of a URDF and how they hang together, without numbers: names and places in the file, parents and
/// children, the root. Elements and indices are in the order of the file.
struct urdf_skeleton {
    urdf_tree tree;
    std::map<std::string, int> link_index, joint_index;             ///< by name
    std::vector<const xml_element*> link_elements, joint_elements;  ///< of the document it was read from
};

/// Throws input_error where `root`, the document's outermost element, is no robot whose links form one tree: elements
/// without a name or with one that is taken, joints without links, several roots, cycles.
urdf_skeleton read_skeleton(const xml_element& root, const std::string& file);

/// "a" -> "b" -> "a", the middle left out where it is long.
std::string cycle_text(const std::vector<std::string>& names);

}  // namespace idim::generator
