#include "description/robot_description.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <tuple>

#include "description/identifier.hpp"
#include "description/loop_reader.hpp"
#include "description/urdf_robot.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::string_view header_ending = ".hpp";

constexpr std::size_t most_joints = 200;
constexpr std::size_t most_effects = 1000;
constexpr int base = -1;

input_location in_field(const input_location& parent, const std::string& key) {
    return {parent.file, parent.line, parent.field.empty() ? key : parent.field + "." + key};
}

expression_text read_expression(const yaml_value& value) {
    return {value.expression(), value.where()};
}

double read_positive(const yaml_value& value) {
    const double number = value.number();
    if (number <= 0.0) {
        value.reject("a positive number");
    }
    return number;
}

bool read_flag(const yaml_value& value) {
    const std::string text = value.text("true or false");
    if (text != "true" && text != "false") {
        value.reject("true or false");
    }
    return text == "true";
}

std::vector<expression_text> default_gravity(const input_location& where) {
    return {{"0", where}, {"0", where}, {"-9.81", where}};
}

std::vector<expression_text> read_gravity(const yaml_fields& robot) {
    std::vector<expression_text> gravity;
    if (const auto written = robot.find("gravity")) {
        for (const yaml_value& entry : written->items("three entries [m/s^2] such as [0, 0, -9.81]")) {
            gravity.push_back(read_expression(entry));
        }
        if (gravity.size() != 3) {
            throw input_error(written->where(), "expected three entries [m/s^2] such as [0, 0, -9.81], got " +
                                                    std::to_string(gravity.size()));
        }
        return gravity;
    }
    return default_gravity(in_field(robot.where(), "gravity"));
}

std::vector<constant_description> read_constants(const yaml_fields& robot) {
    std::vector<constant_description> constants;
    if (const auto written = robot.find("constants")) {
        for (const auto& [name, value] : written->entries("a map of names to numbers or expressions")) {
            constants.push_back({checked_symbol(name, value.where()), read_expression(value)});
        }
    }
    return constants;
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
        limits.velocity = read_positive(*velocity);
    }
    if (const auto effort = fields.find("effort")) {
        limits.effort = read_positive(*effort);
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
            antecedents.push_back(base);
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
        while (next < count && (placed[next] || (antecedents[next] != base && !placed[antecedents[next]]))) {
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

/// The joints in order from the base, and the place each had in the file.
struct ordered_joints {
    std::vector<joint_description> joints;
    std::vector<int> written_row;
};

ordered_joints read_joints(const yaml_value& written) {
    const std::vector<written_joint> rows = read_rows(written);
    const std::vector<int> antecedents = antecedent_rows(rows);
    ordered_joints result;
    result.written_row = order_from_base(rows, antecedents);
    std::vector<int> place(rows.size(), base);
    for (const int row : result.written_row) {
        place[row] = static_cast<int>(result.joints.size());
        result.joints.push_back(rows[row].joint);
        result.joints.back().antecedent = antecedents[row] == base ? base : place[antecedents[row]];
    }
    return result;
}

std::vector<int> driven_joints(const std::vector<joint_description>& joints) {
    std::vector<int> driven;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (has_own_coordinate(joints[j])) {
            driven.push_back(static_cast<int>(j));
        }
    }
    return driven;
}

std::vector<int> read_joint_names(const yaml_value& written, const std::vector<joint_description>& joints) {
    const auto items = written.items("a list of joint names such as [" + joints.front().name + "]");
    if (items.empty() || items.size() > most_joints) {
        throw input_error(written.where(), "expected between 1 and " + std::to_string(most_joints) +
                                               " joint names, got " + std::to_string(items.size()));
    }
    std::vector<int> indices;
    for (const yaml_value& item : items) {
        const std::string name = item.text("a joint name");
        const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& j) { return j.name == name; });
        if (found == joints.end()) {
            item.reject("the name of a joint of this robot");
        }
        if (found->type == joint_type::fixed) {
            throw input_error(item.where(), "joint " + quote(name) + " is fixed, expected one that moves");
        }
        indices.push_back(static_cast<int>(found - joints.begin()));
    }
    return indices;
}

void read_from(const yaml_value& written, const std::vector<joint_description>& joints, effect_use& use) {
    use.from = read_joint_names(written, joints);
    if (use.from.size() != use.joints.size()) {
        throw input_error(written.where(), "expected " + std::to_string(use.joints.size()) +
                                               " joint names, one for each of `joints`, got " +
                                               std::to_string(use.from.size()));
    }
    for (std::size_t k = 0; k < use.from.size(); ++k) {
        if (use.from[k] == use.joints[k]) {
            throw input_error(written.where(), "joint " + quote(joints[use.from[k]].name) +
                                                   " is driven by itself, expected another joint");
        }
    }
}

