#include "description/urdf/urdf_robot.hpp"

#include <algorithm>
#include <array>

#include "description/identifier.hpp"
#include "description/urdf/frame_placement.hpp"
#include "description/urdf/urdf_reader.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr std::size_t most_rows = 200;

/// "2*q_j1 + 0.3" and the like: `slope` stands before the sum unless it is one.
std::string linear_text(const std::string& coordinate, const std::string& slope, const std::string& offset) {
    const std::string term = slope == "1" ? coordinate : slope == "-1" ? "-" + coordinate : slope + "*" + coordinate;
    if (offset == "0") {
        return term;
    }
    return offset.front() == '-' ? term + " - " + offset.substr(1) : term + " + " + offset;
}

std::array<double, 3> doubles_of(const decimal_vector& v) {
    return {nearest_double(v[0]), nearest_double(v[1]), nearest_double(v[2])};
}

/// Where a link stands in our frame, both given in the base frame.
link_placement placement_of(const urdf_link& link, const rigid_pose& pose, const axis_frame& frame) {
    rigid_pose ours;
    ours.R << frame.x, frame.z.cross(frame.x), frame.z;
    ours.p = frame.origin;
    const rigid_pose relative = ours.inverse() * pose;
    link_placement placement;
    placement.link = link.name;
    for (int i = 0; i < 3; ++i) {
        placement.rotation[at(i)] = doubles_of(relative.R.row(i).transpose());
    }
    placement.position = doubles_of(relative.p);
    placement.rpy = link.inertial ? link.inertial->rpy : placement.rpy;
    return placement;
}

class robot_builder {
  public:
    explicit robot_builder(const urdf_tree& tree)
        : tree_(tree), axes_(moving_axes(tree)), frames_(place_frames(axes_)) {
        robot_.name = nearest_name(tree.name, 'r', {tree.file, 0, "robot " + quote(tree.name)});
        robot_.notes = tree.notes;
    }

