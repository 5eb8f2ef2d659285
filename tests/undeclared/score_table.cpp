#include "undeclared/score_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace idim::undeclared {

namespace {

using condition = std::function<bool(const case_result&)>;

bool in_class(const case_result& r, const std::string& name) {
    return r.made.class_name == name;
}

/// One exact effect of the catalogue.
bool single(const case_result& r) {
    const auto& forms = catalogue_forms();
    return std::find(forms.begin(), forms.end(), r.made.class_name) != forms.end();
}

condition is(const std::string& name) {
    return [name](const case_result& r) { return in_class(r, name); };
}

condition single_at(double rho) {
    return [rho](const case_result& r) { return single(r) && r.made.rho == rho; };
}

condition single_from(double rho) {
    return [rho](const case_result& r) { return single(r) && r.made.rho >= rho; };
}

bool first_named(const case_result& r) {
    return !r.scored.effects.empty() && r.scored.effects.front().named;
}

bool named_wrongly(const case_result& r) {
    return std::any_of(r.found.steps.begin(), r.found.steps.end(),
                       [](const found_effect& step) { return !step.proposed(); });
}

class table_builder {
  public:
    explicit table_builder(const std::vector<case_result>& results) : results_(results) {}

    /// Share of the cases of `where` that satisfy `what`.
    void cases(const std::string& claim, double limit, bool at_most, const condition& where, const condition& what) {
        table_row row{claim, bound_text(limit, at_most), 0, 0, at_most, limit};
        for (const case_result& r : results_) {
            if (r.problem.empty() && where(r)) {
                ++row.of;
                row.good += (r.found.ran() ? what(r) : at_most) ? 1 : 0;  // no result keeps no bound
            }
        }
        rows.push_back(row);
    }
    /// Share of everything counted in the cases of `where`.
    void counts(const std::string& claim, double limit, const condition& where,
                const std::function<std::pair<int, int>(const case_result&)>& count) {
        table_row row{claim, bound_text(limit, false), 0, 0, false, limit};
        for (const case_result& r : results_) {
            if (r.problem.empty() && where(r)) {
                const auto [good, of] = count(r);
                row.good += good;
                row.of += of;
            }
        }
        rows.push_back(row);
    }

    std::vector<table_row> rows;

  private:
    static std::string bound_text(double limit, bool at_most) {
        return fmt::format("{} {:g} %", at_most ? "at most" : "at least", 100.0 * limit);
    }

