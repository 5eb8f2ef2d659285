#include <fmt/format.h>

#include "dynamics/effect_shape.hpp"
#include "dynamics/effect_terms.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

drive_model& drive_at(std::vector<drive_model>& drives, const kinematic_tree& tree, const effect_use& use, int joint) {
    const kinematic_joint& at = tree.joints[static_cast<std::size_t>(joint)];
    if (at.coordinate < 0) {
        throw input_error(
            use.where,
            fmt::format("effect {} acts on joint {}, expected joints with a drive of their own", use.effect, at.name));
    }
    return drives[static_cast<std::size_t>(at.coordinate)];
}

void set_gain(const effect_use& use, const effect_description& effect, drive_model& drive) {
    const double error = shape_value(use, effect, "Ke");
    if (!(error > -1.0)) {
        throw input_error(use.where, fmt::format("effect {}: Ke = {}, expected more than -1", effect.name, error));
    }
    drive.gain *= 1 + exact_decimal(error, use.where);
}

void set_transmission(const effect_use& use, const effect_description& effect, int coordinate, drive_model& drive) {
    const double stiffness = shape_value(use, effect, "K");
    if (!(stiffness > 0.0)) {
        throw input_error(use.where, fmt::format("effect {}: K = {}, expected more than 0", effect.name, stiffness));
    }
    const double damping = use.shape.count("D") > 0 ? shape_value(use, effect, "D") : 0.0;
    if (!(damping >= 0.0)) {
        throw input_error(use.where, fmt::format("effect {}: D = {}, expected 0 or more", effect.name, damping));
    }
    drive.stiffness = stiffness;
    drive.damping = damping;
    drive.motor = {GiNaC::symbol(fmt::format("qm{}", coordinate + 1)),
                   GiNaC::symbol(fmt::format("qmd{}", coordinate + 1)),
                   GiNaC::symbol(fmt::format("qmdd{}", coordinate + 1))};
}

}  // namespace

std::vector<drive_model> read_drives(const kinematic_tree& tree, const std::vector<effect_use>& uses,
                                     const std::vector<effect_description>& descriptions) {
    std::vector<drive_model> drives(static_cast<std::size_t>(tree.dof()));
    for (std::size_t u = 0; u < uses.size(); ++u) {
        const effect_description& effect = descriptions[u];
        for (const int joint : uses[u].joints) {
            if (effect.kind == effect_kind::gain) {
                set_gain(uses[u], effect, drive_at(drives, tree, uses[u], joint));
            } else if (effect.kind == effect_kind::delay) {
                drive_at(drives, tree, uses[u], joint).delay += shape_value(uses[u], effect, "Td");
            } else if (effect.kind == effect_kind::elasticity) {
                drive_model& drive = drive_at(drives, tree, uses[u], joint);
                set_transmission(uses[u], effect, tree.joints[static_cast<std::size_t>(joint)].coordinate, drive);
            }
        }
    }
    return drives;
}

// The turned vector takes the place of the declared one as numbers of sixty digits: gravity enters the dependences of
// parameters by its direction alone, and a component that the turn leaves zero stays exactly zero.
void tilt_gravity(const std::vector<effect_use>& uses, const std::vector<effect_description>& descriptions,
                  kinematic_tree& tree) {
    for (std::size_t u = 0; u < uses.size(); ++u) {
        if (descriptions[u].kind != effect_kind::tilt) {
            continue;
        }
        const auto angle = [&](const char* shape) -> ex {
            const bool left_out = !uses[u].shape.empty() && uses[u].shape.count(shape) == 0;
            return left_out ? ex(0) : exact_decimal(shape_value(uses[u], descriptions[u], shape), uses[u].where);
        };
        const auto number = [&](const ex& value) -> ex { return constant_value(value, uses[u].where); };
        const ex cx = number(GiNaC::cos(angle("tilt_x")));
        const ex sx = number(GiNaC::sin(angle("tilt_x")));
        const ex cy = number(GiNaC::cos(angle("tilt_y")));
        const ex sy = number(GiNaC::sin(angle("tilt_y")));
        const ex cz = number(GiNaC::cos(angle("tilt_z")));
        const ex sz = number(GiNaC::sin(angle("tilt_z")));
        const auto [x, y, z] = tree.gravity;
        const ex about_x_y = cx * y - sx * z;
        const ex about_x_z = sx * y + cx * z;
        const ex about_y_x = cy * x + sy * about_x_z;
        const ex about_y_z = -sy * x + cy * about_x_z;
        tree.gravity = {(cz * about_y_x - sz * about_x_y).expand(), (sz * about_y_x + cz * about_x_y).expand(),
                        about_y_z.expand()};
    }
}

}  // namespace idim::generator
