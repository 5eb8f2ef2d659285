#include "description/urdf/urdf_values.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <sstream>

#include "description/urdf/angle_reader.hpp"
#include "description/urdf/urdf_number.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

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

std::array<double, 3> point_of(const urdf::Vector3& v, const input_location& where) {
    return {bounded(v.x, where), bounded(v.y, where), bounded(v.z, where)};
}

/// A message of urdfdom, which may quote whatever the file holds.
std::string printable(std::string message) {
    constexpr std::size_t longest = 200;
    message.resize(std::min(message.size(), longest));
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return message;
}

class value_reader {
  public:
    value_reader(const xml_element& root, urdf_skeleton& skeleton) : root_(root), skeleton_(skeleton) {}

    void read() {
        urdfdom_messages messages;
        const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(to_string(kinematic_part(root_)));
        if (!model || !messages.errors().empty()) {
            refuse(messages.errors());
        }
        for (std::size_t l = 0; l < tree().links.size(); ++l) {
            read_link(l, *model->getLink(tree().links[l].name));
        }
        for (std::size_t j = 0; j < tree().joints.size(); ++j) {
            read_joint(j, *model->getJoint(tree().joints[j].name));
        }
        for (const std::string& note : angles_.notes()) {
            tree().notes.push_back(note);
        }
    }

  private:
    urdf_tree& tree() { return skeleton_.tree; }
    const urdf_tree& tree() const { return skeleton_.tree; }

    /// urdfdom's first message, with the place of the first joint or link that its messages name in brackets.
    [[noreturn]] void refuse(const std::vector<std::string>& errors) const {
        const std::string message = "not URDF: " + (errors.empty() ? "expected a tree" : printable(errors.front()));
        for (const std::string& error : errors) {
            for (std::size_t open = error.find('['); open != std::string::npos; open = error.find('[', open + 1)) {
                const std::string name = error.substr(open + 1, error.find(']', open) - open - 1);
                const auto joint = skeleton_.joint_index.find(name);
                const auto link = skeleton_.link_index.find(name);
                if (joint != skeleton_.joint_index.end() || link != skeleton_.link_index.end()) {
                    throw input_error(joint != skeleton_.joint_index.end()
                                          ? tree().joints[static_cast<std::size_t>(joint->second)].where
                                          : tree().links[static_cast<std::size_t>(link->second)].where,
                                      message);
                }
            }
        }
        throw input_error({tree().file, 0, ""}, message);
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
                angle = angles_.read(word, {tree().file, origin->line, field});
            }
        }
        return rpy;
    }

    void read_link(std::size_t index, const urdf::Link& source) {
        urdf_link& link = tree().links[index];
        if (!source.inertial) {
            return;
        }
        const urdf::Inertial& given = *source.inertial;
        urdf_inertial inertial;
        inertial.mass = not_negative(given.mass, link.where, "mass");
        inertial.xyz = point_of(given.origin.position, link.where);
        inertial.rpy = read_angles(*skeleton_.link_elements[index]->child("inertial"), link.where.field);
        inertial.inertia = {given.ixx, given.ixy, given.ixz, given.iyy, given.iyz, given.izz};
        for (const double entry : inertial.inertia) {
            bounded(entry, link.where);
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
        urdf_joint& joint = tree().joints[index];
        joint.type = type_of(source);
        joint.xyz = point_of(source.parent_to_joint_origin_transform.position, joint.where);
        joint.rpy = read_angles(*skeleton_.joint_elements[index], joint.where.field);
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

    void read_mimic(std::size_t index, const urdf::JointMimic& source) {
        urdf_joint& joint = tree().joints[index];
        if (!joint.has_one_axis()) {
            throw input_error(joint.where, "mimics another joint, expected a revolute, continuous or prismatic joint");
        }
        const auto found = skeleton_.joint_index.find(source.joint_name);
        if (found == skeleton_.joint_index.end()) {
            throw input_error(joint.where, "mimics joint " + quote(source.joint_name) + ", which is not in the file");
        }
        if (source.multiplier == 0.0) {
            throw input_error(joint.where, "mimics with multiplier 0, expected another number (or a fixed joint)");
        }
        const xml_element* element = skeleton_.joint_elements[index]->child("mimic");
        const std::string* offset = element->attribute("offset");
        const bool is_angle = joint.type == urdf_joint_type::revolute && offset != nullptr;
        joint.mimic = {
            found->second, source.multiplier,
            is_angle ? angles_.read(*offset, {tree().file, element->line, joint.where.field}) : source.offset};
    }

    const xml_element& root_;
    urdf_skeleton& skeleton_;
    angle_reader angles_;
};

}  // namespace

void read_values(const xml_element& root, urdf_skeleton& skeleton) {
    value_reader(root, skeleton).read();
}

}  // namespace idim::generator
