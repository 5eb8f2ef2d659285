#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model_comparison.hpp"
#include "report_table.hpp"

namespace idim::cli {

/// What people read, whatever it is printed as.
struct diff_report {
    std::string title;
    std::vector<std::pair<std::string, std::string>> summary;  ///< subject, finding
    std::vector<report_table> tables;                          ///< none empty
};

diff_report report(const model_comparison& comparison);
std::string to_text(const diff_report& report);
std::string to_markdown(const diff_report& report);

}  // namespace idim::cli
