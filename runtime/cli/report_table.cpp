#include "report_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace idim::cli {

namespace {

std::string code(std::string text) {
    std::replace(text.begin(), text.end(), '`', '\'');
    std::string result;
    for (const char c : text) {
        result += c == '|' ? "\\|" : std::string(1, c);
    }
    return "`" + result + "`";
}

/// Rows that are too long to stand beside each other: an entry a line.
std::string listed(const report_table& table) {
    std::string text;
    for (const auto& row : table.rows) {
        text += "  " + row[0] + "\n";
        for (std::size_t c = 1; c < row.size(); ++c) {
            text += fmt::format("    {}: {}\n", table.columns[c], row[c]);
        }
    }
    return text;
}

}  // namespace

std::string to_text(const report_table& table) {
    constexpr std::size_t widest = 120;
    std::vector<std::vector<std::string>> lines = {table.columns};
    lines.insert(lines.end(), table.rows.begin(), table.rows.end());
    std::vector<std::size_t> widths(table.columns.size(), 0);
    for (const auto& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            widths[c] = std::max(widths[c], line[c].size());
        }
    }
    if (std::accumulate(widths.begin(), widths.end(), 2 * widths.size()) > widest) {
        return table.title + "\n" + listed(table);
    }
    std::string text = table.title + "\n";
    for (const auto& line : lines) {
        std::string row;
        for (std::size_t c = 0; c < line.size(); ++c) {
            row += fmt::format("  {:<{}}", line[c], widths[c]);
        }
        text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string to_markdown(const report_table& table) {
    std::string text = fmt::format("| {} |\n|{}\n", fmt::join(table.columns, " | "),
                                   fmt::join(std::vector<std::string>(table.columns.size(), "---|"), ""));
    for (const auto& row : table.rows) {
        for (const std::string& cell : row) {
            text += "| " + code(cell) + " ";
        }
        text += "|\n";
    }
    return text;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_markup = std::string("\\`*_{}[]<>#|~&!").find(c) != std::string::npos;
        result += is_markup ? std::string("\\") + c : std::string(1, c);
    }
    return result;
}

}  // namespace idim::cli
