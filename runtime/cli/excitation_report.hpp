#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "idim/excitation_quality.hpp"
#include "idim/excitation_search.hpp"
#include "idim/motion_limits.hpp"

namespace idim::cli {

/// The published form that an optimised one is compared with.
struct compared_form {
    double period = 0.0;  ///< [s]
    int sinusoids = 0;
    excitation_quality quality;
};

/// A base parameter that the motion shows badly, and why.
struct poor_parameter {
    Eigen::Index place = 0;
    std::string why;
};

/// What a command says of a reference it wrote.
struct excitation_report {
    std::string form, criterion;
    search_result result;
    excitation_quality quality;
    limit_breach nearest;
    std::vector<poor_parameter> poor;
    /// The published form over the whole length of the optimised motion as one period, under the same ranges and
    /// speeds; and with its bands raised until speeds or accelerations reach their limits. Empty where that length
    /// holds no period of a limit frequency.
    std::optional<compared_form> published, published_fast;
};

excitation_report report_on(const limited_robot& robot, const search_result& result, int sinusoids, std::uint64_t seed,
                            bool compare);

json to_json(const excitation_report& report, const limited_robot& robot, const std::string& file);
void print(const excitation_report& report, const limited_robot& robot, const std::string& file);

}  // namespace idim::cli
