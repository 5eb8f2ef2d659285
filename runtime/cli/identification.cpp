#include "identification.hpp"

#include <cmath>

#include "idim/fitted_rows.hpp"

namespace idim::cli {

namespace {

json parameters_json(const identification& found) {
    json list = json::array();
    const Eigen::VectorXd std = found.result.deviations();
    for (Eigen::Index k = 0; k < found.result.chi.size(); ++k) {
        const auto& parameter = parameter_of(found.robot, found.rows, k);
        list.push_back({{"name", parameter.name},
                        {"value", found.result.chi[k]},
                        {"std", std[k]},
                        {"relative_std_percent", finite(relative_percent(std[k], found.result.chi[k]))},
                        {"unit", parameter.unit},
                        {"regroups", parameter.regroups}});
        if (const int log = column_of(found.rows, static_cast<int>(k)).log; log >= 0) {
            list.back()["log"] = found.rows.blocks[static_cast<std::size_t>(log)].file;
        }
    }
    return list;
}

/// In the order of `parameters`.
json covariance_json(const estimate& result) {
    json rows = json::array();
    for (Eigen::Index i = 0; i < result.covariance.rows(); ++i) {
        json row = json::array();
        for (const double value : result.covariance.row(i)) {
            row.push_back(finite(value));
        }
        rows.push_back(row);
    }
    return rows;
}

json iterations_json(const estimate& result) {
    json list = json::array();
    for (const iteration& step : result.iterations) {
        list.push_back({{"parameters", std::vector<double>(step.chi.begin(), step.chi.end())},
                        {"relative_error", finite(step.relative_error)}});
    }
    return list;
}

json essential_json(const identification& found) {
    json kept = json::array();
    for (const int k : found.essential.kept) {
        kept.push_back({{"name", name_of(found.robot, found.rows, k)},
                        {"value", found.essential.chi[k]},
                        {"std", found.essential.std[k]}});
    }
    return {{"parameters", kept},
            {"f_statistic", finite(found.essential.f_statistic)},
            {"p_value", finite(found.essential.p_value)},
            {"residual", to_json(found.essential.residual, found.robot)}};
}

json names_json(const identification& found, const std::vector<int>& columns) {
    json names = json::array();
    for (const int k : columns) {
        names.push_back(name_of(found.robot, found.rows, k));
    }
    return names;
}

}  // namespace

double relative_percent(double std, double value) {
    return 100.0 * std / std::abs(value);
}

identification identify(const loaded_robot& robot, const filter_choice& filter,
                        const std::vector<filtered_samples>& logs, least_squares_method method) {
    fitted_rows fit = fit_rows(robot.model(), logs, filter, method);
    essential_parameters essential;
    if (fit.result.chi.size() > 0) {
        essential = find_essential(fit.rows, fit.result);
    }
    return {robot, filter, std::move(fit.rows), std::move(fit.result), std::move(essential)};
}

bool has_essential(const identification& found) {
    return !found.essential.kept.empty() || !found.essential.dropped.empty();
}

json to_json(const identification& found, const std::string& method) {
    json rates = json::array();
    json files = json::array();
    for (const observation_block& block : found.rows.blocks) {
        rates.push_back(block.rate);
        files.push_back(block.file);
    }
    const double full_rate = found.rows.blocks.front().rate * found.filter.decimation;
    return {{"robot", found.robot.generated.robot},
            {"input_hash", found.robot.generated.input_hash},
            {"method", method},
            {"converged", found.result.converged},
            {"message", found.result.message},
            {"logs", files},
            {"filter", to_json(found.filter)},
            {"band", found.filter.band(full_rate)},
            {"row_rates", rates},
            {"iterations", iterations_json(found.result)},
            {"samples", found.result.samples},
            {"rank", found.result.rank},
            {"condition_number", finite(found.result.condition_number)},
            {"scaled_condition_number", finite(found.result.scaled_condition_number)},
            {"correlation_length", found.result.correlation_length},
            {"not_excited", names_json(found, found.result.not_excited)},
            {"parameters", parameters_json(found)},
            {"covariance", covariance_json(found.result)},
            {"essential", has_essential(found) ? essential_json(found) : json(nullptr)},
            {"residual", found.result.chi.size() > 0 ? to_json(found.result.residual, found.robot) : json(nullptr)}};
}

}  // namespace idim::cli
