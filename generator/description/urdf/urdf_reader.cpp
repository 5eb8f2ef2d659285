#include "description/urdf/urdf_reader.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "description/decimal.hpp"
#include "description/text_file.hpp"
#include "description/urdf/angle_reader.hpp"
#include "description/urdf/xml_element.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t largest_urdf = 16'000'000;
constexpr int no_joint = -1;
constexpr double largest_number = 1e9;

/// Takes what urdfdom says while this object lives, so that nothing is printed.
class urdfdom_messages : public console_bridge::OutputHandler {
  public:
    urdfdom_messages() : previous_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
    ~urdfdom_messages() override { console_bridge::useOutputHandler(previous_); }
    urdfdom_messages(const urdfdom_messages&) = delete;
    urdfdom_messages& operator=(const urdfdom_messages&) = delete;

    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
            errors_.push_back(text);
        }
    }

    const std::vector<std::string>& errors() const { return errors_; }

  private:
    console_bridge::OutputHandler* previous_;
    std::vector<std::string> errors_;
};

/// What urdfdom is given of an element: what moves and what has inertia. Anything else it would refuse a whole robot
/// for, such as a mesh without a file name.
xml_element kinematic_part(const xml_element& element) {
    static const std::map<std::string, std::string> kept_children = {
        {"robot", " link joint "},
        {"link", " inertial "},
        {"inertial", " origin mass inertia "},
        {"joint", " origin axis parent child limit dynamics mimic "}};
    xml_element result = {element.name, element.line, element.attributes, {}};
    const auto kept = kept_children.find(element.name);
    for (const xml_element& child : element.children) {
        if (kept != kept_children.end() && kept->second.find(" " + child.name + " ") != std::string::npos) {
            result.children.push_back(kinematic_part(child));
        }
    }
    return result;
}

/// Numbers beyond this have no meaning for a robot, and their products may not be representable.
double checked(double value, const input_location& where) {
    if (std::abs(value) > largest_number) {
        throw input_error(where, "a number beyond 1e9, expected SI units");
    }
    return value;
}

std::array<double, 3> checked(const urdf::Vector3& v, const input_location& where) {
    return {checked(v.x, where), checked(v.y, where), checked(v.z, where)};
}

double not_negative(double value, const input_location& where, const char* what) {
    if (value < 0.0) {
        throw input_error(where, std::string("negative ") + what + ", expected zero or more");
    }
    return checked(value, where);
}

/// "a" -> "b" -> "a", the middle left out where it is long.
std::string cycle_text(const std::vector<std::string>& names) {
    constexpr std::size_t most_names = 6;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most_names); ++i) {
        text += quote(names[i]) + " -> ";
    }
    return text + (names.size() > most_names ? "... -> " : "") + quote(names.front());
}

/// A message of urdfdom, which may quote whatever the file holds.
std::string printable(std::string message) {
    constexpr std::size_t longest = 200;
    message.resize(std::min(message.size(), longest));
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return message;
}

class urdf_document {
  public:
    explicit urdf_document(const std::string& file) : file_(file) {
        tree_.file = file;
        root_ = read_xml(read_text_file(file, largest_urdf), file, urdf_limits);
    }

    urdf_tree read() {
        check_root();
        list_elements();
        link_up();
        find_root();
        refuse_cycles();
        read_values();
        resolve_mimics();
        for (const std::string& note : angles_.notes()) {
            tree_.notes.push_back(note);
        }
        return std::move(tree_);
    }

  private:
    input_location at(const xml_element& element) const { return {file_, element.line, ""}; }

    void check_root() {
        if (root_.name != "robot") {
            throw input_error(at(root_), "expected a URDF, <robot name=\"...\">, got element " + quote(root_.name));
        }
        const std::string* name = root_.attribute("name");
        if (name == nullptr) {
            throw input_error(at(root_), "robot has no name, expected <robot name=\"...\">");
        }
        tree_.name = *name;
        for (const xml_element& child : root_.children) {
            if (child.name.starts_with("xacro:")) {
                throw input_error(at(child), "macros are not expanded, expected a URDF written by xacro");
            }
        }
    }