effect_use read_effect_use(const yaml_value& written, const std::vector<joint_description>& joints) {
    effect_use use;
    use.where = written.where();
    use.joints = driven_joints(joints);
    if (written.is_scalar()) {
        use.effect = checked_name(written.text("an effect"), written.where());
        return use;
    }
    if (!written.is_map()) {
        written.reject("the name of an effect or a map {effect, joints, from, shape}");
    }
    const yaml_fields fields(written, {"effect", "joints", "from", "shape"});
    const yaml_value name = fields.require("effect", "the name of an effect");
    use.effect = checked_name(name.text("the name of an effect"), name.where());
    if (const auto names = fields.find("joints")) {
        use.joints = read_joint_names(*names, joints);
    }
    if (const auto from = fields.find("from")) {
        read_from(*from, joints, use);
    }
    if (const auto shape = fields.find("shape")) {
        for (const auto& [key, value] : shape->entries("a map of shape coefficients to numbers")) {
            use.shape[checked_symbol(key, value.where())] = value.number();
        }
    }
    return use;
}

std::vector<effect_use> read_effects(const yaml_fields& robot, const std::vector<joint_description>& joints) {
    std::vector<effect_use> effects;
    const auto written = robot.find("effects");
    if (!written) {
        return effects;
    }
    std::map<std::tuple<std::string, int, int>, int> lines;  // effect, joint, from joint
    const auto items = written->items("a list of effects such as [viscous_friction]");
    if (items.size() > most_effects) {
        throw input_error(written->where(), "expected at most " + std::to_string(most_effects) + " effects, got " +
                                                std::to_string(items.size()));
    }
    for (const yaml_value& item : items) {
        effects.push_back(read_effect_use(item, joints));
        const effect_use& use = effects.back();
        for (std::size_t k = 0; k < use.joints.size(); ++k) {
            const int from = use.from.empty() ? base : use.from[k];
            const auto [first, is_new] = lines.emplace(std::tuple(use.effect, use.joints[k], from), use.where.line);
            if (!is_new) {
                throw input_error(use.where, "effect " + quote(use.effect) + " is already on joint " +
                                                 quote(joints[use.joints[k]].name) + ", line " +
                                                 std::to_string(first->second));
            }
        }
    }
    return effects;
}

/// One number per driven joint in the order of the model; `written` holds one for all, or a list in the order of the
/// file.
std::vector<double> read_per_joint(const yaml_value& written, const ordered_joints& ordered) {
    const std::vector<int> driven = driven_joints(ordered.joints);
    if (written.is_scalar()) {
        return std::vector<double>(driven.size(), written.number());
    }
    const auto items = written.items("a number or a list of numbers");
    if (items.size() != driven.size()) {
        throw input_error(written.where(), "expected one number or a list of " + std::to_string(driven.size()) +
                                               ", one for each joint that moves, got " + std::to_string(items.size()));
    }
    std::vector<int> rows;
    for (const int joint : driven) {
        rows.push_back(ordered.written_row[joint]);
    }
    std::vector<double> values;
    for (const int row : rows) {
        const auto rank = std::count_if(rows.begin(), rows.end(), [&](int other) { return other < row; });
        values.push_back(items[static_cast<std::size_t>(rank)].number());
    }
    return values;
}

/// A name, or one with .hpp: a header beside the description.
std::string read_law(const yaml_value& value) {
    const std::string law = value.text("the name of a control law, or of a header such as my_law.hpp");
    checked_name(law.ends_with(header_ending) ? law.substr(0, law.size() - header_ending.size()) : law, value.where());
    return law;
}

std::optional<control_description> read_control(const yaml_fields& robot, const ordered_joints& ordered) {
    const auto written = robot.find("control");
    if (!written) {
        return std::nullopt;
    }
    control_description control;
    control.where = written->where();
    for (const auto& [key, value] : written->entries("a map such as {law: pd_cascade, rate: 200, kp: 10, kv: 1}")) {
        if (key == "law") {
            control.law = read_law(value);
        } else if (key == "rate") {
            control.rate = read_positive(value);
        } else if (key == "delay") {
            control.delay = value.number();
            if (control.delay < 0.0) {
                value.reject("a number of seconds, zero or more");
            }
        } else {
            control.values[checked_name(key, value.where())] = read_per_joint(value, ordered);
        }
    }
    if (control.law.empty()) {
        throw input_error(in_field(control.where, "law"), "missing, expected the name of a control law");
    }
    return control;
}

std::map<std::string, double> read_parameters(const yaml_fields& robot) {
    std::map<std::string, double> parameters;
    if (const auto written = robot.find("parameters")) {
        for (const auto& [name, value] : written->entries("a map of parameters to numbers")) {
            parameters[checked_name(name, value.where())] = value.number();
        }
    }
    return parameters;
}

