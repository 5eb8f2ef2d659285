#include "consistency_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "description/robot_description.hpp"
#include "identified_parameters.hpp"
#include "idim/input_error.hpp"
#include "option_text.hpp"

namespace idim::cli {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts = {""};
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

/// "0.5:5", "0.5:" or ":5".
interval interval_of(const std::string& option, const std::string& text) {
    const std::vector<std::string> ends = split(text, ':');
    const std::string expected = "LOW:HIGH, two numbers, one of which may be left out";
    if (ends.size() != 2 || (ends[0].empty() && ends[1].empty())) {
        refuse_option(option, text, expected);
    }
    const auto number = [&](const std::string& end, double missing) {
        const std::optional<double> value = end.empty() ? missing : finite_number(end);
        if (!value) {
            refuse_option(option, text, expected);
        }
        return *value;
    };
    const interval range{number(ends[0], interval().low), number(ends[1], interval().high)};
    if (!(range.low < range.high)) {
        refuse_option(option, text, "the lower number first");
    }
    return range;
}

addressed address_links(const std::string& option, const std::string& text, const physical_parameters& known) {
    std::vector<std::string> names;
    for (const inertial_body& body : known.bodies) {
        names.push_back(body.name);
    }
    return address(option, text, names, "link of ");
}

/// A map of standard parameters, a result of cwls, or the a-priori parameters of a robot description.
std::map<std::string, double> prior_values(const std::string& file) {
    const bool is_urdf = file.size() > 5 && file.compare(file.size() - 5, 5, ".urdf") == 0;
    return is_urdf ? generator::read_robot(file).parameters : read_standard_parameters(file);
}

Eigen::VectorXd read_prior(const std::string& file, const loaded_robot& robot, const physical_parameters& known) {
    const std::map<std::string, double> values = prior_values(file);
    const auto& names = robot.generated.base.standard_parameters;
    Eigen::VectorXd prior = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
    for (const inertial_body& body : known.bodies) {
        for (const Eigen::Index place : body.places) {
            const std::string& name = names[static_cast<std::size_t>(place)].name;
            const auto found = values.find(name);
            if (found == values.end()) {
                throw input_error({file, 0, name},
                                  fmt::format("missing, expected ten inertial parameters for the {}", body.name));
            }
            prior[place] = found->second;
        }
    }
    return prior;
}

}  // namespace

void add_consistency_options(CLI::App& command, consistency_options& options) {
    command
        .add_option("--consistency", options.consistency,
                    "of cwls: full (pseudo-inertia positive definite, default) or spatial (positive masses and central "
                    "inertias, as published)")
        ->check(CLI::IsMember({"full", "spatial"}));
    command
        .add_option("--objective", options.objective,
                    "of cwls: weighted (default) or normal (residual of the normal equations, as published)")
        ->check(CLI::IsMember({"weighted", "normal"}));
    command
        .add_option("--mass-bounds", options.mass_bounds,
                    "of cwls, may be repeated: LOW:HIGH [kg] for the mass of every link, JOINT=LOW:HIGH for one")
        ->allow_extra_args(false);
    command.add_option("--total-mass", options.total_mass, "of cwls: LOW:HIGH [kg] for all links together");
    command
        .add_option(
            "--com-box", options.com_boxes,
            "of cwls, may be repeated: LOW:HIGH,LOW:HIGH,LOW:HIGH [m] for x, y, z of the centre of mass of every "
            "link in its frame, JOINT=... for one")
        ->allow_extra_args(false);
    command.add_option(
        "--prior", options.prior,
        "of cwls: file of a-priori standard parameters (.urdf, or a map of names to values); what the data "
        "leaves open comes out near them");
    command
        .add_option(
            "--prior-strength", options.prior_strength,
            "of cwls: weight of the log-det divergence from the prior beside half the weighted squares; default 0")
        ->check(CLI::NonNegativeNumber);
    command
        .add_option("--floor", options.floor,
                    "of cwls: smallest eigenvalue a link's inertia may have; default 1e-6 of the largest parameter")
        ->check(CLI::PositiveNumber);
}

physical_parameters physical_parameters_of(const loaded_robot& robot) {
    const auto& list = robot.generated.base.standard_parameters;
    physical_parameters known;
    for (std::size_t k = 0; k < list.size(); ++k) {
        const auto place = static_cast<Eigen::Index>(k);
        if (list[k].inertial == 0) {
            known.bodies.push_back({(list[k].payload < 0 ? "link of " : "payload at ") + list[k].joint, {}});
        }
        if (list[k].inertial >= 0) {
            known.bodies.back().places[static_cast<std::size_t>(list[k].inertial)] = place;
        } else if (list[k].min) {
            known.coefficients.push_back({place, *list[k].min});
        }
    }
    return known;
}

consistency_request request_of(const consistency_options& options, const loaded_robot& robot,
                               const physical_parameters& known) {
    consistency_request request;
    request.kind = options.consistency == "full" ? consistency_kind::full : consistency_kind::spatial;
    request.objective =
        options.objective == "weighted" ? consistency_objective::weighted : consistency_objective::normal;
    request.bodies.resize(known.bodies.size());
    for (const std::string& text : options.mass_bounds) {
        const addressed at = address_links("--mass-bounds", text, known);
        for (const std::size_t body : at.places) {
            request.bodies[body].mass = interval_of("--mass-bounds", at.text);
        }
    }
    for (const std::string& text : options.com_boxes) {
        const addressed at = address_links("--com-box", text, known);
        const std::vector<std::string> axes = split(at.text, ',');
        if (axes.size() != 3) {
            refuse_option("--com-box", text, "three intervals, for x, y and z");
        }
        for (const std::size_t body : at.places) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                request.bodies[body].centre[axis] = interval_of("--com-box", axes[axis]);
            }
        }
    }
    if (!options.total_mass.empty()) {
        request.total_mass = interval_of("--total-mass", options.total_mass);
    }
    if (!options.prior.empty()) {
        request.prior = read_prior(options.prior, robot, known);
    } else if (options.prior_strength > 0.0) {
        refuse_option("--prior-strength", fmt::format("{}", options.prior_strength), "--prior FILE beside it");
    }
    request.prior_strength = options.prior_strength;
    request.floor = options.floor;
    return request;
}

}  // namespace idim::cli