    urdf_robot run() {
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            add_axis(k);
        }
        if (robot_.joints.empty()) {
            throw input_error({tree_.file, 0, ""}, "every joint is fixed, expected one that moves");
        }
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            write_variable(k);
        }
        refuse_like_labels();
        add_parameters();
        note_names();
        note_massless_ends();
        note_nearly_parallel_axes();
        return std::move(robot_);
    }

  private:
    joint_description& add_row(const std::string& name, int urdf_joint, int antecedent) {
        const input_location& where = tree_.joints[at(urdf_joint)].where;
        joint_description row;
        row.name = nearest_name(name, 'j', where);
        const auto [first, is_new] = written_names_.emplace(row.name, name);
        if (!is_new) {
            throw input_error(where, "joints " + quote(first->second) + " and " + quote(name) + " both get the name " +
                                         row.name + ", expected names that differ in letters and digits");
        }
        if (robot_.joints.size() == most_rows) {
            throw input_error(where, "more than " + std::to_string(most_rows) + " joints that move or carry inertia");
        }
        row.antecedent = antecedent;
        row.where = where;
        robot_.joints.push_back(row);
        robot_.written_row.push_back(urdf_joint);
        robot_.links.emplace_back();
        return robot_.joints.back();
    }

    const urdf_link& link_at(int link) const { return tree_.links[at(link)]; }

    void add_axis(std::size_t k) {
        const moving_axis& axis = axes_[k];
        const int antecedent = axis.antecedent == base_link ? base_link : row_[at(axis.antecedent)];
        row_.push_back(static_cast<int>(robot_.joints.size()));
        const mdh_row entries =
            row_between(axis.antecedent == base_link ? axis_frame{} : frames_[at(axis.antecedent)], frames_[k]);
        joint_description& row = add_row(axis.name, axis.joint, antecedent);
        row.type = axis.type;
        row.gamma.text = angle_text(entries.gamma);
        row.b.text = length_text(entries.b);
        row.alpha.text = angle_text(entries.alpha);
        row.d.text = length_text(entries.d);
        row.theta.text = angle_text(entries.theta);
        row.r.text = length_text(entries.r);
        row.limits = axis.is_part ? joint_limits{} : tree_.joints[at(axis.joint)].limits;
        row.massless = axis.links.empty() || !link_at(axis.links.front().link).inertial;
        for (expression_text* entry : {&row.gamma, &row.b, &row.alpha, &row.d, &row.theta, &row.r}) {
            entry->where = row.where;
        }
        zero_.push_back(axis.type == joint_type::revolute ? entries.theta : entries.r);
        place(robot_.joints.size() - 1, k, 0);
        for (std::size_t l = 1; l < axis.links.size(); ++l) {
            if (link_at(axis.links[l].link).inertial) {
                add_fixed(k, l);
            }
        }
    }

    void add_fixed(std::size_t k, std::size_t l) {
        const int joint = axes_[k].links[l].joint;
        add_row(tree_.joints[at(joint)].name, joint, row_[k]).type = joint_type::fixed;
        place(robot_.joints.size() - 1, k, l);
    }

    void place(std::size_t row, std::size_t k, std::size_t l) {
        if (l < axes_[k].links.size()) {
            const carried_link& carried = axes_[k].links[l];
            link_of_row_[row] = carried.link;
            robot_.links[row] = placement_of(link_at(carried.link), carried.pose, frames_[k]);
        }
    }

    /// theta or r holds the offset so far.
    void write_variable(std::size_t k) {
        const moving_axis& axis = axes_[k];
        joint_description& row = robot_.joints[at(row_[k])];
        std::string& entry = axis.type == joint_type::revolute ? row.theta.text : row.r.text;
        if (!axis.follows) {
            entry = linear_text("q", "1", entry);
            if (!axis.is_part) {
                robot_.actuated.push_back(row_[k]);
            }
            return;
        }
        const std::string master = "q_" + robot_.joints[at(row_[at(axis.follows->axis)])].name;
        const std::string slope = length_text(decimal_of(axis.follows->multiplier));
        const std::string offset = axis.type == joint_type::revolute
                                       ? angle_text(zero_[k] + angle_of(axis.follows->offset).radians)
                                       : length_text(zero_[k] + decimal_of(axis.follows->offset));
        entry = linear_text(master, slope, offset);
    }

    /// A base parameter that regroups XX_a is called XX_aR: it would be taken for that of a link _aR.
    void refuse_like_labels() const {
        for (const joint_description& joint : robot_.joints) {
            const auto other = std::find_if(robot_.joints.begin(), robot_.joints.end(),
                                            [&joint](const auto& row) { return row.name == joint.name + "R"; });
            if (other != robot_.joints.end() && !has_own_coordinate(joint) && !has_own_coordinate(*other)) {
                throw input_error(other->where, "the parameters of joints " + quote(written_names_.at(joint.name)) +
                                                    " and " + quote(written_names_.at(other->name)) +
                                                    " would get like names, such as XX_" + joint.name +
                                                    "R, expected another name for one of them");
            }
        }
    }

    void add_parameters() {
        for (const auto& [row, link] : link_of_row_) {
            if (const auto& inertial = link_at(link).inertial) {
                const inertial_parameters values = parameters_of(*inertial, robot_.links[row]);
                for (std::size_t i = 0; i < values.size(); ++i) {
                    robot_.inertial[inertial_names[i] + parameter_label(robot_.joints, static_cast<int>(row))] =
                        values[i];
                }
            }
        }
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            const urdf_joint& joint = tree_.joints[at(axes_[k].joint)];
            if (!axes_[k].is_part && joint.damping) {
                robot_.damping[row_[k]] = *joint.damping;
                robot_.friction[row_[k]] = joint.friction.value_or(0.0);
            }
        }
    }

    void note_names() {
        std::string list;
        const auto add = [&list](const std::string& written, const std::string& name) {
            if (written != name) {
                list += (list.empty() ? "" : "; ") + quote(written) + " as " + name;
            }
        };
        add(tree_.name, robot_.name);
        for (const joint_description& joint : robot_.joints) {
            add(written_names_.at(joint.name), joint.name);
        }
        if (!list.empty()) {
            robot_.notes.push_back("names read as identifiers: " + list);
        }
    }

    /// Coordinates that move nothing with inertia.
    void note_massless_ends() {
        std::vector<bool> moves_inertia(axes_.size(), false);
        for (std::size_t k = axes_.size(); k-- > 0;) {
            const auto& links = axes_[k].links;
            moves_inertia[k] =
                moves_inertia[k] || std::any_of(links.begin(), links.end(), [this](const carried_link& carried) {
                    return link_at(carried.link).inertial.has_value();
                });
            if (axes_[k].antecedent != base_link && moves_inertia[k]) {
                moves_inertia[at(axes_[k].antecedent)] = true;
            }
        }
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            if (!moves_inertia[k] && !axes_[k].follows) {
                const std::string label = parameter_label(robot_.joints, row_[k]);
                robot_.notes.push_back("nothing that joint " + robot_.joints[at(row_[k])].name +
                                       " moves has inertia: no parameters XX" + label + " .. M" + label +
                                       ", and the inertia matrix is singular without a rotor inertia there");
            }
        }
    }

    /// Their frames would lie far off, because the common normal does.
    void note_nearly_parallel_axes() {
        const decimal nearly("1e-3");
        for (const moving_axis& axis : axes_) {
            const decimal_vector before = axis.antecedent == base_link ? decimal_vector(decimal_vector::UnitZ())
                                                                       : axes_[at(axis.antecedent)].direction;
            const decimal sine = before.cross(axis.direction).norm();
            if (axis.antecedent != base_link && sine >= geometric_tolerance && sine < nearly) {
                robot_.notes.push_back("the axes of joints " + axes_[at(axis.antecedent)].name + " and " + axis.name +
                                       " are " + length_text(decimal(sine.str(2))) +
                                       " rad from parallel: more digits of the angles would make them parallel");
            }
        }
    }

    const urdf_tree& tree_;
    std::vector<moving_axis> axes_;
    std::vector<axis_frame> frames_;
    std::vector<int> row_;       ///< of each axis
    std::vector<decimal> zero_;  ///< theta or r of each axis while all joints are at zero
    std::map<std::size_t, int> link_of_row_;
    std::map<std::string, std::string> written_names_;
    urdf_robot robot_;
};

}  // namespace

urdf_robot read_urdf_robot(const std::string& file) {
    const urdf_tree tree = read_urdf(file);
    return robot_builder(tree).run();
}

}  // namespace idim::generator
