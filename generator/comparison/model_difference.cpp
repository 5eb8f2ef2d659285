#include "comparison/model_difference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace idim::generator {

namespace {

using named_texts = std::vector<std::pair<std::string, std::string>>;  ///< what it is called, what it is

const std::string* find(const named_texts& list, const std::string& name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&name](const auto& entry) { return entry.first == name; });
    return found == list.end() ? nullptr : &found->second;
}

/// Entries that differ: those of the new list in its order, then those that it no longer has.
std::vector<entry_change> changes(const std::string& what, const named_texts& before, const named_texts& after) {
    std::vector<entry_change> result;
    const auto add = [&](const std::string& name, const std::string& old_text, const std::string& new_text) {
        result.push_back(what.empty() ? entry_change{name, "", old_text, new_text}
                                      : entry_change{what, name, old_text, new_text});
    };
    for (const auto& [name, text] : after) {
        const std::string* const old = find(before, name);
        if (old == nullptr || *old != text) {
            add(name, old == nullptr ? "" : *old, text);
        }
    }
    for (const auto& [name, text] : before) {
        if (find(after, name) == nullptr) {
            add(name, text, "");
        }
    }
    return result;
}

void append(std::vector<entry_change>& list, const std::vector<entry_change>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

std::vector<std::string> missing(const std::vector<std::string>& from, const std::vector<std::string>& in) {
    std::vector<std::string> result;
    std::copy_if(from.begin(), from.end(), std::back_inserter(result),
                 [&in](const std::string& name) { return std::find(in.begin(), in.end(), name) == in.end(); });
    return result;
}

named_texts constants_of(const manifest& content) {
    named_texts result;
    for (const auto& [name, value] : content.constants) {
        result.emplace_back(name, fmt::format("{}", value));
    }
    return result;
}

std::string text_of(const std::optional<double>& number) {
    return number ? fmt::format("{}", *number) : "";
}

named_texts entries_of(const manifest_joint& joint) {
    named_texts result = {
        {"type", joint.type}, {"antecedent", joint.antecedent}, {"driven", joint.driven ? "yes" : "no"}};
    for (const char* const name : {"gamma", "b", "alpha", "d", "theta", "r"}) {
        const std::string* const entry = find(joint.row, name);
        result.emplace_back(name, entry == nullptr ? "0" : *entry);
    }
    result.emplace_back("position limits",
                        joint.position ? fmt::format("[{}, {}]", joint.position->first, joint.position->second) : "");
    result.emplace_back("velocity limit", text_of(joint.velocity));
    result.emplace_back("effort limit", text_of(joint.effort));
    result.emplace_back("drive gain", text_of(joint.drive_gain));
    return result;
}

std::vector<std::string> joint_names(const manifest& content, bool driven_only) {
    std::vector<std::string> names;
    for (const manifest_joint& joint : content.joints) {
        if (!driven_only || joint.driven) {
            names.push_back(joint.name);
        }
    }
    return names;
}

std::vector<entry_change> joint_changes(const manifest& before, const manifest& after) {
    std::vector<entry_change> result;
    for (const manifest_joint& joint : after.joints) {
        const auto old = std::find_if(before.joints.begin(), before.joints.end(),
                                      [&joint](const manifest_joint& j) { return j.name == joint.name; });
        if (old == before.joints.end()) {
            result.push_back({joint.name, "", "", joint.type});
        } else {
            append(result, changes(joint.name, entries_of(*old), entries_of(joint)));
        }
    }
    for (const manifest_joint& joint : before.joints) {
        const std::vector<std::string> names = joint_names(after, false);
        if (std::find(names.begin(), names.end(), joint.name) == names.end()) {
            result.push_back({joint.name, "", joint.type, ""});
        }
    }
    return result;
}

std::string name_of(const manifest_loop& loop) {
    return fmt::format("{}", fmt::join(loop.passive, ", "));
}

named_texts entries_of(const manifest_loop& loop) {
    const auto text = [](const manifest_loop::point& from) {
        return fmt::format("{} [{}]", from.link, fmt::join(from.at, ", "));
    };
    return {{"assembly", loop.assembly}, {"cut", text(loop.cut[0])}, {"cut, other side", text(loop.cut[1])}};
}

/// What is written of the loop that determines the same joints; nothing where there is none.
named_texts same_loop(const manifest& content, const manifest_loop& loop) {
    const auto found = std::find_if(content.loops.begin(), content.loops.end(),
                                    [&loop](const manifest_loop& other) { return other.passive == loop.passive; });
    return found == content.loops.end() ? named_texts{} : entries_of(*found);
}

std::vector<entry_change> loop_changes(const manifest& before, const manifest& after) {
    std::vector<entry_change> result;
    for (const manifest_loop& loop : after.loops) {
        append(result, changes(name_of(loop), same_loop(before, loop), entries_of(loop)));
    }
    for (const manifest_loop& loop : before.loops) {
        if (same_loop(after, loop).empty()) {
            append(result, changes(name_of(loop), entries_of(loop), {}));
        }
    }
    return result;
}

/// An effect at one of the joints it acts on.
struct effect_place {
    std::string name;  ///< "coupling_friction at j6 from j5"
    std::size_t effect = 0, joint = 0;
};

std::vector<effect_place> places_of(const std::vector<manifest_effect>& effects) {
    std::vector<effect_place> result;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        for (std::size_t j = 0; j < effects[e].joints.size(); ++j) {
            const std::string from = effects[e].from.empty() ? "" : " from " + effects[e].from[j];
            result.push_back({effects[e].effect + " at " + effects[e].joints[j] + from, e, j});
        }
    }
    return result;
}

