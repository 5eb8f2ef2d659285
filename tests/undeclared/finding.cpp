#include "undeclared/finding.hpp"

#include <cmath>

namespace idim::undeclared {

namespace {

using nlohmann::json;

/// A list of names, one name, or nothing.
std::vector<std::string> names_in(const json& content, const char* key) {
    const auto found = content.find(key);
    if (found == content.end() || found->is_null()) {
        return {};
    }
    return found->is_string() ? std::vector<std::string>{found->get<std::string>()}
                              : found->get<std::vector<std::string>>();
}

named_effect effect_in(const json& content) {
    return {content.at("effect").get<std::string>(), names_in(content, "joints"), names_in(content, "from")};
}

double number_or(const json& content, const char* key, double otherwise) {
    const auto found = content.find(key);
    return found != content.end() && found->is_number() ? found->get<double>() : otherwise;
}

found_effect step_in(const json& content) {
    found_effect step;
    step.effect = effect_in(content);
    for (const auto& [name, entry] : content.at("parameters").items()) {
        step.parameters[name] = {number_or(entry, "value", std::nan("")), number_or(entry, "std", std::nan(""))};
    }
    step.p_value = number_or(content, "p_value", 1.0);
    step.explained = number_or(content, "explained_fraction", 0.0);
    for (const json& other : content.value("confusable_with", json::array())) {
        step.confusable_with.push_back(effect_in(other));
    }
    return step;
}

}  // namespace

double model_errors::torque_norm() const {
    double sum = 0.0;
    for (const double one : rms) {
        sum += one * one;
    }
    return std::sqrt(sum) / relative;
}

model_errors errors_in(const json& content) {
    model_errors errors;
    errors.relative = content.at("relative_error").get<double>();
    for (const json& joint : content.at("joints")) {
        errors.rms.push_back(joint.at("rms").get<double>());
        errors.joint_relative.push_back(number_or(joint, "relative_error", std::nan("")));
    }
    return errors;
}

void read_refinement(const json& content, finding& result) {
    result.before_identification = errors_in(content.at("before").at("identification"));
    result.before_validation = errors_in(content.at("before").at("validation"));
    result.after_validation = errors_in(content.at("after").at("validation"));
    for (const json& step : content.at("steps")) {
        result.steps.push_back(step_in(step));
    }
    for (const json& entry : content.at("unexplained")) {
        const auto proposed = entry.find("proposed");
        result.unexplained.push_back({entry.at("joint").get<std::string>(), names_in(entry, "signals"),
                                      proposed != entry.end() && !proposed->is_null()});
    }
    for (const json& entry : content.value("not_identifiable", json::array())) {
        result.not_identifiable.push_back(effect_in(entry));
    }
    result.verdict = content.at("verdict").get<std::string>();
}

}  // namespace idim::undeclared
