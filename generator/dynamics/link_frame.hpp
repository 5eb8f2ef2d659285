#pragma once

#include <array>
#include <string>

#include "dynamics/symbolic_model.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

using vector3 = std::array<GiNaC::ex, 3>;

/// Symmetric 3x3 matrix, in the order of the inertia parameters.
struct symmetric3 {
    GiNaC::ex xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

vector3 cross(const vector3& a, const vector3& b);
GiNaC::ex dot(const vector3& a, const vector3& b);
vector3 add(const vector3& a, const vector3& b);
bool is_zero(const vector3& a);

bool is_identity(const angle_pair& angle);
/// A multiple of a quarter turn: turning by it exchanges components.
bool is_quarter(const angle_pair& angle);

/// A vector turned by the angle about z; named unless it is a mere exchange of components.
vector3 turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle, const vector3& v);
symmetric3 turn_about_z(symbolic_model& model, const std::string& name, const angle_pair& angle, const symmetric3& m);

/// Rotation between the axes of a joint's link and those of its antecedent, in up to three plane rotations with a name
/// for every component in between: Rot(z,gamma) Rot(x,alpha) leads to the axes of the joint, Rot(z,theta) to the
/// link's.
class link_frame {
  public:
    /// `theta` turns from the joint's axes to the link's; `position` is the origin in the antecedent's axes.
    link_frame(symbolic_model& model, const kinematic_joint& joint, const angle_pair& theta, const vector3& position);

    /// Components of a vector of the antecedent's axes in the link's; `name` names what has to be computed.
    vector3 to_link(const std::string& name, const vector3& v) const;
    /// Components of a vector of the link's axes in the antecedent's.
    vector3 to_antecedent(const std::string& name, const vector3& v) const;

    /// The two halves of the way.
    vector3 antecedent_to_joint(const std::string& name, const vector3& v) const;
    vector3 joint_to_antecedent(const std::string& name, const vector3& v) const;
    symmetric3 joint_to_antecedent(const std::string& name, const symmetric3& m) const;
    vector3 joint_to_link(const std::string& name, const vector3& v) const;
    vector3 link_to_joint(const std::string& name, const vector3& v) const;
    symmetric3 link_to_joint(const std::string& name, const symmetric3& m) const;

    /// The joint's axes are the antecedent's but for an exchange of components.
    bool exchanges_axes() const { return is_quarter(gamma_) && is_quarter(alpha_); }
    /// The joint's z axis is parallel to the antecedent's.
    bool keeps_z() const { return alpha_.sin.is_zero(); }
    /// Origin of the link in the antecedent's axes.
    const vector3& position() const { return position_; }

  private:
    symbolic_model& model_;
    angle_pair gamma_, alpha_, theta_;
    vector3 position_;
};

}  // namespace idim::generator
