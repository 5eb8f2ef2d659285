#include "description/urdf/urdf_reader.hpp"

#include <utility>

#include "description/text_file.hpp"
#include "description/urdf/mimic_chains.hpp"
#include "description/urdf/urdf_skeleton.hpp"
#include "description/urdf/urdf_values.hpp"
#include "description/urdf/xml_element.hpp"

namespace idim::generator {

urdf_tree read_urdf(const std::string& file) {
    constexpr std::size_t largest = 16'000'000;
    const xml_element root = read_xml(read_text_file(file, largest), file, urdf_limits);
    urdf_skeleton skeleton = read_skeleton(root, file);
    read_values(root, skeleton);
    resolve_mimics(skeleton.tree);
    return std::move(skeleton.tree);
}

}  // namespace idim::generator
