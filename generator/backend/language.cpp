#include "backend/language.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace idim::generator {

std::string language::element(const element_names& names, const std::string& array, int index) const {
    const auto place = static_cast<std::size_t>(index);
    if (array == "chi" && place < names.base.size()) {
        return fmt::format("chi[{}]", base_place(names.robot, names.base[place]));
    }
    if (array == "standard" && place < names.standard.size()) {
        return fmt::format("standard[{}]", standard_place(names.robot, names.standard[place]));
    }
    if (array == "W" && !names.base.empty()) {
        const std::size_t row = place / names.base.size();
        const std::string before = row == 0 ? "" : fmt::format("{} * {} + ", row, base_count(names.robot));
        return fmt::format("W[{}{}]", before, base_place(names.robot, names.base[place % names.base.size()]));
    }
    return fmt::format("{}[{}]", array, index);
}

std::string language::assignment(const std::string& element, const std::string& value) const {
    return fmt::format("{} = {};", element, value);
}

std::string language::local_array(const std::string& name, int size) const {
    return fmt::format("{} {}[{}];", scalar(), name, size);
}

const std::vector<std::string>& target_names() {
    static const std::vector<std::string> names = {"cpp", "c"};
    return names;
}

languages languages_of(const std::string& target) {
    if (target == "cpp") {
        return cpp_languages();
    }
    if (target == "c") {
        return c_languages();
    }
    throw std::invalid_argument("no target " + target);
}

}  // namespace idim::generator