const effect_place* find(const std::vector<effect_place>& places, const std::string& name) {
    const auto found = std::find_if(places.begin(), places.end(), [&name](const auto& p) { return p.name == name; });
    return found == places.end() ? nullptr : &*found;
}

named_texts entries_of(const manifest_effect& effect) {
    named_texts result;
    for (const auto& [name, value] : effect.shape) {
        result.emplace_back("shape " + name, fmt::format("{}", value));
    }
    result.emplace_back("torque", effect.torque);
    return result;
}

/// The effects of `from`, each with the joints where `in` does not have it.
std::vector<manifest_effect> missing_effects(const std::vector<manifest_effect>& from,
                                             const std::vector<manifest_effect>& in) {
    const std::vector<effect_place> others = places_of(in);
    std::vector<manifest_effect> result = from;
    for (manifest_effect& effect : result) {
        effect.joints.clear();
        effect.from.clear();
    }
    for (const effect_place& place : places_of(from)) {
        if (find(others, place.name) == nullptr) {
            const manifest_effect& whole = from[place.effect];
            result[place.effect].joints.push_back(whole.joints[place.joint]);
            if (!whole.from.empty()) {
                result[place.effect].from.push_back(whole.from[place.joint]);
            }
        }
    }
    result.erase(std::remove_if(result.begin(), result.end(), [](const auto& e) { return e.joints.empty(); }),
                 result.end());
    return result;
}

void compare_effects(model_difference& result, const manifest& before, const manifest& after) {
    result.effects_added = missing_effects(after.effects, before.effects);
    result.effects_removed = missing_effects(before.effects, after.effects);
    const std::vector<effect_place> old_places = places_of(before.effects);
    for (const effect_place& place : places_of(after.effects)) {
        if (const effect_place* const old = find(old_places, place.name)) {
            append(result.effects_changed, changes(place.name, entries_of(before.effects[old->effect]),
                                                   entries_of(after.effects[place.effect])));
        }
    }
}

/// Regroupings in numbers, by the names of the standard parameters: zero for those a model does not have.
std::map<std::string, double> coefficients_of(const base_parameter_summary& parameter, const model_summary& model) {
    std::map<std::string, double> result;
    for (std::size_t s = 0; s < model.standard.size(); ++s) {
        result[model.standard[s]] = parameter.coefficients[s];
    }
    return result;
}

std::vector<coefficient_change> coefficient_changes(const base_parameter_summary& was, const model_summary& before,
                                                    const base_parameter_summary& is, const model_summary& after) {
    constexpr double rounding = 1e-13;  // a coefficient is a constant or a sum of a few of them, rounded once
    std::vector<coefficient_change> result;
    std::map<std::string, double> old_values = coefficients_of(was, before);
    std::map<std::string, double> new_values = coefficients_of(is, after);
    std::vector<std::string> names = after.standard;
    const std::vector<std::string> dropped = missing(before.standard, after.standard);
    names.insert(names.end(), dropped.begin(), dropped.end());
    for (const std::string& name : names) {
        const double old_value = old_values[name];
        const double new_value = new_values[name];
        if (std::abs(new_value - old_value) > rounding * std::max(std::abs(old_value), std::abs(new_value))) {
            result.push_back({name, old_value, new_value});
        }
    }
    return result;
}

