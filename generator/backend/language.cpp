#include "backend/language.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace idim::generator {

std::string language::element(const std::string& array, int index) const {
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
