#include "exported_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

std::vector<named_value> values_of(const json& list) {
    std::vector<named_value> values;
    for (const json& entry : list) {
        if (entry.at("value").is_number()) {
            values.push_back({entry.at("name"), entry.at("unit"), entry.at("value")});
        }
    }
    return values;
}

std::string yaml_map(const std::string& key, const std::vector<named_value>& values) {
    std::string text = values.empty() ? "" : key + ":\n";
    for (const named_value& value : values) {
        text += fmt::format("  {}: {}  # {}\n", value.name, value.value, value.unit);
    }
    return text;
}

/// One array and the places of its elements, for both languages.
std::string arrays(const std::string& prefix, const std::string& name, const std::vector<named_value>& values) {
    if (values.empty()) {
        return "";
    }
    std::string text = fmt::format(
        "\n#ifdef __cplusplus\ninline constexpr double {0}[{2}] = {{\n#else\nstatic const double {1}_{0}[{2}] = "
        "{{\n#endif\n",
        name, prefix, values.size());
    for (const named_value& value : values) {
        text += fmt::format("    {}, /* {} [{}] */\n", value.value, value.name, value.unit);
    }
    return text + "};\n";
}

std::string sentence(const exported_result& result) {
    return fmt::format("Parameters of {}, identified by idim {} ({}), SI units", result.robot, result.version,
                       result.method);
}

}  // namespace

exported_result read_result(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw input_error({file, 0, ""}, "cannot be read");
    }
    try {
        const json content = json::parse(stream);
        exported_result result{content.at("idim_version"),
                               content.at("robot"),
                               content.value("description", ""),
                               content.at("method"),
                               content.at("input_hash"),
                               values_of(content.at("parameters")),
                               {}};
        if (content.contains("consistency") && content["consistency"].is_object()) {
            result.standard = values_of(content["consistency"].at("standard_parameters"));
        }
        if (result.base.empty()) {
            throw input_error({file, 0, "parameters"},
                              "empty, expected the result of an identification that succeeded");
        }
        return result;
    } catch (const json::exception& error) {
        throw input_error({file, 0, ""}, fmt::format("expected a result of identify --json: {}", error.what()));
    }
}

std::string as_yaml(const exported_result& result) {
    return fmt::format("# {}.\nrobot: {}\ninput_hash: {}\n", sentence(result), result.robot, result.input_hash) +
           yaml_map("parameters", result.base) + yaml_map("standard_parameters", result.standard);
}

std::string as_header(const exported_result& result) {
    std::string guard = "IDIM_IDENTIFIED_" + result.robot + "_H";
    std::transform(guard.begin(), guard.end(), guard.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    std::string text = fmt::format(
        "/* {}.\n * base_parameters in the order of the generated model with this input hash. */\n", sentence(result));
    text += fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
    text += fmt::format(
        "#ifdef __cplusplus\nnamespace idim_models::{0}::identified {{\ninline constexpr char input_hash[] = "
        "\"{1}\";\n#else\n"
        "static const char {0}_input_hash[] = \"{1}\";\n#endif\n",
        result.robot, result.input_hash);
    text += arrays(result.robot, "base_parameters", result.base);
    text += arrays(result.robot, "standard_parameters", result.standard);
    return text + fmt::format("\n#ifdef __cplusplus\n}}  // namespace idim_models::{}::identified\n#endif\n\n#endif\n",
                              result.robot);
}

}  // namespace idim::cli