    void list_elements() {
        for (const xml_element& element : root_.children) {
            const bool is_link = element.name == "link";
            if (!is_link && element.name != "joint") {
                continue;
            }
            const std::string* name = element.attribute("name");
            if (name == nullptr || name->empty()) {
                throw input_error(at(element),
                                  element.name + " has no name, expected <" + element.name + " name=\"...\">");
            }
            auto& index = is_link ? link_index_ : joint_index_;
            auto& elements = is_link ? link_elements_ : joint_elements_;
            const auto [first, is_new] = index.emplace(*name, static_cast<int>(elements.size()));
            if (!is_new) {
                throw input_error(at(element),
                                  element.name + " " + quote(*name) + " is already on line " +
                                      std::to_string(elements[static_cast<std::size_t>(first->second)]->line));
            }
            elements.push_back(&element);
            const input_location where = {file_, element.line, element.name + " " + quote(*name)};
            if (is_link) {
                tree_.links.push_back({*name, where, std::nullopt});
            } else {
                tree_.joints.push_back({});
                tree_.joints.back().name = *name;
                tree_.joints.back().where = where;
            }
        }
        if (tree_.links.empty()) {
            throw input_error(at(root_), "robot has no links, expected <link name=\"...\"/>");
        }
    }

    int link_of(std::size_t joint, const char* end) const {
        const xml_element* element = joint_elements_[joint]->child(end);
        const std::string* name = element == nullptr ? nullptr : element->attribute("link");
        if (name == nullptr) {
            throw input_error(tree_.joints[joint].where,
                              std::string("has no ") + end + ", expected <" + end + " link=\"...\"/>");
        }
        const auto found = link_index_.find(*name);
        if (found == link_index_.end()) {
            throw input_error({file_, element->line, tree_.joints[joint].where.field},
                              std::string(end) + " link " + quote(*name) + " is not in the file");
        }
        return found->second;
    }