/// Path of the URDF file that a YAML file names, from the folder of the YAML file.
std::string named_urdf(const yaml_fields& robot, const yaml_value& written) {
    if (const auto joints = robot.find("joints")) {
        throw input_error(joints->where(), "the URDF gives the joints, expected one of joints and urdf");
    }
    const std::filesystem::path folder = std::filesystem::path(robot.where().file).parent_path();
    return (folder / written.text("a file such as arm.urdf")).string();
}

/// Takes over what the URDF gives; effects are known by now.
void add_urdf(const urdf_robot& urdf, robot_description& robot) {
    robot.links = urdf.links;
    robot.notes = urdf.notes;
    robot.parameters.insert(urdf.inertial.begin(), urdf.inertial.end());
    for (const effect_use& use : robot.effects) {
        for (const int joint : use.joints) {
            const std::string label = parameter_label(robot.joints, joint);
            if (use.effect == "viscous_friction" && urdf.damping.count(joint) != 0) {
                robot.parameters.emplace("Fv" + label, urdf.damping.at(joint));
            } else if (use.effect == "coulomb_friction" && urdf.friction.count(joint) != 0) {
                robot.parameters.emplace("Fc" + label, urdf.friction.at(joint));
            }
        }
    }
}

robot_description bare_urdf(const std::string& file) {
    const urdf_robot urdf = read_urdf_robot(file);
    robot_description robot;
    robot.urdf_file = file;
    robot.name = urdf.name;
    robot.gravity = default_gravity({file, 0, "gravity"});
    robot.joints = urdf.joints;
    for (const char* effect : {"rotor_inertia", "viscous_friction", "coulomb_friction"}) {
        if (!urdf.actuated.empty()) {
            robot.effects.push_back({effect, urdf.actuated, {}, {}, {file, 0, "effects"}});
        }
    }
    add_urdf(urdf, robot);
    return robot;
}

robot_description read_yaml_robot(const std::string& file) {
    const yaml_value root = read_yaml(file);
    const yaml_fields fields(
        root, {"name", "gravity", "constants", "joints", "loops", "effects", "control", "parameters", "urdf"});
    robot_description robot;
    const auto urdf_file = fields.find("urdf");
    const auto name = urdf_file ? fields.find("name") : fields.require("name", "the name of the robot");
    robot.name = name ? checked_name(name->text("the name of the robot"), name->where()) : "";
    robot.gravity = read_gravity(fields);
    robot.constants = read_constants(fields);
    std::optional<urdf_robot> urdf;
    ordered_joints ordered;
    if (urdf_file) {
        robot.urdf_file = named_urdf(fields, *urdf_file);
        urdf = read_urdf_robot(robot.urdf_file);
        ordered = {urdf->joints, urdf->written_row};
        robot.name = name ? robot.name : urdf->name;
    } else {
        ordered = read_joints(fields.require("joints", "a list of joints"));
    }
    if (const auto loops = fields.find("loops")) {
        robot.loops = read_loops(*loops, ordered.joints);
    }
    robot.joints = ordered.joints;
    robot.effects = read_effects(fields, robot.joints);
    robot.control = read_control(fields, ordered);
    robot.parameters = read_parameters(fields);
    if (urdf) {
        add_urdf(*urdf, robot);
    }
    return robot;
}

}  // namespace

bool is_header(const control_description& control) {
    return control.law.ends_with(header_ending);
}

bool has_own_coordinate(const joint_description& joint) {
    if (joint.type == joint_type::fixed || joint.passive) {
        return false;
    }
    const std::string& text = joint.type == joint_type::revolute ? joint.theta.text : joint.r.text;
    const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = text.find('q'); at != std::string::npos; at = text.find('q', at + 1)) {
        const bool starts = at == 0 || !is_letter(text[at - 1]);
        const bool ends = at + 1 == text.size() || !is_letter(text[at + 1]);
        if (starts && ends) {
            return true;
        }
    }
    return false;
}

std::string link_name(const std::vector<joint_description>& joints, int link) {
    return link < 0 ? "base" : joints[static_cast<std::size_t>(link)].name;
}

std::string parameter_label(const std::vector<joint_description>& joints, int joint) {
    if (!has_own_coordinate(joints[joint])) {
        return "_" + joints[joint].name;
    }
    return std::to_string(1 + std::count_if(joints.begin(), joints.begin() + joint, has_own_coordinate));
}

robot_description read_robot(const std::string& file) {
    const bool is_urdf = std::filesystem::path(file).extension() == ".urdf";
    robot_description robot = is_urdf ? bare_urdf(file) : read_yaml_robot(file);
    robot.file = file;
    return robot;
}

}  // namespace idim::generator
