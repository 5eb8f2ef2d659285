#include "method_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace idim::cli {

namespace {

json distances_json(const std::vector<motion_distance>& distances, const loaded_robot& robot) {
    json list = json::array();
    for (std::size_t j = 0; j < distances.size(); ++j) {
        list.push_back({{"joint", robot.generated.joints[j].name},
                        {"q", finite(distances[j].q)},
                        {"qd", finite(distances[j].qd)},
                        {"qdd", finite(distances[j].qdd)}});
    }
    return list;
}

std::string percent_list(const std::vector<joint_error>& joints) {
    std::vector<double> values;
    for (const joint_error& joint : joints) {
        values.push_back(100.0 * joint.relative_error);
    }
    return fmt::format("{:.2f}", fmt::join(values, " "));
}

/// Largest distance over the joints, position / velocity / acceleration.
std::string farthest(const std::vector<motion_distance>& distances) {
    motion_distance largest;
    for (const motion_distance& joint : distances) {
        largest.q = std::max(largest.q, joint.q);
        largest.qd = std::max(largest.qd, joint.qd);
        largest.qdd = std::max(largest.qdd, joint.qdd);
    }
    return distances.empty()
               ? "-"
               : fmt::format("{:.2g}/{:.2g}/{:.2g}", 100.0 * largest.q, 100.0 * largest.qd, 100.0 * largest.qdd);
}

void print_convergence(const estimate& fit, const loaded_robot& robot) {
    constexpr std::size_t most_columns = 8;  // of the iterations, the last ones
    const std::size_t steps = fit.iterations.size();
    const std::size_t first = steps > most_columns ? steps - most_columns : 0;
    fmt::print("  {:<10}", "iteration");
    for (std::size_t k = first; k < steps; ++k) {
        fmt::print(" {:>11}", k);
    }
    fmt::print("\n");
    const auto& parameters = robot.generated.base.parameters;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        fmt::print("  {:<10}", parameters[p].name);
        for (std::size_t k = first; k < steps; ++k) {
            fmt::print(" {:>11.5g}", fit.iterations[k].chi[static_cast<Eigen::Index>(p)]);
        }
        fmt::print("\n");
    }
}

}  // namespace

json iterations_json(const estimate& fit, const loaded_robot& robot) {
    json list = json::array();
    for (const iteration& step : fit.iterations) {
        json entry = {{"parameters", std::vector<double>(step.chi.begin(), step.chi.end())},
                      {"relative_error", finite(step.relative_error)}};
        if (!step.to_measured.empty()) {
            json joints = json::array();
            for (std::size_t j = 0; j < step.joint_errors.size(); ++j) {
                joints.push_back({{"joint", robot.generated.joints[j].name},
                                  {"rms", finite(step.joint_errors[j].rms)},
                                  {"relative_error", finite(step.joint_errors[j].relative_error)}});
            }
            entry["joints"] = joints;
            entry["simulated_error"] = finite(step.simulated_error);
            entry["distance_to_measured"] = distances_json(step.to_measured, robot);
            entry["distance_to_reference"] = distances_json(step.to_reference, robot);
        }
        list.push_back(entry);
    }
    return list;
}

json loop_json(const method_result& result) {
    if (result.start.empty()) {
        return nullptr;
    }
    return {{"start", result.start},
            {"assumption", result.assumption.empty() ? json(nullptr) : json(result.assumption)}};
}

json optional_json(const std::optional<double>& value) {
    return value ? finite(*value) : json(nullptr);
}

json tests_json(const method_result& result, const loaded_robot& robot) {
    json residual = json::array();
    for (std::size_t j = 0; j < result.residual.size(); ++j) {
        const residual_test& test = result.residual[j];
        residual.push_back({{"joint", robot.generated.joints[j].name},
                            {"lag_one_correlation", finite(test.lag_one)},
                            {"whiteness_p", optional_json(test.whiteness_p)},
                            {"skewness", finite(test.skewness)},
                            {"excess_kurtosis", finite(test.excess_kurtosis)},
                            {"normality_p", optional_json(test.normality_p)},
                            {"thinned_rows", test.thinned_rows}});
    }
    json instruments = nullptr;
    if (result.instruments) {
        const instrument_test& test = *result.instruments;
        json bias = json::array();
        for (Eigen::Index k = 0; k < test.bias_percent.size(); ++k) {
            bias.push_back({{"name", robot.generated.base.parameters[static_cast<std::size_t>(k)].name},
                            {"percent", finite(test.bias_percent[k])},
                            {"deviations", finite(test.bias_in_deviations[k])}});
        }
        instruments = {{"p_value", finite(test.p_value)}, {"f_statistic", finite(test.f_statistic)},
                       {"tested", test.tested},           {"rows", test.rows},
                       {"message", test.message},         {"least_squares_bias", bias}};
    }
    return {{"residual", residual}, {"instruments", instruments}};
}

