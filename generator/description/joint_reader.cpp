#include "description/joint_reader.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "description/identifier.hpp"

namespace idim::generator {

namespace {

expression_text read_expression(const yaml_value& value) {
    return {value.expression(), value.where()};
}

bool read_flag(const yaml_value& value) {
    const std::string text = value.text("true or false");
    if (text != "true" && text != "false") {
        value.reject("true or false");
    }
    return text == "true";
}

joint_type read_type(const yaml_fields& row) {
    const auto written = row.find("type");
    if (!written) {
        return joint_type::revolute;
    }
    const std::string text = written->text("revolute, prismatic or fixed");
    if (text == "revolute") {
        return joint_type::revolute;
    }
    if (text == "prismatic") {
        return joint_type::prismatic;
    }
    if (text != "fixed") {
        written->reject("revolute, prismatic or fixed");
    }
    return joint_type::fixed;
}

/// `key` holds the joint variable when `of_joint` is set, and then has no default.
expression_text read_row_entry(const yaml_fields& row, const std::string& key, bool of_joint) {
    if (of_joint) {
        return read_expression(row.require(key, "an expression of q such as \"q\" or \"q + pi/2\""));
    }
    const auto written = row.find(key);
    return written ? read_expression(*written) : expression_text{"0", in_field(row.where(), key)};
}

joint_limits read_limits(const yaml_value& written) {
    const yaml_fields fields(written, {"position", "velocity", "effort"});
    joint_limits limits;
    if (const auto position = fields.find("position")) {
        const auto bounds = position->items("a list [lowest, highest]");
        if (bounds.size() != 2) {
            throw input_error(position->where(),
                              "expected a list [lowest, highest], got " + std::to_string(bounds.size()) + " entries");
        }
        limits.position = {bounds[0].number(), bounds[1].number()};
        if (limits.position->first >= limits.position->second) {
            throw input_error(position->where(), "expected [lowest, highest] with the lowest first");
        }
    }
    if (const auto velocity = fields.find("velocity")) {
        limits.velocity = velocity->positive_number();
    }
    if (const auto effort = fields.find("effort")) {
        limits.effort = effort->positive_number();
    }
    return limits;
}

/// A row as written: the antecedent is still a name.
struct written_joint {
    joint_description joint;
    std::string antecedent;  ///< empty: the row before
    input_location antecedent_where;
};

void read_drive(const yaml_fields& row, joint_description& joint) {
    const auto limits = row.find("limits");
    const auto gain = row.find("drive_gain");
    if (joint.type == joint_type::fixed && (limits || gain)) {
        throw input_error((limits ? limits : gain)->where(), "a fixed joint has no limits and no drive_gain");
    }
    if (limits) {
        joint.limits = read_limits(*limits);
    }
    if (gain) {
        joint.drive_gain = gain->number();
        if (*joint.drive_gain == 0.0) {
            gain->reject("a number other than zero");
        }
    }
}

written_joint read_joint(const yaml_value& written, std::size_t number) {
    const yaml_fields row(written, {"name", "type", "antecedent", "gamma", "b", "alpha", "d", "theta", "r", "massless",
                                    "limits", "drive_gain"});
    written_joint result;
    joint_description& joint = result.joint;
    joint.where = written.where();
    const auto name = row.find("name");
    joint.name = name ? checked_name(name->text("a joint name"), name->where()) : "j" + std::to_string(number);
    joint.type = read_type(row);
    if (const auto antecedent = row.find("antecedent")) {
        result.antecedent = antecedent->text("the name of a joint, or base");
        result.antecedent_where = antecedent->where();
    }
    joint.gamma = read_row_entry(row, "gamma", false);
    joint.b = read_row_entry(row, "b", false);
    joint.alpha = read_row_entry(row, "alpha", false);
    joint.d = read_row_entry(row, "d", false);
    joint.theta = read_row_entry(row, "theta", joint.type == joint_type::revolute);
    joint.r = read_row_entry(row, "r", joint.type == joint_type::prismatic);
    if (const auto massless = row.find("massless")) {
        joint.massless = read_flag(*massless);
    }
    read_drive(row, joint);
    return result;
}

std::vector<written_joint> read_rows(const yaml_value& written) {
    const auto items = written.items("a list of joints such as [{alpha: 0, d: 0, theta: q, r: 0}]");
    if (items.empty()) {
        throw input_error(written.where(), "expected at least one joint, got an empty list");
    }
    if (items.size() > most_joints) {
        throw input_error(written.where(), "expected at most " + std::to_string(most_joints) + " joints, got " +
                                               std::to_string(items.size()));
    }
    std::vector<written_joint> rows;
    std::map<std::string, int> lines;
    for (const yaml_value& item : items) {
        rows.push_back(read_joint(item, rows.size() + 1));
        const joint_description& joint = rows.back().joint;
        const auto [first, is_new] = lines.emplace(joint.name, joint.where.line);
        if (!is_new) {
            throw input_error(in_field(joint.where, "name"),
                              "joint " + quote(joint.name) + " is already on line " + std::to_string(first->second));
        }
    }
    if (std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.joint.type == joint_type::fixed; })) {
        throw input_error(written.where(), "every joint is fixed, expected a revolute or prismatic one");
    }
    return rows;
}

