#include "identified_parameters.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <map>

#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

/// name -> value, and the filter if there is one. JSON is YAML, so one reader does for both.
std::map<std::string, double> values_of(const YAML::Node& root, const std::string& file) {
    std::map<std::string, double> values;
    const YAML::Node list = root["parameters"];
    const auto number = [&file](const YAML::Node& node, const std::string& name) {
        double value = NAN;
        if (!YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
            throw input_error({file, node.Mark().line + 1, name}, "expected a finite number");
        }
        return value;
    };
    if (list && list.IsSequence()) {
        for (const YAML::Node& entry : list) {
            if (!entry.IsMap() || !entry["name"] || !entry["value"]) {
                throw input_error({file, entry.Mark().line + 1, "parameters"}, "expected entries with name and value");
            }
            const auto name = entry["name"].as<std::string>();
            values[name] = number(entry["value"], name);
        }
        return values;
    }
    for (const auto& entry : list&& list.IsMap() ? list : root) {
        const auto name = entry.first.as<std::string>();
        values[name] = number(entry.second, name);
    }
    return values;
}

YAML::Node read_root(const std::string& file) {
    try {
        YAML::Node root = YAML::LoadFile(file);
        if (!root.IsMap()) {
            throw input_error({file, 1, ""}, "expected a result of identify, or a map of parameter names to values");
        }
        return root;
    } catch (const YAML::BadFile&) {
        throw input_error({file, 0, ""}, "cannot be read");
    } catch (const YAML::ParserException& error) {
        throw input_error({file, error.mark.line + 1, ""}, "malformed: " + error.msg);
    }
}

std::optional<filter_choice> filter_of(const YAML::Node& root) {
    const YAML::Node filter = root["filter"];
    if (!filter || !filter.IsMap() || !filter["cutoff"] || !filter["order"] || !filter["decimation"]) {
        return std::nullopt;
    }
    filter_choice choice;
    choice.cutoff = filter["cutoff"].as<double>();
    choice.order = filter["order"].as<int>();
    choice.decimation = filter["decimation"].as<int>();
    choice.minimum_speed = filter["minimum_speed"] ? filter["minimum_speed"].as<double>() : 0.0;
    choice.reason = "as the parameters were identified";
    return choice;
}

/// Variance of the torque of one period about the mean of the periods, which errors on averaged rows lack: of joint j,
/// scatter^2 (1 - 1 / P), mean over the logs.
double variance_averaged_out(const YAML::Node& periodic, std::size_t joint) {
    if (!periodic || !periodic.IsMap() || !periodic["logs"]) {
        return 0.0;
    }
    double sum = 0.0;
    for (const YAML::Node& log : periodic["logs"]) {
        const auto scatter = log["joints"][joint]["scatter"].as<double>();
        sum += scatter * scatter * (1.0 - 1.0 / log["periods"].as<double>());
    }
    return sum / static_cast<double>(periodic["logs"].size());
}

/// Whether the result holds what spread_of reads, for this robot and without columns of single logs.
bool has_spread(const YAML::Node& root, const loaded_robot& robot) {
    const YAML::Node covariance = root["covariance"];
    const YAML::Node residual = root["residual"];
    const std::size_t parameters = robot.generated.base.parameters.size();
    return covariance && covariance.IsSequence() && covariance.size() == parameters && residual && residual.IsMap() &&
           residual["joints"] && residual["joints"].size() == robot.generated.joints.size();
}

std::optional<prediction_spread> spread_of(const YAML::Node& root, const loaded_robot& robot, const std::string& file) {
    if (!has_spread(root, robot)) {
        return std::nullopt;
    }
    prediction_spread spread;
    const auto b = static_cast<Eigen::Index>(root["covariance"].size());
    spread.covariance.resize(b, b);
    try {
        for (Eigen::Index i = 0; i < b; ++i) {
            for (Eigen::Index k = 0; k < b; ++k) {
                spread.covariance(i, k) = root["covariance"][i][k].as<double>();
            }
        }
        for (std::size_t j = 0; j < root["residual"]["joints"].size(); ++j) {
            const auto rms = root["residual"]["joints"][j]["rms"].as<double>();
            spread.noise.push_back(std::sqrt(rms * rms + variance_averaged_out(root["periodic"], j)));
        }
    } catch (const YAML::Exception& error) {
        throw input_error({file, error.mark.line + 1, ""},
                          "expected numbers in covariance, residual and periodic, as identify writes them");
    }
    return spread;
}

}  // namespace

std::map<std::string, double> read_standard_parameters(const std::string& file) {
    const YAML::Node root = read_root(file);
    const YAML::Node consistency = root["consistency"];
    if (!consistency || !consistency.IsMap()) {
        return values_of(root["standard_parameters"] ? root["standard_parameters"] : root, file);
    }
    std::map<std::string, double> values;
    for (const YAML::Node& entry : consistency["standard_parameters"]) {
        double value = NAN;  // null where it moves no torque
        if (YAML::convert<double>::decode(entry["value"], value)) {
            values[entry["name"].as<std::string>()] = value;
        }
    }
    return values;
}

identified_parameters read_parameters(const std::string& file, const loaded_robot& robot) {
    const YAML::Node root = read_root(file);
    std::map<std::string, double> values = values_of(root, file);
    const auto& names = robot.generated.base.parameters;
    identified_parameters result{Eigen::VectorXd(static_cast<Eigen::Index>(names.size())), filter_of(root),
                                 spread_of(root, robot, file)};
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto found = values.find(names[k].name);
        if (found == values.end()) {
            throw input_error(
                {file, 0, names[k].name},
                fmt::format("missing, expected a value for every base parameter of {}", robot.generated.robot));
        }
        result.chi[static_cast<Eigen::Index>(k)] = found->second;
        values.erase(found);
    }
    if (!values.empty()) {
        throw input_error(
            {file, 0, values.begin()->first},
            fmt::format("no base parameter of {}: identified with another description?", robot.generated.robot));
    }
    return result;
}

}  // namespace idim::cli
