#include "excitation_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "idim/multisine.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

namespace {

/// Beyond it a deviation is mostly that of other parameters.
constexpr double largest_inflation = 10.0;
/// Of the torque of all joints: below it a parameter is within the usual noise.
constexpr double smallest_torque_share = 0.01;

std::vector<poor_parameter> poor_parameters(const excitation_quality& quality, const Eigen::VectorXd& chi) {
    std::vector<poor_parameter> poor;
    for (Eigen::Index k = 0; k < quality.inflation.size(); ++k) {
        const double share =
            chi.size() == 0 ? 1.0 : std::abs(chi[k]) * quality.independent_torque[k] / quality.torque(chi);
        if (!(quality.inflation[k] <= largest_inflation)) {
            poor.push_back(
                {k, fmt::format("deviation {:.3g} times that of the parameter alone", quality.inflation[k])});
        } else if (!(share >= smallest_torque_share)) {
            poor.push_back({k, fmt::format("{:.2g} % of the torque", 100.0 * share)});
        }
    }
    return poor;
}

compared_form compare(const limited_robot& robot, const fourier_series& series) {
    compared_form form{series.period, 0, judge_excitation(robot.model, series)};
    for (const std::vector<harmonic>& joint : series.joints) {
        form.sinusoids = std::max(form.sinusoids, static_cast<int>(joint.size()));
    }
    return form;
}

json quality_json(const excitation_quality& quality) {
    return {{"condition_number", finite(quality.condition_number)},
            {"scaled_condition_number", finite(quality.scaled_condition_number)},
            {"log_determinant", finite(quality.log_determinant)}};
}

/// How many times better the motion is than a compared form.
json gain(const excitation_quality& own, const compared_form& form) {
    json result = {{"period", form.period}, {"sinusoids", form.sinusoids}};
    result.update(quality_json(form.quality));
    const auto b = static_cast<double>(own.inflation.size());
    result["gain"] = {
        {"condition_number", finite(form.quality.condition_number / own.condition_number)},
        {"scaled_condition_number", finite(form.quality.scaled_condition_number / own.scaled_condition_number)},
        {"deviation", finite(std::exp(0.5 * (own.log_determinant - form.quality.log_determinant) / b))}};
    return result;
}

json optional_gain(const excitation_quality& own, const std::optional<compared_form>& form) {
    return form ? gain(own, *form) : json(nullptr);
}

json joints_json(const limited_robot& robot, const excitation_plan& plan) {
    const Eigen::VectorXd frequencies = limit_frequencies(robot.limits);
    json joints = json::array();
    for (Eigen::Index j = 0; j < frequencies.size(); ++j) {
        json sinusoids = json::array();
        for (const harmonic& term : plan.series.joints[static_cast<std::size_t>(j)]) {
            const double shift = 2.0 * std::numbers::pi * term.multiple * plan.start / plan.series.period;
            const double phase = std::atan2(term.cosine, term.sine) + shift;
            sinusoids.push_back({{"multiple", term.multiple},
                                 {"amplitude", std::hypot(term.sine, term.cosine)},
                                 {"phase", std::remainder(phase, 2.0 * std::numbers::pi)}});
        }
        joints.push_back({{"joint", robot.model.joint_names[j]},
                          {"position", {robot.limits.lower[j], robot.limits.upper[j]}},
                          {"velocity", robot.limits.velocity[j]},
                          {"acceleration", finite(robot.limits.acceleration[j])},
                          {"torque", robot.limits_torque() ? finite(robot.limits.torque[j]) : json(nullptr)},
                          {"limit_frequency", frequencies[j]},
                          {"rest", plan.rest[j]},
                          {"offset", plan.series.offset[j]},
                          {"sinusoids", sinusoids}});
    }
    return joints;
}

json parameters_json(const excitation_report& report, const limited_robot& robot) {
    json parameters = json::array();
    for (Eigen::Index k = 0; k < report.quality.inflation.size(); ++k) {
        std::string why;
        for (const poor_parameter& poor : report.poor) {
            why = poor.place == k ? poor.why : why;
        }
        parameters.push_back({{"name", robot.model.parameter_names[k]},
                              {"unit", robot.model.parameter_units[k]},
                              {"inflation", finite(report.quality.inflation[k])},
                              {"independent_torque", finite(report.quality.independent_torque[k])},
                              {"poor", why.empty() ? json(nullptr) : json(why)}});
    }
    return parameters;
}

void print_gain(const char* what, const excitation_quality& own, const compared_form& form) {
    fmt::print(
        "  {} ({:g} s, {} sinusoids): condition number {:.4g}, {:.4g} in units: {:.3g} and {:.3g} times this one\n",
        what, form.period, form.sinusoids, form.quality.scaled_condition_number, form.quality.condition_number,
        form.quality.scaled_condition_number / own.scaled_condition_number,
        form.quality.condition_number / own.condition_number);
}

}  // namespace

