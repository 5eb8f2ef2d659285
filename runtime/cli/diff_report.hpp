#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "compared_model.hpp"
#include "comparison/model_difference.hpp"
#include "idim/torque_comparison.hpp"

namespace idim::cli {

/// Two models and all that differs.
struct model_comparison {
    const compared_model& before;
    const compared_model& after;
    generator::model_difference difference;
    std::optional<torque_comparison> torques;  ///< nothing where they cannot be compared

    /// Nothing differs; torques may, by rounding.
    bool same() const;
};

/// A list of what changed, for people.
struct report_table {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    bool is_detail = false;  ///< folded where folding is possible
};

/// What people read, whatever it is printed as.
struct diff_report {
    std::string title;
    std::vector<std::pair<std::string, std::string>> summary;  ///< subject, finding
    std::vector<report_table> tables;                          ///< none empty
};

diff_report report(const model_comparison& comparison);
std::string to_text(const diff_report& report);
std::string to_markdown(const diff_report& report);
json to_json(const model_comparison& comparison);

}  // namespace idim::cli