    void link_up() {
        parent_joint_.assign(tree_.links.size(), no_joint);
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            urdf_joint& joint = tree_.joints[j];
            joint.parent = link_of(j, "parent");
            joint.child = link_of(j, "child");
            int& above = parent_joint_[static_cast<std::size_t>(joint.child)];
            if (above != no_joint) {
                const urdf_joint& other = tree_.joints[static_cast<std::size_t>(above)];
                throw input_error(joint.where, "link " + quote(link_name(joint.child)) +
                                                   " is already the child of joint " + quote(other.name) + ", line " +
                                                   std::to_string(other.where.line) + ": expected a tree");
            }
            above = static_cast<int>(j);
        }
    }

    const std::string& link_name(int link) const { return tree_.links[static_cast<std::size_t>(link)].name; }

    int link_above(int link) const {
        const int joint = parent_joint_[static_cast<std::size_t>(link)];
        return joint == no_joint ? no_joint : tree_.joints[static_cast<std::size_t>(joint)].parent;
    }

    void find_root() {
        int found = no_joint;
        for (std::size_t l = 0; l < tree_.links.size(); ++l) {
            if (parent_joint_[l] != no_joint) {
                continue;
            }
            if (found != no_joint) {
                throw input_error(tree_.links[l].where,
                                  "no joint moves this link nor link " + quote(link_name(found)) + ", line " +
                                      std::to_string(tree_.links[static_cast<std::size_t>(found)].where.line) +
                                      ": expected one root");
            }
            found = static_cast<int>(l);
        }
        tree_.root = found == no_joint ? 0 : found;
    }

    /// A link from which no way leads to the root hangs on a cycle.
    void refuse_cycles() const {
        std::vector<bool> reaches_root(tree_.links.size(), false);
        for (std::size_t l = 0; l < tree_.links.size(); ++l) {
            std::vector<int> walk;
            int link = static_cast<int>(l);
            while (link != no_joint && !reaches_root[static_cast<std::size_t>(link)]) {
                if (walk.size() > tree_.links.size()) {
                    refuse_cycle(link);
                }
                walk.push_back(link);
                link = link_above(link);
            }
            for (const int passed : walk) {
                reaches_root[static_cast<std::size_t>(passed)] = true;
            }
        }
    }

    /// Named from the link of the cycle that comes first in the file.
    [[noreturn]] void refuse_cycle(int on_cycle) const {
        std::vector<int> cycle = {on_cycle};
        for (int link = link_above(on_cycle); link != on_cycle; link = link_above(link)) {
            cycle.insert(cycle.begin(), link);
        }
        std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
        std::vector<std::string> names;
        for (const int link : cycle) {
            names.push_back(link_name(link));
        }
        throw input_error(tree_.links[static_cast<std::size_t>(cycle.front())].where,
                          "links form a cycle: " + cycle_text(names) + ", expected a tree");
    }

    void read_values() {
        urdfdom_messages messages;
        const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(to_string(kinematic_part(root_)));
        if (!model || !messages.errors().empty()) {
            refuse(messages.errors());
        }
        for (std::size_t l = 0; l < tree_.links.size(); ++l) {
            read_link(l, *model->getLink(tree_.links[l].name));
        }
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            read_joint(j, *model->getJoint(tree_.joints[j].name));
        }
    }

    /// urdfdom's first message, with the place of the first joint or link that its messages name in brackets.
    [[noreturn]] void refuse(const std::vector<std::string>& errors) const {
        const std::string message = "not URDF: " + (errors.empty() ? "expected a tree" : printable(errors.front()));
        for (const std::string& error : errors) {
            for (std::size_t open = error.find('['); open != std::string::npos; open = error.find('[', open + 1)) {
                const std::string name = error.substr(open + 1, error.find(']', open) - open - 1);
                const auto joint = joint_index_.find(name);
                const auto link = link_index_.find(name);
                if (joint != joint_index_.end() || link != link_index_.end()) {
                    throw input_error(joint != joint_index_.end()
                                          ? tree_.joints[static_cast<std::size_t>(joint->second)].where
                                          : tree_.links[static_cast<std::size_t>(link->second)].where,
                                      message);
                }
            }
        }
        throw input_error({file_, 0, ""}, message);
    }

    std::array<double, 3> read_angles(const xml_element& element, const std::string& field) {
        std::array<double, 3> rpy = {0.0, 0.0, 0.0};
        const xml_element* origin = element.child("origin");
        const std::string* written = origin == nullptr ? nullptr : origin->attribute("rpy");
        if (written != nullptr) {
            std::istringstream words(*written);
            for (double& angle : rpy) {
                std::string word;
                words >> word;
                angle = angles_.read(word, {file_, origin->line, field});
            }
        }
        return rpy;
    }

    void read_link(std::size_t index, const urdf::Link& source) {
        urdf_link& link = tree_.links[index];
        if (!source.inertial) {
            return;
        }
        const urdf::Inertial& given = *source.inertial;
        urdf_inertial inertial;
        inertial.mass = not_negative(given.mass, link.where, "mass");
        inertial.xyz = checked(given.origin.position, link.where);
        inertial.rpy = read_angles(*link_elements_[index]->child("inertial"), link.where.field);
        inertial.inertia = {given.ixx, given.ixy, given.ixz, given.iyy, given.iyz, given.izz};
        for (const double entry : inertial.inertia) {
            checked(entry, link.where);
        }
        const bool is_zero =
            std::all_of(inertial.inertia.begin(), inertial.inertia.end(), [](double i) { return i == 0.0; });
        if (given.mass > 0.0 || !is_zero) {
            link.inertial = inertial;
        }
    }

    static urdf_joint_type type_of(const urdf::Joint& joint) {
        switch (joint.type) {
            case urdf::Joint::REVOLUTE:
            case urdf::Joint::CONTINUOUS:
                return urdf_joint_type::revolute;
            case urdf::Joint::PRISMATIC:
                return urdf_joint_type::prismatic;
            case urdf::Joint::PLANAR:
                return urdf_joint_type::planar;
            case urdf::Joint::FLOATING:
                return urdf_joint_type::floating;
            default:
                return urdf_joint_type::fixed;
        }
    }

    void read_joint(std::size_t index, const urdf::Joint& source) {
        urdf_joint& joint = tree_.joints[index];
        joint.type = type_of(source);
        joint.xyz = checked(source.parent_to_joint_origin_transform.position, joint.where);
        joint.rpy = read_angles(*joint_elements_[index], joint.where.field);
        joint.axis = {source.axis.x, source.axis.y, source.axis.z};
        const bool has_axis = joint.type != urdf_joint_type::fixed && joint.type != urdf_joint_type::floating;
        if (has_axis && joint.axis == std::array<double, 3>{0.0, 0.0, 0.0}) {
            throw input_error(joint.where, "axis is zero, expected a direction");
        }
        if (source.limits) {
            read_limits(joint, *source.limits, source.type != urdf::Joint::CONTINUOUS);
        }
        if (source.dynamics) {
            joint.damping = not_negative(source.dynamics->damping, joint.where, "damping");
            joint.friction = not_negative(source.dynamics->friction, joint.where, "friction");
        }
        if (source.mimic) {
            read_mimic(index, *source.mimic);
        }
    }

    /// Zero is what writers put where they know no limit.
    static void read_limits(urdf_joint& joint, const urdf::JointLimits& source, bool of_position) {
        if (of_position && source.lower > source.upper) {
            throw input_error(joint.where, "lower limit above the upper one");
        }
        if (of_position && source.lower < source.upper) {
            joint.limits.position = {source.lower, source.upper};
        }
        if (not_negative(source.velocity, joint.where, "velocity limit") > 0.0) {
            joint.limits.velocity = source.velocity;
        }
        if (not_negative(source.effort, joint.where, "effort limit") > 0.0) {
            joint.limits.effort = source.effort;
        }
    }

    static bool has_one_axis(const urdf_joint& joint) {
        return joint.type == urdf_joint_type::revolute || joint.type == urdf_joint_type::prismatic;
    }

    void read_mimic(std::size_t index, const urdf::JointMimic& source) {
        urdf_joint& joint = tree_.joints[index];
        if (!has_one_axis(joint)) {
            throw input_error(joint.where, "mimics another joint, expected a revolute, continuous or prismatic joint");
        }
        const auto found = joint_index_.find(source.joint_name);
        if (found == joint_index_.end()) {
            throw input_error(joint.where, "mimics joint " + quote(source.joint_name) + ", which is not in the file");
        }
        if (source.multiplier == 0.0) {
            throw input_error(joint.where, "mimics with multiplier 0, expected another number (or a fixed joint)");
        }
        const xml_element* element = joint_elements_[index]->child("mimic");
        const std::string* offset = element->attribute("offset");
        const bool is_angle = joint.type == urdf_joint_type::revolute && offset != nullptr;
        joint.mimic = {found->second, source.multiplier,
                       is_angle ? angles_.read(*offset, {file_, element->line, joint.where.field}) : source.offset};
    }

    urdf_joint& joint_at(int index) { return tree_.joints[static_cast<std::size_t>(index)]; }

    /// Each mimic joint follows its chain to the joint that is driven.
    void resolve_mimics() {
        std::vector<bool> is_resolved(tree_.joints.size(), false);
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            std::vector<int> chain;
            int joint = static_cast<int>(j);
            while (joint_at(joint).mimic && !is_resolved[static_cast<std::size_t>(joint)]) {
                if (const auto first = std::find(chain.begin(), chain.end(), joint); first != chain.end()) {
                    refuse_mimics({first, chain.end()});
                }
                chain.push_back(joint);
                joint = joint_at(joint).mimic->joint;
            }
            for (; !chain.empty(); chain.pop_back()) {
                resolve_mimic(joint_at(chain.back()));
                is_resolved[static_cast<std::size_t>(chain.back())] = true;
            }
        }
    }

    /// The joint that `joint` mimics is driven, or resolved itself.
    void resolve_mimic(urdf_joint& joint) {
        urdf_mimic& own = *joint.mimic;
        const urdf_joint& master = joint_at(own.joint);
        if (!has_one_axis(master)) {
            throw input_error(joint.where, "mimics joint " + quote(master.name) +
                                               ", expected a revolute, continuous or prismatic joint");
        }
        if (master.mimic) {
            const decimal factor = decimal_of(own.multiplier);
            const decimal offset = decimal_of(own.offset) + factor * decimal_of(master.mimic->offset);
            own = {master.mimic->joint, nearest_double(factor * decimal_of(master.mimic->multiplier)),
                   nearest_double(offset)};
        }
        checked(own.multiplier, joint.where);
        checked(1.0 / own.multiplier, joint.where);
        checked(own.offset, joint.where);
    }

    [[noreturn]] void refuse_mimics(const std::vector<int>& cycle) {
        std::vector<std::string> names;
        for (const int joint : cycle) {
            names.push_back(joint_at(joint).name);
        }
        throw input_error(joint_at(cycle.front()).where,
                          "joints mimic each other: " + cycle_text(names) + ", expected one that is driven");
    }

    const std::string& file_;
    xml_element root_;
    urdf_tree tree_;
    std::map<std::string, int> link_index_, joint_index_;
    std::vector<const xml_element*> link_elements_, joint_elements_;
    std::vector<int> parent_joint_;
    angle_reader angles_;
};

}  // namespace

urdf_tree read_urdf(const std::string& file) {
    return urdf_document(file).read();
}

}  // namespace idim::generator
