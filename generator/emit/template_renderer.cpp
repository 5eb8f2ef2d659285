#include "emit/template_renderer.hpp"

#include <stdexcept>

#include "emit/template_file.hpp"
#include "emit/template_values.hpp"

namespace idim::generator {

std::vector<rendered_file> render(const template_context& context, const std::string& folder) {
    const template_names names(folder);
    if (names.files.empty()) {
        throw std::runtime_error("no templates in " + folder);
    }
    const context_data of_robot = robot_values(context, folder, names.partials);
    const context_data of_functions = values_of_functions(context.functions);
    std::vector<rendered_file> files;
    for (const std::string& name : names.files) {
        const std::string stem = name.substr(0, name.find('.'));
        const std::string extension = name.substr(stem.size());
        template_file content(folder, name);
        if (stem != "function") {
            const std::string text = content.filled({&of_robot, &of_functions});
            files.push_back({(stem == "robot" ? context.robot : stem) + extension, text});
            continue;
        }
        for (const function_context& function : context.functions) {
            for (const variant_context& variant : function.variants) {
                const context_data of_function = values_of_function(function, variant);
                files.push_back(
                    {function.name + variant.suffix + extension, content.filled({&of_robot, &of_function})});
            }
        }
    }
    return files;
}

}  // namespace idim::generator
