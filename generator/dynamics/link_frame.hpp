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

/// Rotation between the frame of a joint's link and that of its antecedent, in up to three plane rotations with a name
/// for every component in between: Rot(z,gamma) Rot(x,alpha) Rot(z,theta).
class link_frame {
  public:
    link_frame(symbolic_model& model, const kinematic_joint& joint);

    /// Components of a vector of the antecedent's frame in the link's frame; `name` names what has to be computed.
    vector3 to_link(const std::string& name, const vector3& v) const;
    /// Components of a vector of the link's frame in the antecedent's frame.
    vector3 to_antecedent(const std::string& name, const vector3& v) const;
    /// Components of a symmetric matrix of the link's frame in the antecedent's frame.
    symmetric3 to_antecedent(const std::string& name, const symmetric3& m) const;

    /// Origin of the link's frame in the antecedent's frame.
    const vector3& position() const { return position_; }

  private:
    symbolic_model& model_;
    angle_pair gamma_, alpha_, theta_;
    vector3 position_;
};

}  // namespace idim::generator
