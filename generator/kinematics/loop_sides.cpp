#include "kinematics/loop_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace idim::generator {

namespace {

using GiNaC::ex;
using vector = std::array<ex, 3>;
using rotation = std::array<vector, 3>;  ///< rows

constexpr double direction_tolerance = 1e-9;  ///< of a direction and, in metres, of a length

rotation identity() {
    return {vector{1, 0, 0}, vector{0, 1, 0}, vector{0, 0, 1}};
}

rotation about_z(const angle_pair& angle) {
    return {vector{angle.cos, -angle.sin, 0}, vector{angle.sin, angle.cos, 0}, vector{0, 0, 1}};
}

rotation about_x(const angle_pair& angle) {
    return {vector{1, 0, 0}, vector{0, angle.cos, -angle.sin}, vector{0, angle.sin, angle.cos}};
}

rotation transposed(const rotation& m) {
    rotation result;
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = {m[0][i], m[1][i], m[2][i]};
    }
    return result;
}

vector applied(const rotation& m, const vector& v) {
    vector result;
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = (m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2]).expand();
    }
    return result;
}

rotation composed(const rotation& a, const rotation& b) {
    const rotation columns = transposed(b);
    return transposed({applied(a, columns[0]), applied(a, columns[1]), applied(a, columns[2])});
}

bool turns(const kinematic_joint& joint) {
    return joint.type == joint_type::revolute;
}

/// Follows one side link by link.
class side_walk {
  public:
    side_walk(const planar_loop& loop, const kinematic_tree& tree, const GiNaC::exmap& values, const rotation& start)
        : loop_(loop), tree_(tree), values_(values), axes_(start) {}

    loop_side run(const std::vector<int>& joints, const vector& cut) {
        for (const int j : joints) {
            step(j);
        }
        move(cut);
        return std::move(side_);
    }

  private:
    void move(const vector& by) {
        const vector moved = applied(axes_, by);
        side_.segments.back().add({angle_, {moved[0], moved[1]}});
        side_.height += moved[2];
    }

    void step(int index) {
        const kinematic_joint& joint = tree_.joints[static_cast<std::size_t>(index)];
        move(joint.position());
        axes_ = composed(axes_, composed(about_z(joint.gamma), about_x(joint.alpha)));
        if (!turns(joint)) {
            axes_ = composed(axes_, about_z(joint.theta));
            return;
        }
        const int sense = align(joint);
        if (std::find(loop_.passive.begin(), loop_.passive.end(), index) != loop_.passive.end()) {
            side_.passive.push_back(index);
            side_.sense.push_back(sense);
            side_.turned.push_back(angle_);
            side_.segments.emplace_back();
            return;
        }
        if (joint.rates.empty() || !joint.drift.is_zero()) {
            throw input_error(loop_.where,
                              fmt::format("joint {} is moved by another loop, expected joints with angles that are "
                                          "linear in the coordinates beside the passive ones",
                                          joint.name));
        }
        angle_ = (angle_ + sense * joint.angle).expand();
        const angle_pair moving = {GiNaC::cos(joint.angle), GiNaC::sin(joint.angle)};
        for (int quarters = 0; quarters < 4; ++quarters) {
            if (turned(moving, quarters).cos.is_equal(joint.theta.cos)) {
                axes_ = composed(axes_, about_z(turned({}, quarters)));
                return;
            }
        }
    }

    /// The axis has to be the plane's normal, or its opposite; from there on it is so exactly.
    int align(const kinematic_joint& joint) {
        const double z = number_of(axes_[2][2], values_);
        if (std::abs(std::abs(z) - 1.0) > direction_tolerance) {
            throw input_error(loop_.where, fmt::format("the axis of joint {} is not parallel to that of {}, expected "
                                                       "links that move in one plane",
                                                       joint.name, name_of_first()));
        }
        const int sense = z > 0.0 ? 1 : -1;
        axes_[0][2] = axes_[1][2] = axes_[2][0] = axes_[2][1] = 0;
        axes_[2][2] = sense;
        return sense;
    }

    const std::string& name_of_first() const { return tree_.joints[static_cast<std::size_t>(loop_.passive[0])].name; }

    const planar_loop& loop_;
    const kinematic_tree& tree_;
    const GiNaC::exmap& values_;
    rotation axes_;  ///< of the link in those of the plane, before the links have turned by angle_
    ex angle_ = 0;
    loop_side side_{{planar_vector()}, {}, {}, {}, 0};
};

/// Joints from the common link of both sides outward.
std::array<std::vector<int>, 2> ways(const planar_loop& loop, const kinematic_tree& tree) {
    std::array<std::vector<int>, 2> result;
    for (std::size_t side = 0; side < 2; ++side) {
        result[side] = tree.path_to_base(loop.cut[side].link);
        std::reverse(result[side].begin(), result[side].end());
    }
    const auto [a, b] = std::mismatch(result[0].begin(), result[0].end(), result[1].begin(), result[1].end());
    const auto common = a - result[0].begin();
    for (std::vector<int>& way : result) {
        way.erase(way.begin(), way.begin() + common);
    }
    return result;
}

bool passes(const std::vector<int>& way, int joint) {
    return std::find(way.begin(), way.end(), joint) != way.end();
}

/// Axes of the plane in those of the common link: z is the axis of the first joint of a side that turns.
rotation plane_axes(const std::vector<int>& way, const kinematic_tree& tree) {
    rotation axes = identity();
    for (const int j : way) {
        const kinematic_joint& joint = tree.joints[static_cast<std::size_t>(j)];
        axes = composed(axes, composed(about_z(joint.gamma), about_x(joint.alpha)));
        if (turns(joint)) {
            break;
        }
        axes = composed(axes, about_z(joint.theta));
    }
    return axes;
}

void check_heights(const planar_loop& loop, const kinematic_tree& tree, const ex& gap, const GiNaC::exmap& values) {
    GiNaC::exmap zero;
    for (const GiNaC::symbol& q : tree.q) {
        zero[q] = 0;
        if (std::abs(number_of(gap.diff(q), values)) > direction_tolerance) {
            throw input_error(loop.cut_where,
                              fmt::format("coordinate {} moves the two points of the cut out of the plane of the links",
                                          q.get_name()));
        }
    }
    const double height = number_of(gap.subs(zero), values);
    if (std::abs(height) > direction_tolerance) {
        throw input_error(loop.cut_where,
                          fmt::format("the two points of the cut are {:.6g} m apart along the axis of joint {}, "
                                      "expected points in one plane across it",
                                      std::abs(height), tree.joints[static_cast<std::size_t>(loop.passive[0])].name));
    }
}

}  // namespace

loop_sides walk_sides(const planar_loop& loop, const kinematic_tree& tree, const GiNaC::exmap& values) {
    const std::array<std::vector<int>, 2> way = ways(loop, tree);
    for (const int joint : loop.passive) {
        if (!passes(way[0], joint) && !passes(way[1], joint)) {
            throw input_error(loop.passive_where,
                              fmt::format("joint {} is not in the loop, expected passive joints between the links of "
                                          "the cut",
                                          tree.joints[static_cast<std::size_t>(joint)].name));
        }
    }
    const std::size_t first = passes(way[0], loop.passive[0]) ? 0 : 1;
    const rotation start = transposed(plane_axes(way[first], tree));
    const auto side = [&](std::size_t s) {
        return side_walk(loop, tree, values, start).run(way[s], loop.cut[s].point);
    };
    loop_sides result{side(first), side(1 - first)};
    check_heights(loop, tree, (result.first.height - result.second.height).expand(), values);
    return result;
}

}  // namespace idim::generator
