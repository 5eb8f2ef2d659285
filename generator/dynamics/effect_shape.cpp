#include "dynamics/effect_shape.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace idim::generator {

GiNaC::ex exact_decimal(double value, const input_location& where) {
    return parse_expression({fmt::format("({})", value), where}, {});
}

double shape_value(const effect_use& use, const effect_description& effect, const std::string& shape) {
    const auto given = use.shape.find(shape);
    if (given != use.shape.end()) {
        return given->second;
    }
    const auto known = std::find_if(effect.shape.begin(), effect.shape.end(),
                                    [&shape](const shape_coefficient& c) { return c.name == shape; });
    if (known == effect.shape.end()) {
        throw input_error({effect.file, 0, "shape"}, fmt::format("expected a shape {}", shape));
    }
    throw input_error(use.where, fmt::format("effect {} needs a value for its shape parameter {}, expected shape: "
                                             "{{{}: <number from {} to {}>}}",
                                             effect.name, shape, shape, known->range.first, known->range.second));
}

void check_shapes(const effect_use& use, const effect_description& effect) {
    for (const auto& [name, value] : use.shape) {
        const bool known = std::any_of(effect.shape.begin(), effect.shape.end(),
                                       [&key = name](const shape_coefficient& c) { return c.name == key; });
        if (!known) {
            throw input_error(use.where, fmt::format("effect {} has no shape parameter {}", effect.name, name));
        }
    }
}

}  // namespace idim::generator
