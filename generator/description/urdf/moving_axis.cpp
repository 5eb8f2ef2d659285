#include "description/urdf/moving_axis.hpp"

namespace idim::generator {

namespace {

/// The smallest rotation that takes z to `normal`; about x where it is -z.
decimal_matrix smallest_turn(const decimal_vector& normal) {
    const decimal_vector v(-normal[1], normal[0], 0);  // z x normal
    const decimal& cosine = normal[2];
    if (1 + cosine < geometric_tolerance) {
        return decimal_vector(1, -1, -1).asDiagonal();
    }
    decimal_matrix skew;
    skew << 0, 0, v[1], 0, 0, -v[0], -v[1], v[0], 0;
    return decimal_matrix::Identity() + skew + skew * skew / (1 + cosine);
}

class axis_lister {
  public:
    explicit axis_lister(const urdf_tree& tree)
        : tree_(tree),
          pose_(tree.links.size()),
          carrier_(tree.links.size(), base_link),
          joints_of_(tree.links.size()),
          last_axis_(tree.joints.size(), base_link) {
        for (std::size_t j = 0; j < tree.joints.size(); ++j) {
            joints_of_[at(tree.joints[j].parent)].push_back(static_cast<int>(j));
        }
    }

    std::vector<moving_axis> run() {
        place_links();
        const std::vector<int> order = order_of_joints();
        for (const int joint : order) {
            add_axes(joint);
        }
        for (const int joint : order) {
            follow(joint);
        }
        return std::move(axes_);
    }

  private:
    const urdf_joint& joint_at(int joint) const { return tree_.joints[at(joint)]; }

    /// Poses from the root outward, and the joint that carries each link: the next one inward that is not fixed.
    void place_links() {
        std::vector<int> open = {tree_.root};
        while (!open.empty()) {
            const int link = open.back();
            open.pop_back();
            for (const int j : joints_of_[at(link)]) {
                const urdf_joint& joint = joint_at(j);
                pose_[at(joint.child)] = pose_[at(link)] * pose_of(joint.xyz, joint.rpy);
                carrier_[at(joint.child)] = joint.type == urdf_joint_type::fixed ? carrier_[at(link)] : j;
                open.push_back(joint.child);
            }
        }
    }

    /// Joints that move, antecedents first; of several that could come next the one that comes first in the file.
    std::vector<int> order_of_joints() const {
        std::vector<int> order;
        std::vector<bool> is_placed(tree_.joints.size(), false);
        const auto can_come = [&](std::size_t j) {
            const int before = carrier_[at(tree_.joints[j].parent)];
            return !is_placed[j] && tree_.joints[j].type != urdf_joint_type::fixed &&
                   (before == base_link || is_placed[at(before)]);
        };
        for (std::size_t j = 0; j < tree_.joints.size();) {
            if (can_come(j)) {
                order.push_back(static_cast<int>(j));
                is_placed[j] = true;
                j = 0;
            } else {
                ++j;
            }
        }
        return order;
    }

    void add_axes(int index) {
        const urdf_joint& joint = joint_at(index);
        const decimal_matrix frame = pose_[at(joint.child)].R;
        decimal_vector axis;
        axis << decimal_of(joint.axis[0]), decimal_of(joint.axis[1]), decimal_of(joint.axis[2]);
        if (joint.type == urdf_joint_type::planar) {
            const decimal_matrix turned = frame * smallest_turn(axis.normalized());
            add_part(index, "_x", joint_type::prismatic, turned.col(0));
            add_part(index, "_y", joint_type::prismatic, turned.col(1));
            add_part(index, "_yaw", joint_type::revolute, turned.col(2));
        } else if (joint.type == urdf_joint_type::floating) {
            add_part(index, "_x", joint_type::prismatic, frame.col(0));
            add_part(index, "_y", joint_type::prismatic, frame.col(1));
            add_part(index, "_z", joint_type::prismatic, frame.col(2));
            add_part(index, "_yaw", joint_type::revolute, frame.col(2));
            add_part(index, "_pitch", joint_type::revolute, frame.col(1));
            add_part(index, "_roll", joint_type::revolute, frame.col(0));
        } else {
            const bool slides = joint.type == urdf_joint_type::prismatic;
            add_axis(index, joint.name, slides ? joint_type::prismatic : joint_type::revolute,
                     frame * axis.normalized());
        }
        axes_.back().links = links_with(index);
    }

    void add_part(int index, const std::string& suffix, joint_type type, const decimal_vector& direction) {
        add_axis(index, joint_at(index).name + suffix, type, direction);
        axes_.back().is_part = true;
    }

    void add_axis(int index, const std::string& name, joint_type type, const decimal_vector& direction) {
        const urdf_joint& joint = joint_at(index);
        moving_axis axis;
        axis.name = name;
        axis.type = type;
        axis.joint = index;
        axis.point = pose_[at(joint.child)].p;
        axis.direction = direction;
        const int carrier = carrier_[at(joint.parent)];
        const bool is_first = last_axis_[at(index)] == base_link;
        axis.antecedent = !is_first              ? last_axis_[at(index)]
                          : carrier == base_link ? base_link
                                                 : last_axis_[at(carrier)];
        last_axis_[at(index)] = static_cast<int>(axes_.size());
        axes_.push_back(axis);
    }

    /// The child link of a joint that moves, and what is fixed to it, in the order of the file at each link.
    std::vector<carried_link> links_with(int index) const {
        std::vector<carried_link> links = {{joint_at(index).child, index, pose_[at(joint_at(index).child)]}};
        for (std::size_t l = 0; l < links.size(); ++l) {
            for (const int j : joints_of_[at(links[l].link)]) {
                if (joint_at(j).type == urdf_joint_type::fixed) {
                    links.push_back({joint_at(j).child, j, pose_[at(joint_at(j).child)]});
                }
            }
        }
        return links;
    }

    void follow(int index) {
        if (const auto& mimic = joint_at(index).mimic) {
            axes_[at(last_axis_[at(index)])].follows = {last_axis_[at(mimic->joint)], mimic->multiplier, mimic->offset};
        }
    }

    const urdf_tree& tree_;
    std::vector<rigid_pose> pose_;             ///< of each link in the base frame
    std::vector<int> carrier_;                 ///< of each link: a joint, or base_link
    std::vector<std::vector<int>> joints_of_;  ///< that hang on each link
    std::vector<int> last_axis_;               ///< of each joint that moves
    std::vector<moving_axis> axes_;
};

}  // namespace

std::vector<moving_axis> moving_axes(const urdf_tree& tree) {
    return axis_lister(tree).run();
}

}  // namespace idim::generator