/// Index of the antecedent of each row among the rows as written.
std::vector<int> antecedent_rows(const std::vector<written_joint>& rows) {
    std::map<std::string, int> index;
    for (const written_joint& row : rows) {
        index.emplace(row.joint.name, static_cast<int>(index.size()));
    }
    std::vector<int> antecedents;
    for (const written_joint& row : rows) {
        if (row.antecedent.empty()) {
            antecedents.push_back(static_cast<int>(antecedents.size()) - 1);
        } else if (row.antecedent == "base") {
            antecedents.push_back(base_link);
        } else if (const auto found = index.find(row.antecedent); found != index.end()) {
            antecedents.push_back(found->second);
        } else {
            throw input_error(row.antecedent_where,
                              "expected the name of a joint, or base, got " + quote(row.antecedent));
        }
    }
    return antecedents;
}

/// Follows antecedents from an unplaced row until one comes again, and throws with the cycle in that direction.
[[noreturn]] void refuse_cycle(const std::vector<written_joint>& rows, const std::vector<int>& antecedents, int row) {
    std::vector<int> walk;
    while (std::find(walk.begin(), walk.end(), row) == walk.end()) {
        walk.push_back(row);
        row = antecedents[row];
    }
    walk.erase(walk.begin(), std::find(walk.begin(), walk.end(), row));
    const auto first = std::min_element(walk.begin(), walk.end());
    std::rotate(walk.begin(), first, walk.end());
    walk.push_back(walk.front());
    std::string names;
    for (const int step : walk) {
        names += (names.empty() ? "" : " -> ") + rows[step].joint.name;
    }
    throw input_error(in_field(rows[walk.front()].joint.where, "antecedent"), "antecedents form a cycle: " + names);
}

/// Written rows in an order in which antecedents come first; of several that could come next, the one written first.
std::vector<int> order_from_base(const std::vector<written_joint>& rows, const std::vector<int>& antecedents) {
    const int count = static_cast<int>(rows.size());
    std::vector<int> order;
    std::vector<bool> placed(rows.size(), false);
    while (static_cast<int>(order.size()) < count) {
        int next = 0;
        while (next < count && (placed[next] || (antecedents[next] != base_link && !placed[antecedents[next]]))) {
            ++next;
        }
        if (next == count) {
            const auto left = std::find(placed.begin(), placed.end(), false);
            refuse_cycle(rows, antecedents, static_cast<int>(left - placed.begin()));
        }
        placed[next] = true;
        order.push_back(next);
    }
    return order;
}

}  // namespace

ordered_joints read_joints(const yaml_value& written) {
    const std::vector<written_joint> rows = read_rows(written);
    const std::vector<int> antecedents = antecedent_rows(rows);
    ordered_joints result;
    result.written_row = order_from_base(rows, antecedents);
    std::vector<int> place(rows.size(), base_link);
    for (const int row : result.written_row) {
        place[row] = static_cast<int>(result.joints.size());
        result.joints.push_back(rows[row].joint);
        result.joints.back().antecedent = antecedents[row] == base_link ? base_link : place[antecedents[row]];
    }
    return result;
}

}  // namespace idim::generator
