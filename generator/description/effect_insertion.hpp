#pragma once

#include <map>
#include <string>
#include <vector>

namespace idim::generator {

/// An item for the list `effects:` of a description.
struct effect_item {
    std::string effect;
    std::vector<std::string> joints;  ///< names
    std::vector<std::string> from;    ///< names, for an effect driven by another joint
    std::map<std::string, double> shape;
};

/// "{effect: stribeck_friction, joints: [j2], shape: {vs: 0.03}}"
std::string to_yaml(const effect_item& item);

/// The text of a robot description (YAML) with items added at the end of its effects; everything else, comments and
/// layout included, stays as it was. `file` names it in errors. Throws input_error where the list cannot be extended.
std::string with_effects(const std::string& text, const std::vector<effect_item>& items, const std::string& file);

}  // namespace idim::generator
