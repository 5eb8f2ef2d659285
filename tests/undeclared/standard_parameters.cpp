#include "undeclared/standard_parameters.hpp"

#include <fmt/format.h>

#include <Eigen/Core>

namespace idim::undeclared {

std::string standard_parameters_text(const arm& robot) {
    std::string text;
    for (int j = 1; j <= robot.dof(); ++j) {
        const solid& link = robot.links[static_cast<std::size_t>(j - 1)];
        const drive& one = robot.drives[static_cast<std::size_t>(j - 1)];
        const Eigen::Vector3d& c = link.centre;
        const Eigen::Matrix3d J =
            link.central_inertia + link.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
        text += fmt::format("XX{0}: {1}\nXY{0}: {2}\nXZ{0}: {3}\nYY{0}: {4}\nYZ{0}: {5}\nZZ{0}: {6}\n", j, J(0, 0),
                            J(0, 1), J(0, 2), J(1, 1), J(1, 2), J(2, 2));
        text += fmt::format("MX{0}: {1}\nMY{0}: {2}\nMZ{0}: {3}\nM{0}: {4}\n", j, link.mass * c.x(), link.mass * c.y(),
                            link.mass * c.z(), link.mass);
        text += fmt::format("Ia{0}: {1}\nFv{0}: {2}\nFc{0}: {3}\noff{0}: {4}\n", j, one.rotor_inertia, one.viscous,
                            one.coulomb, one.offset);
    }
    return text;
}

}  // namespace idim::undeclared
