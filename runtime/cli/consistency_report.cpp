#include "consistency_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace idim::cli {

namespace {

json scan_json(const inertia_scan& scan) {
    return {{"smallest_eigenvalue", finite(scan.smallest)}, {"share_not_positive", scan.share_not_positive}};
}

}  // namespace

json to_json(const consistent_estimate& found, const loaded_robot& robot) {
    if (found.standard.size() == 0) {
        return nullptr;
    }
    json links = json::array();
    for (const consistent_body& body : found.bodies) {
        links.push_back({{"name", body.name},
                         {"mass", body.mass},
                         {"centre", {body.centre[0], body.centre[1], body.centre[2]}},
                         {"smallest_central_eigenvalue", body.central_eigenvalue},
                         {"smallest_pseudo_eigenvalue", body.pseudo_eigenvalue}});
    }
    json active = json::array();
    for (const active_constraint& constraint : found.active) {
        active.push_back({{"constraint", constraint.name}, {"price", constraint.price}});
    }
    json standard = json::array();
    for (Eigen::Index k = 0; k < found.standard.size(); ++k) {
        const auto& parameter = robot.generated.base.standard_parameters[static_cast<std::size_t>(k)];
        standard.push_back({{"name", parameter.name}, {"value", finite(found.standard[k])}, {"unit", parameter.unit}});
    }
    return {{"objective", found.objective},
            {"objective_of_wls", found.unconstrained_objective},
            {"gap", found.gap},
            {"relative_gap", finite(found.gap / found.objective)},
            {"floor", found.floor},
            {"steps", found.steps},
            {"links", links},
            {"active", active},
            {"standard_parameters", standard},
            {"relative_error_of_wls", found.unconstrained.residual.relative_error},
            {"inertia_matrix",
             {{"configurations", found.inertia.configurations},
              {"wls", scan_json(found.unconstrained_inertia)},
              {"cwls", scan_json(found.inertia)}}}};
}

void print_consistency(const consistent_estimate& found) {
    fmt::print("  {}\n", found.fit.message);
    fmt::print("  objective {:.6g}, {:.6g} without constraints; relative error {:.3f} %, {:.3f} % without\n",
               found.objective, found.unconstrained_objective, 100.0 * found.fit.residual.relative_error,
               100.0 * found.unconstrained.residual.relative_error);
    fmt::print("  {:<20} {:>10} {:>28} {:>12} {:>14}\n", "one consistent set", "mass [kg]", "centre of mass [m]",
               "least of I_g", "pseudo-inertia");
    for (const consistent_body& body : found.bodies) {
        fmt::print("  {:<20} {:>10.4g} {:>28} {:>12.3g} {:>14.3g}\n", body.name, body.mass,
                   fmt::format("{:.4f}", fmt::join(body.centre, " ")), body.central_eigenvalue, body.pseudo_eigenvalue);
    }
    fmt::print(
        "  what the data leaves open in it is chosen near the prior, or near a reference body; only the base "
        "parameters are unique\n");
    for (const active_constraint& constraint : found.active) {
        fmt::print("  active: {}\n", constraint.name);
    }
    if (found.active.empty()) {
        fmt::print("  no constraint is active\n");
    }
    fmt::print(
        "  M(q) over {} configurations: smallest eigenvalue {:.3g} (not positive in {:.2f} %); of wls {:.3g} ({:.2f} "
        "%)\n",
        found.inertia.configurations, found.inertia.smallest, 100.0 * found.inertia.share_not_positive,
        found.unconstrained_inertia.smallest, 100.0 * found.unconstrained_inertia.share_not_positive);
}

}  // namespace idim::cli