void print_iterations(const method_result& result, const loaded_robot& robot) {
    if (result.start.empty()) {
        return;
    }
    fmt::print("  from {}\n", result.start);
    if (!result.assumption.empty()) {
        fmt::print("  {}\n", result.assumption);
    }
    fmt::print("  {:>9} {:>8} {:>10} {:>24} {:>24}  {}\n", "iteration", "error %", "simulated",
               "q/qd/qdd from measured %", "from reference %", "error by joint %");
    for (std::size_t k = 0; k < result.fit.iterations.size(); ++k) {
        const iteration& step = result.fit.iterations[k];
        fmt::print("  {:>9} {:>8.2f} {:>10.2f} {:>24} {:>24}  {}\n", k, 100.0 * step.relative_error,
                   100.0 * step.simulated_error, farthest(step.to_measured), farthest(step.to_reference),
                   percent_list(step.joint_errors));
    }
    print_convergence(result.fit, robot);
    fmt::print("  {}\n", result.fit.message);
}

std::string whiteness_of(const residual_test& test) {
    return test.whiteness_p
               ? fmt::format("{} (lag 1 {:.2f}, p {:.2g})", *test.whiteness_p < 0.05 ? "not white" : "white",
                             test.lag_one, *test.whiteness_p)
               : "too few rows to tell whether it is white";
}

std::string normality_of(const residual_test& test) {
    return test.normality_p
               ? fmt::format("{} (skewness {:.2f}, kurtosis {:+.2f}, p {:.2g})",
                             *test.normality_p < 0.05 ? "not normal" : "normal", test.skewness, test.excess_kurtosis,
                             *test.normality_p)
               : fmt::format("too few independent rows ({}) to tell whether it is normal", test.thinned_rows);
}

void print_tests(const method_result& result, const loaded_robot& robot) {
    for (std::size_t j = 0; j < result.residual.size(); ++j) {
        const residual_test& test = result.residual[j];
        fmt::print("  residual of {}: {}, {}\n", robot.generated.joints[j].name, whiteness_of(test),
                   normality_of(test));
    }
    if (!result.instruments) {
        return;
    }
    fmt::print("  {}\n", result.instruments->message);
    for (Eigen::Index k = 0; k < result.instruments->bias_percent.size(); ++k) {
        const double deviations = result.instruments->bias_in_deviations[k];
        if (std::abs(deviations) > 2.0) {
            fmt::print("    least squares has {} {:+.2f} % ({:+.1f} deviations) from it\n",
                       robot.generated.base.parameters[static_cast<std::size_t>(k)].name,
                       result.instruments->bias_percent[k], deviations);
        }
    }
}

void print_comparison(const std::vector<method_result>& results, const loaded_robot& robot) {
    std::vector<const method_result*> shown;
    fmt::print("  {:<10}", "parameter");
    for (const method_result& result : results) {
        if (result.fit.chi.size() > 0) {
            fmt::print(" {:>21}", result.method + " (std)");
            shown.push_back(&result);
        }
    }
    fmt::print("\n");
    const auto& parameters = robot.generated.base.parameters;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        fmt::print("  {:<10}", parameters[p].name);
        for (const method_result* result : shown) {
            const auto k = static_cast<Eigen::Index>(p);
            fmt::print(" {:>21}", fmt::format("{:.5g} ({:.2g})", result->fit.chi[k], result->fit.deviations()[k]));
        }
        fmt::print("\n");
    }
    fmt::print("  {:<10}", "error %");
    for (const method_result* result : shown) {
        fmt::print(" {:>21.2f}", 100.0 * result->fit.residual.relative_error);
    }
    fmt::print("\n");
    for (const method_result& result : results) {
        fmt::print("  {}: {}\n", result.method, result.fit.message);
    }
}

json comparison_json(const std::vector<method_result>& results, const loaded_robot& robot) {
    json list = json::array();
    for (const method_result& result : results) {
        json parameters = json::array();
        for (Eigen::Index k = 0; k < result.fit.chi.size(); ++k) {
            parameters.push_back({{"name", robot.generated.base.parameters[static_cast<std::size_t>(k)].name},
                                  {"value", result.fit.chi[k]},
                                  {"std", result.fit.deviations()[k]}});
        }
        list.push_back({{"method", result.method},
                        {"converged", result.fit.converged},
                        {"message", result.fit.message},
                        {"loop", loop_json(result)},
                        {"parameters", parameters},
                        {"residual", result.fit.chi.size() > 0 ? to_json(result.fit.residual, robot) : json(nullptr)}});
    }
    return list;
}

}  // namespace idim::cli
