#pragma once

#include <array>
#include <string>

namespace idim::generator {

/// What a URDF says of a link's inertia: mass [kg], pose of the inertial frame in the link's frame (origin at the
/// centre of mass [m], fixed-axis roll, pitch, yaw [rad]) and ixx ixy ixz iyy iyz izz [kg m^2] about that origin in its
/// axes.
struct urdf_inertial {
    double mass = 0.0;
    std::array<double, 3> xyz = {0.0, 0.0, 0.0};
    std::array<double, 3> rpy = {0.0, 0.0, 0.0};
    std::array<double, 6> inertia = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
};

/// XX XY XZ YY YZ ZZ [kg m^2], MX MY MZ [kg m], M [kg] of a link about the origin of our frame of it, in its axes
/// (Khalil and Dombre 2002, section 9.2).
using inertial_parameters = std::array<double, 10>;

/// Their names, less the label of the joint.
inline constexpr std::array<const char*, 10> inertial_names = {"XX", "XY", "XZ", "YY", "YZ",
                                                               "ZZ", "MX", "MY", "MZ", "M"};

/// Where a link of a URDF stands in our frame of it, so that parameters go both ways.
struct link_placement {
    std::string link;                                    ///< its name in the URDF
    std::array<std::array<double, 3>, 3> rotation = {};  ///< columns: axes of the URDF's frame in ours
    std::array<double, 3> position = {0.0, 0.0, 0.0};    ///< origin of the URDF's frame in ours [m]
    std::array<double, 3> rpy = {0.0, 0.0, 0.0};         ///< of the inertial frame in the URDF's link frame [rad]
};

/// Parameters in our frame of a link whose inertia the URDF gives. inertial.rpy is used, not that of the placement.
inertial_parameters parameters_of(const urdf_inertial& inertial, const link_placement& placement);

/// The other way; rpy is that of the placement. A link without mass keeps its inertia, about its origin. Throws
/// std::invalid_argument for first moments without a mass, which no URDF can hold.
urdf_inertial inertial_of(const inertial_parameters& parameters, const link_placement& placement);

}  // namespace idim::generator