void compare_base(model_difference& result, const model_summary& before, const model_summary& after) {
    const auto with = [](const model_summary& model, const std::string& kept) {
        return std::find_if(model.base.begin(), model.base.end(),
                            [&kept](const base_parameter_summary& p) { return p.kept == kept; });
    };
    for (const base_parameter_summary& is : after.base) {
        const auto was = with(before, is.kept);
        if (was == before.base.end()) {
            result.base_added.push_back(is.parameter);
            continue;
        }
        const auto coefficients = coefficient_changes(*was, before, is, after);
        if (!coefficients.empty() || was->parameter.regroups != is.parameter.regroups ||
            was->parameter.unit != is.parameter.unit) {
            result.regrouped.push_back({was->parameter, is.parameter, coefficients});
        }
    }
    for (const base_parameter_summary& was : before.base) {
        if (with(after, was.kept) == after.base.end()) {
            result.base_dropped.push_back(was.parameter);
        }
    }
}

std::vector<column_move> moved_columns(const model_summary& before, const model_summary& after) {
    std::vector<column_move> result;
    for (std::size_t k = 0; k < after.base.size(); ++k) {
        const auto was = std::find_if(before.base.begin(), before.base.end(),
                                      [&](const base_parameter_summary& p) { return p.kept == after.base[k].kept; });
        const int new_place = static_cast<int>(k);
        const int old_place = static_cast<int>(was - before.base.begin());
        if (was == before.base.end() || old_place == new_place) {
            continue;
        }
        const std::string& name = after.base[k].parameter.name;
        const bool follows = !result.empty() && result.back().after + result.back().columns == new_place &&
                             result.back().before + result.back().columns == old_place;
        if (follows) {
            result.back().last = name;
            ++result.back().columns;
        } else {
            result.push_back({name, name, old_place, new_place, 1});
        }
    }
    return result;
}

std::vector<operations_change> operation_changes(const manifest& before, const manifest& after) {
    std::vector<operations_change> result;
    const auto with = [](const manifest& content, const std::string& name) {
        return std::find_if(content.operations.begin(), content.operations.end(),
                            [&name](const auto& entry) { return entry.first == name; });
    };
    for (const auto& [name, count] : after.operations) {
        const auto old = with(before, name);
        const bool known = old != before.operations.end();
        result.push_back({name, known ? old->second : operation_count{}, count, known});
    }
    for (const auto& [name, count] : before.operations) {
        if (with(after, name) == after.operations.end()) {
            result.push_back({name, count, {}, false});
        }
    }
    return result;
}

std::optional<std::string> reason_not_to_compare(const manifest& before, const manifest& after) {
    const std::vector<std::string> old_names = joint_names(before, true);
    const std::vector<std::string> new_names = joint_names(after, true);
    if (old_names.size() != new_names.size()) {
        return fmt::format("{} driven joints before, {} after", old_names.size(), new_names.size());
    }
    if (old_names != new_names) {
        return fmt::format("the driven joints were {}, are {}", fmt::join(old_names, ", "), fmt::join(new_names, ", "));
    }
    for (const manifest_joint& joint : after.joints) {
        for (const manifest_joint& old : before.joints) {
            if (joint.name == old.name && joint.driven && joint.type != old.type) {
                return fmt::format("joint {} was {}, is {}", joint.name, old.type, joint.type);
            }
        }
    }
    return std::nullopt;
}

bool same(const operation_count& a, const operation_count& b) {
    return a.mul == b.mul && a.add == b.add && a.div == b.div && a.functions == b.functions;
}

}  // namespace

bool model_difference::empty() const {
    const bool same_operations = std::all_of(operations.begin(), operations.end(), [](const operations_change& change) {
        return change.in_both && same(change.before, change.after);
    });
    return same_operations && base_added.empty() && base_dropped.empty() && regrouped.empty() &&
           standard_added.empty() && standard_dropped.empty() && effects_added.empty() && effects_removed.empty() &&
           effects_changed.empty() && constants.empty() && gravity.empty() && joints.empty() && loops.empty() &&
           columns.empty() && !not_comparable;
}

model_difference compare(const model_summary& before, const model_summary& after) {
    model_difference result;
    compare_base(result, before, after);
    result.standard_added = missing(after.standard, before.standard);
    result.standard_dropped = missing(before.standard, after.standard);
    compare_effects(result, before.content, after.content);
    result.constants = changes("", constants_of(before.content), constants_of(after.content));
    const auto gravity = [](const manifest& content) {
        return named_texts{{"gravity", fmt::format("[{}]", fmt::join(content.gravity, ", "))}};
    };
    result.gravity = changes("", gravity(before.content), gravity(after.content));
    result.joints = joint_changes(before.content, after.content);
    result.loops = loop_changes(before.content, after.content);
    result.columns = moved_columns(before, after);
    result.operations = operation_changes(before.content, after.content);
    result.not_comparable = reason_not_to_compare(before.content, after.content);
    return result;
}

}  // namespace idim::generator
