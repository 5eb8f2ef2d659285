#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "undeclared/case_result.hpp"

namespace idim::undeclared {

/// One row of the table of what the bench must show.
struct table_row {
    std::string claim, bound;
    int good = 0, of = 0;
    bool at_most = false;  ///< `good` counts what must be rare
    double limit = 0.0;    ///< share

    bool kept() const;
};

std::vector<table_row> score_table(const std::vector<case_result>& results);

/// The table, the confusion matrix and the times as text.
std::string report_text(const std::vector<case_result>& results);
nlohmann::json report_json(const std::vector<case_result>& results);

}  // namespace idim::undeclared