    const std::vector<case_result>& results_;
};

std::pair<int, int> sizes_of(const case_result& r) {
    const scored_effect& effect = r.scored.effects.front();
    return {effect.sizes_right, effect.sizes};
}

std::pair<int, int> shapes_of(const case_result& r) {
    const scored_effect& effect = r.scored.effects.front();
    return {effect.shapes_right, effect.shapes};
}

std::pair<int, int> recall_of(const case_result& r) {
    int named = 0;
    for (const scored_effect& effect : r.scored.effects) {
        named += effect.named ? 1 : 0;
    }
    return {named, static_cast<int>(r.scored.effects.size())};
}

std::pair<int, int> precision_of(const case_result& r) {
    return {r.scored.steps - r.scored.surplus, r.scored.steps};
}

void add_naming(table_builder& table) {
    const auto added = [](const case_result& r) { return r.scored.steps > 0; };
    table.cases("nothing undeclared: any effect added", 0.05, true, is("nothing"), added);
    table.cases("real sticking, nothing undeclared: any effect added", 0.05, true, is("sticking"), added);
    for (const auto& [rho, limit] : {std::pair{2.0, 0.95}, {1.0, 0.95}, {0.5, 0.95}, {0.35, 0.9}, {0.2, 0.6}}) {
        table.cases(fmt::format("named, or its family, rho {}", rho), limit, false, single_at(rho), first_named);
    }
    for (const auto& [low, high] : {std::pair{0.5, 1e9}, {0.35, 0.5}, {0.2, 0.35}, {0.0, 0.2}}) {
        const auto within = [low = low, high = high](const case_result& r) {
            return single(r) && r.scored.rho_in_tool_band >= low && r.scored.rho_in_tool_band < high;
        };
        table.cases(fmt::format("  by rho on the command's own rows: from {}", low), 0.0, false, within, first_named);
    }
    table.cases("right joint, rho >= 0.35", 0.98, false, single_from(0.35),
                [](const case_result& r) { return r.scored.effects.front().right_joint; });
    table.counts("size within its 95 % interval", 0.9, single, sizes_of);
    table.counts("shape within 5 %, rho >= 0.5", 0.9, single_from(0.5), shapes_of);
    table.cases(
        "surplus effects beside the right one", 0.02, true,
        [](const case_result& r) { return single(r) && first_named(r); },
        [](const case_result& r) { return r.scored.surplus > 0; });
}

void add_other_classes(table_builder& table) {
    const auto ran = [](const case_result& r) { return r.true_model.has_value(); };
    table.cases("form a little off: nearest family named", 0.9, false, is("near"), first_named);
    table.cases("form a little off: error within 1.5 of the true model's", 0.9, false, is("near"),
                [](const case_result& r) { return r.true_model && r.scored.ratio <= 1.5; });
    table.cases(
        "error after within 1.1 of the true model's", 0.95, false, [](const case_result& r) { return single(r); },
        [](const case_result& r) { return r.true_model && r.scored.ratio <= 1.1; });
    table.cases("error on untouched data above before", 0.0, true, ran,
                [](const case_result& r) { return r.scored.worse; });
    table.cases(
        "inside the span: said so", 1.0, false,
        [](const case_result& r) { return in_class(r, "span") && !r.made.effects.front().name.empty(); },
        [](const case_result& r) { return r.scored.span_said; });
    table.cases("inside the span: any effect added", 0.05, true, is("span"),
                [](const case_result& r) { return r.scored.steps > 0; });
    table.cases("outside the catalogue: right joint and signal", 0.8, false, is("outside"),
                [](const case_result& r) { return r.scored.structure_found; });
    table.cases("outside the catalogue: a wrong name", 0.1, true, is("outside"), named_wrongly);
    table.counts("two effects: recall", 0.9, is("two"), recall_of);
    table.counts("two effects: precision", 0.9, is("two"), precision_of);
}

using confusion = std::map<std::string, std::map<std::string, int>>;

confusion confusion_of(const std::vector<case_result>& results) {
    confusion matrix;
    for (const case_result& r : results) {
        if (r.problem.empty() && r.made.effects.size() <= 1) {
            const std::string truth = r.made.effects.empty() ? r.made.class_name : r.made.effects.front().form;
            ++matrix[truth][first_named(r) ? "its family" : r.scored.named_as];
        }
    }
    return matrix;
}

std::string confusion_text(const confusion& matrix) {
    std::string text = "\nwhat was missing, and what was added first\n";
    for (const auto& [truth, found] : matrix) {
        int total = 0;
        std::vector<std::pair<int, std::string>> ranked;
        for (const auto& [name, count] : found) {
            total += count;
            ranked.emplace_back(-count, name);
        }
        std::sort(ranked.begin(), ranked.end());
        text += fmt::format("  {:<30} {:>4}:", truth, total);
        for (const auto& [count, name] : ranked) {
            text += fmt::format(" {} {},", -count, name);
        }
        text.back() = '\n';
    }
    return text;
}

std::vector<double> sorted_seconds(const std::vector<case_result>& results) {
    std::vector<double> seconds;
    for (const case_result& r : results) {
        if (r.found.ran()) {
            seconds.push_back(r.found.seconds);
        }
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds;
}

/// Cases that gave no result, and why.
std::string failures_text(const std::vector<case_result>& results) {
    std::map<std::string, int> reasons;
    for (const case_result& r : results) {
        if (!r.problem.empty()) {
            ++reasons["not made or not measured: " + r.problem];
        } else if (!r.found.ran()) {
            ++reasons[r.found.timed_out ? "over the time limit"
                                        : fmt::format("exit {}: {}", r.found.exit_status, r.found.message)];
        }
    }
    std::string text;
    for (const auto& [reason, count] : reasons) {
        text += fmt::format("  {} without result: {}\n", count, reason);
    }
    return text;
}

}  // namespace

bool table_row::kept() const {
    const double share = static_cast<double>(good) / std::max(of, 1);
    return of == 0 || (at_most ? share <= limit : share >= limit);
}

std::vector<table_row> score_table(const std::vector<case_result>& results) {
    table_builder table(results);
    add_naming(table);
    add_other_classes(table);
    return table.rows;
}

std::string report_text(const std::vector<case_result>& results) {
    std::string text;
    for (const table_row& row : score_table(results)) {
        if (row.of > 0) {
            text += fmt::format("{:<58} {:>6.1f} % ({}/{}), {} {}\n", row.claim, 100.0 * row.good / row.of, row.good,
                                row.of, row.bound, row.kept() ? "" : "  <- NOT KEPT");
        }
    }
    text += confusion_text(confusion_of(results));
    const std::vector<double> seconds = sorted_seconds(results);
    if (!seconds.empty()) {
        text += fmt::format("\n{} cases, refine took {:.1f} s in the middle, {:.1f} s at most\n", results.size(),
                            seconds[seconds.size() / 2], seconds.back());
    }
    return text + failures_text(results);
}

nlohmann::json report_json(const std::vector<case_result>& results) {
    nlohmann::json table = nlohmann::json::array(), cases = nlohmann::json::array();
    for (const table_row& row : score_table(results)) {
        table.push_back(
            {{"claim", row.claim}, {"bound", row.bound}, {"count", row.good}, {"of", row.of}, {"kept", row.kept()}});
    }
    for (const case_result& r : results) {
        cases.push_back(json_of(r));
    }
    return {{"table", table}, {"confusion", confusion_of(results)}, {"cases", cases}};
}

}  // namespace idim::undeclared
