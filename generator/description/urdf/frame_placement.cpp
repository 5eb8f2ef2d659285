#include "description/urdf/frame_placement.hpp"

#include <Eigen/Geometry>
#include <optional>

namespace idim::generator {

namespace {

constexpr int no_axis = -1;

bool are_parallel(const decimal_vector& a, const decimal_vector& b) {
    return a.cross(b).norm() < geometric_tolerance;
}

class frame_placer {
  public:
    explicit frame_placer(const std::vector<moving_axis>& axes)
        : axes_(axes),
          successor_(axes.size(), no_axis),
          is_wrist_(axes.size(), false),
          origin_(axes.size()),
          frames_(axes.size()) {
        for (std::size_t k = axes.size(); k-- > 0;) {
            if (axes[k].antecedent != base_link) {
                successor_[at(axes[k].antecedent)] = static_cast<int>(k);
            }
        }
    }

    std::vector<axis_frame> run() {
        for (std::size_t k = axes_.size(); k-- > 0;) {
            if (successor_[k] != no_axis) {
                place_inward(k, at(successor_[k]));
            }
        }
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            place_outward(k);
        }
        return frames_;
    }

  private:
    spatial_line line(std::size_t k) const { return {origin_[k].value_or(axes_[k].point), axes_[k].direction}; }

    bool is_prismatic(std::size_t k) const { return axes_[k].type == joint_type::prismatic; }

    /// No axis inward turns what is along the axis (revolute), or anything (prismatic): such offsets cost nothing.
    bool is_steady(std::size_t k) const {
        for (int a = axes_[k].antecedent; a != base_link; a = axes_[at(a)].antecedent) {
            if (!is_prismatic(at(a)) &&
                (is_prismatic(k) || !are_parallel(axes_[at(a)].direction, axes_[k].direction))) {
                return false;
            }
        }
        return true;
    }

    /// The origin of axis k where its main successor decides it.
    void place_inward(std::size_t k, std::size_t next) {
        if (is_prismatic(next) && !origin_[next]) {
            return;  // the successor will be laid through this origin
        }
        const common_normal normal = normal_between(line(k), line(next));
        if (is_prismatic(k)) {
            origin_[k] = is_steady(k) ? origin_[next] : std::nullopt;
        } else if (is_steady(k)) {
            if (!normal.parallel || origin_[next]) {
                origin_[k] = foot_on(line(k), line(next));
            }
        } else if (!normal.parallel && abs(normal.length) < geometric_tolerance) {
            join_wrist(k, next, line(k).at(normal.first));
        }
        if (!origin_[k] && !is_prismatic(k) && !normal.parallel && follows_parallel(k)) {
            // An offset along parallel axes costs least before the second of them.
            origin_[k] = line(k).at(normal.first);
        }
    }

    bool follows_parallel(std::size_t k) const {
        const int before = axes_[k].antecedent;
        return before != base_link && !is_prismatic(at(before)) &&
               are_parallel(axes_[at(before)].direction, axes_[k].direction);
    }

    /// Axes k and next meet in `point`; if all axes outward do, it is the origin of them all.
    void join_wrist(std::size_t k, std::size_t next, const decimal_vector& point) {
        if (successor_[next] == no_axis || (is_wrist_[next] && (point - *origin_[next]).norm() < geometric_tolerance)) {
            origin_[k] = origin_[next] = point;
            is_wrist_[k] = is_wrist_[next] = true;
        }
    }

    /// On `axis`, beside the point of `other` where they are parallel.
    static decimal_vector foot_on(const spatial_line& axis, const spatial_line& other) {
        const common_normal normal = normal_between(other, axis);
        return axis.at(normal.second);
    }

    /// What is open yet, and x: the antecedent's frame is complete.
    void place_outward(std::size_t k) {
        const axis_frame antecedent =
            axes_[k].antecedent == base_link ? axis_frame{} : frames_[at(axes_[k].antecedent)];
        if (!origin_[k]) {
            origin_[k] = is_prismatic(k) ? prismatic_origin(k, antecedent) : foot_on(line(k), antecedent.axis());
        }
        frames_[k] = {*origin_[k], normal_direction(antecedent, line(k)), axes_[k].direction};
        turn_to_successor(k);
    }

    /// On the axis laid through the antecedent's origin, or beside it: where the successor's normal starts.
    decimal_vector prismatic_origin(std::size_t k, const axis_frame& antecedent) const {
        spatial_line axis = {antecedent.origin, axes_[k].direction};
        if (successor_[k] == no_axis) {
            return axis.point;
        }
        const std::size_t next = at(successor_[k]);
        if (is_prismatic(next)) {
            return axis.at(axis.direction.dot(target_beyond(next).value_or(axis.point) - axis.point));
        }
        const common_normal normal = normal_between(axis, line(next));
        if (!normal.parallel) {
            return axis.at(normal.first);
        }
        const decimal_vector x = normal_direction(antecedent, axis);
        const decimal_vector across = normal.length * normal.direction;
        const decimal along_x = across.dot(x);
        if ((across - along_x * x).norm() >= geometric_tolerance) {
            axis.point += along_x * x;
        }
        return origin_[next] ? foot_on(axis, line(next)) : axis.point;
    }

    /// The next origin outward that is decided, beyond prismatic axes.
    std::optional<decimal_vector> target_beyond(std::size_t k) const {
        while (is_prismatic(k) && !origin_[k] && successor_[k] != no_axis) {
            k = at(successor_[k]);
        }
        return origin_[k];
    }

    /// x, which is that of theta = 0 so far, along the normal to the successor's axis. A prismatic successor on the
    /// same line cannot turn its own x freely: then along the normal of that one.
    void turn_to_successor(std::size_t k) {
        axis_frame& frame = frames_[k];
        decimal_vector normal = decimal_vector::Zero();
        for (int next = successor_[k]; next != no_axis && normal.isZero(); next = successor_[at(next)]) {
            const bool is_laid_through = !origin_[at(next)] && is_prismatic(at(next));
            const spatial_line axis =
                is_laid_through ? spatial_line{frame.origin, axes_[at(next)].direction} : line(at(next));
            normal = normal_between(frame.axis(), axis).direction;
            if (is_prismatic(k) || !is_prismatic(at(next))) {
                break;
            }
        }
        if (normal.isZero()) {
            return;
        }
        const decimal along = normal.dot(frame.x);
        const bool is_square = abs(along) < geometric_tolerance;
        const decimal sense = is_square ? frame.z.dot(frame.x.cross(normal)) : along;
        frame.x = sense < 0 ? decimal_vector(-normal) : normal;
    }

    const std::vector<moving_axis>& axes_;
    std::vector<int> successor_;  ///< the first axis that moves with each
    std::vector<bool> is_wrist_;  ///< meets all axes outward in its origin
    std::vector<std::optional<decimal_vector>> origin_;
    std::vector<axis_frame> frames_;
};

}  // namespace

std::vector<axis_frame> place_frames(const std::vector<moving_axis>& axes) {
    return frame_placer(axes).run();
}

}  // namespace idim::generator
