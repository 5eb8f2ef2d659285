#pragma once

#include <string>
#include <vector>

namespace idim::cli {

/// A list of what changed, for people.
struct report_table {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    bool is_detail = false;  ///< folded where folding is possible
};

/// Columns beside each other, or an entry a line where that would be too wide.
std::string to_text(const report_table& table);

std::string to_markdown(const report_table& table);

/// Text in which nothing is markup.
std::string escaped(const std::string& text);

}  // namespace idim::cli