excitation_report report_on(const limited_robot& robot, const search_result& result, int sinusoids, std::uint64_t seed,
                            bool compare_forms) {
    excitation_report report;
    report.result = result;
    report.quality = judge_excitation(robot.model, result.plan.series);
    report.nearest = largest_breach(robot, result.plan);
    report.poor = poor_parameters(report.quality, robot.chi);
    const multisine_options same_length{result.plan.periods * result.plan.series.period, sinusoids, seed};
    if (compare_forms && same_length.period * limit_frequencies(robot.limits).minCoeff() >= 1.0) {
        report.published = compare(robot, make_multisine(robot.limits, same_length));
        report.published_fast = compare(robot, make_fast_multisine(robot.limits, same_length));
    }
    return report;
}

json to_json(const excitation_report& report, const limited_robot& robot, const std::string& file) {
    const excitation_plan& plan = report.result.plan;
    json content = {{"robot", robot.model.robot},
                    {"reference", file},
                    {"form", report.form},
                    {"period", plan.series.period},
                    {"periods", plan.periods},
                    {"rest", plan.rest_time},
                    {"connection", plan.connection_time},
                    {"duration", plan.duration()},
                    {"rate", plan.rate},
                    {"start", plan.start}};
    content.update(quality_json(report.quality));
    content["nearest_limit"] = {{"limit", report.nearest.limit}, {"used", 1.0 + report.nearest.share}};
    if (report.form == "optimised") {
        content["criterion"] = report.criterion;
        content["starts"] = report.result.starts;
        content["interrupted"] = report.result.stopped;
        content["out_of_time"] = report.result.out_of_time;
        content["published"] = optional_gain(report.quality, report.published);
        content["published_at_limits"] = optional_gain(report.quality, report.published_fast);
    }
    content["joints"] = joints_json(robot, plan);
    content["parameters"] = parameters_json(report, robot);
    return content;
}

void print(const excitation_report& report, const limited_robot& robot, const std::string& file) {
    const excitation_plan& plan = report.result.plan;
    fmt::print("{}: {} excitation in {}: {} periods of {:g} s, {:g} s in all, {:g} Hz{}\n", robot.model.robot,
               report.form, file, plan.periods, plan.series.period, plan.duration(), plan.rate,
               report.result.stopped       ? " (interrupted: the best so far)"
               : report.result.out_of_time ? " (out of time: the best so far)"
                                           : "");
    fmt::print("  condition number {:.4g} with columns of norm one, {:.4g} in units, log det {:.4g}\n",
               report.quality.scaled_condition_number, report.quality.condition_number, report.quality.log_determinant);
    if (report.published) {
        print_gain("published form at equal length", report.quality, *report.published);
        print_gain("the same, faster up to the limits", report.quality, *report.published_fast);
    }
    fmt::print("  nearest limit: {}, {:.1f} % used\n", report.nearest.limit, 100.0 * (1.0 + report.nearest.share));
    for (const poor_parameter& poor : report.poor) {
        fmt::print("  poorly excited: {}, {}\n", robot.model.parameter_names[poor.place], poor.why);
    }
    if (report.poor.empty()) {
        fmt::print("  no parameter is poorly excited\n");
    }
    if (!robot.limits_torque()) {
        fmt::print("  torques not limited: {}\n",
                   robot.chi.size() == 0 ? "the parameters are not known (--parameters)" : "no limits are given");
    }
}

}  // namespace idim::cli
