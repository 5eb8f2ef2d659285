#include "kinematics/planar_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "kinematics/loop_sides.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

constexpr double ratio_tolerance = 1e-9;  ///< of the ratio of two sides

/// The turning of one side of the triangle, about the plane's normal.
struct bar {
    planar_vector segment;  ///< while the passive joint has not turned
    ex square;              ///< of its length
    plane_pair turning;     ///< cosine and sine of the angle by which it turns
    plane_pair side;        ///< the segment so turned
    std::vector<ex> rates;  ///< of the angle per unit velocity of each coordinate
    ex velocity, drift;     ///< of the angle
};

/// A joint's angle in terms of the turning of the bars: sense * (own - carrying).
struct passive_joint {
    int joint = -1;
    int sense = 1;
    bool on_first_bar = false;  ///< carried by it
};

/// Numbers of what is linear in the coordinates.
struct linear_number {
    double constant = 0.0;
    std::vector<double> slopes;

    double at(const std::vector<double>& q) const {
        double sum = constant;
        for (std::size_t k = 0; k < q.size(); ++k) {
            sum += slopes[k] * q[k];
        }
        return sum;
    }
};

class loop_closer {
  public:
    loop_closer(const planar_loop& loop, kinematic_tree& tree)
        : loop_(loop), tree_(tree), values_(values_of_constants(tree)), label_(joint(loop.passive[0]).label) {}

    void run() {
        lay_triangle(walk_sides(loop_, tree_, values_));
        if (is_parallelogram()) {
            if (loop_.assembly != loop_assembly::parallelogram) {
                throw input_error(loop_.assembly_where,
                                  "opposite sides of the loop are equal, expected parallelogram (its crossed form is "
                                  "not modelled)");
            }
            keep_parallel();
            return;
        }
        if (loop_.assembly == loop_assembly::parallelogram) {
            throw input_error(loop_.assembly_where,
                              "opposite sides of the loop are not equal bars, expected 1 or -1 for a loop that is no "
                              "parallelogram");
        }
        check_that_it_closes();
        close();
        differentiate();
        move_joints();
    }

  private:
    kinematic_joint& joint(int index) const { return tree_.joints[static_cast<std::size_t>(index)]; }

    /// From the two sides to r = w - v, with w and v from the two passive joints to the cut; where both are on one side
    /// v is taken the other way.
    void lay_triangle(const loop_sides& sides) {
        const loop_side& first = sides.first;
        const loop_side& second = sides.second;
        between_.add(second.segments[0], 1);
        between_.add(first.segments[0], -1);
        bars_[0].segment = first.segments[1];
        before_first_ = first.turned[0];
        joints_[0] = {first.passive[0], first.sense[0], false};
        const bool in_a_row = first.passive.size() == 2;
        if (in_a_row) {
            bars_[1].segment.add(first.segments[2], -1);
            joints_[1] = {first.passive[1], first.sense[1], true};
        } else {
            bars_[1].segment = second.segments[1];
            joints_[1] = {second.passive[0], second.sense[0], false};
        }
        const bool listed_inward = first.passive[0] != loop_.passive[0];
        const int sense = first.sense[listed_inward ? 1 : 0];
        sense_ = static_cast<int>(loop_.assembly) * sense * (in_a_row && !listed_inward ? -1 : 1);
    }

    ex square_of(const planar_vector& segment, const std::string& name) {
        const plane_pair xy = segment.is_bar(tree_.q) ? segment.terms().front().xy : segment.value();
        const ex square = dot(xy, xy).expand();
        return segment.is_bar(tree_.q) ? square : position(name, square);
    }

    // Parallelograms.

    double length(const plane_pair& constant) const { return std::sqrt(number_of(dot(constant, constant), values_)); }

    bool are_equal(const plane_pair& a, const plane_pair& b) const {
        return std::abs(length(a) - length(b)) <= ratio_tolerance * length(a);
    }

    /// The term of r that turns with the link before the first passive joint, as the second bar does.
    const plane_term* near_term() const {
        const auto& terms = between_.terms();
        const auto found = std::find_if(terms.begin(), terms.end(), [this](const plane_term& term) {
            return (term.angle - before_first_).expand().is_zero();
        });
        return found == terms.end() ? nullptr : &*found;
    }

    bool is_parallelogram() const {
        const auto& terms = between_.terms();
        const auto is_bar = [this](const plane_term& term) {
            planar_vector alone;
            alone.add(term);
            return alone.is_bar(tree_.q);
        };
        if (terms.size() != 2 || !std::all_of(terms.begin(), terms.end(), is_bar) || near_term() == nullptr ||
            !bars_[0].segment.is_bar(tree_.q) || !bars_[1].segment.is_bar(tree_.q)) {
            return false;
        }
        const plane_term& near = *near_term();
        const plane_term& far = &near == &terms[0] ? terms[1] : terms[0];
        return are_equal(far.xy, bars_[0].segment.terms().front().xy) &&
               are_equal(near.xy, bars_[1].segment.terms().front().xy);
    }

    /// An angle that is linear in the coordinates and the constant by which it is turned further.
    struct linear_angle {
        ex angle;
        std::complex<double> further;
        ex offset;  ///< the same as an angle
    };

    /// The turning that makes `from` parallel to `to`.
    linear_angle turning(const plane_term& from, const plane_term& to) const {
        const plane_pair between = product(to.xy, conjugate(from.xy));
        const double x = number_of(between[0], values_);
        const double y = number_of(between[1], values_);
        const ex exact = GiNaC::atan2(between[1].subs(values_), between[0].subs(values_));
        return {(to.angle - from.angle).expand(), std::complex<double>(x, y) / std::hypot(x, y),
                constant_value(exact, loop_.where)};
    }

    void keep_parallel() {
        const plane_term& near = *near_term();
        const auto& terms = between_.terms();
        const plane_term& far = &near == &terms[0] ? terms[1] : terms[0];
        const linear_angle first = turning(bars_[0].segment.terms().front(), far);
        const linear_angle second = turning(bars_[1].segment.terms().front(), {near.angle, ex(-1) * near.xy});
        set_linear(joints_[0], first);
        set_linear(joints_[1], joints_[1].on_first_bar ? linear_angle{(second.angle - first.angle).expand(),
                                                                      second.further * std::conj(first.further),
                                                                      second.offset - first.offset}
                                                       : second);
    }

    void set_linear(const passive_joint& passive, const linear_angle& turned_by) const {
        kinematic_joint& moved = joint(passive.joint);
        const ex variable = (passive.sense * turned_by.angle).expand();
        for (std::size_t k = 0; k < tree_.q.size(); ++k) {
            const ex factor = variable.diff(tree_.q[k]);
            if (!factor.is_zero()) {
                moved.rates.push_back({static_cast<int>(k), factor});
            }
        }
        // One of four quarter turns, or an angle of its own.
        const double quarters = std::arg(turned_by.further) * passive.sense / (M_PI / 2);
        const bool is_quarter = std::abs(quarters - std::round(quarters)) < ratio_tolerance;
        const int turns = is_quarter ? (static_cast<int>(std::round(quarters)) + 4) % 4 : 0;
        const ex offset = is_quarter ? turns * GiNaC::Pi / 2 : passive.sense * turned_by.offset;
        moved.angle = is_quarter ? variable : variable + offset;
        moved.theta = turned({GiNaC::cos(moved.angle), GiNaC::sin(moved.angle)}, turns);
        moved.variable = variable + constant_value(offset, loop_.where);
    }

    // All others.

    linear_number linear(const ex& value) const {
        linear_number result;
        GiNaC::exmap zero;
        for (const GiNaC::symbol& q : tree_.q) {
            zero[q] = 0;
            result.slopes.push_back(number_of(value.diff(q), values_));
        }
        result.constant = number_of(value.subs(zero), values_);
        return result;
    }

    /// Length of a segment as a function of the coordinates.
    class segment_length {
      public:
        segment_length(const loop_closer& closer, const planar_vector& segment) {
            for (const plane_term& term : segment.terms()) {
                terms_.push_back({closer.linear(term.angle), closer.linear(term.xy[0]), closer.linear(term.xy[1])});
            }
        }
        double at(const std::vector<double>& q) const {
            std::complex<double> sum = 0.0;
            for (const auto& [angle, x, y] : terms_) {
                sum += std::complex<double>(x.at(q), y.at(q)) * std::polar(1.0, angle.at(q));
            }
            return std::abs(sum);
        }

      private:
        std::vector<std::array<linear_number, 3>> terms_;
    };

    void check_that_it_closes() const {
        if (between_.terms().empty() || bars_[0].segment.terms().empty() || bars_[1].segment.terms().empty()) {
            throw input_error(loop_.where,
                              "two of the passive joints and the cut lie in one axis, expected a triangle");
        }
        const segment_length r(*this, between_);
        const segment_length w(*this, bars_[0].segment);
        const segment_length v(*this, bars_[1].segment);
        constexpr int tries = 2000;
        std::mt19937_64 random(1);
        for (int k = 0; k < tries; ++k) {
            std::vector<double> q;
            for (const auto& [low, high] : loop_.ranges) {
                q.push_back(low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53));
            }
            std::array<double, 3> sides = {r.at(q), w.at(q), v.at(q)};
            std::sort(sides.begin(), sides.end());
            if (sides[2] < (1.0 - ratio_tolerance) * (sides[0] + sides[1])) {
                return;
            }
        }
        throw input_error(loop_.where,
                          fmt::format("the loop closes at none of {} positions within the limits of the joints: its "
                                      "passive joints and the cut form no triangle",
                                      tries));
    }

    ex define(std::vector<kinematic_definition>& list, const std::string& name, const ex& body) const {
        const ex expanded = body.expand();
        if (GiNaC::is_a<GiNaC::numeric>(expanded) || GiNaC::is_a<GiNaC::symbol>(expanded)) {
            return expanded;
        }
        list.push_back({GiNaC::symbol(name), expanded});
        return list.back().symbol;
    }
    ex position(const std::string& name, const ex& body) const {
        return define(tree_.from_positions, name + label_, body);
    }
    ex velocity(const std::string& name, const ex& body) const {
        return define(tree_.from_velocities, name + label_, body);
    }
    plane_pair position(const std::string& name, const plane_pair& xy) const {
        return {position(name + "x", xy[0]), position(name + "y", xy[1])};
    }
    plane_pair velocity(const std::string& name, const plane_pair& xy) const {
        return {velocity(name + "x", xy[0]), velocity(name + "y", xy[1])};
    }

    void close() {
        bar& w = bars_[0];
        bar& v = bars_[1];
        w.square = square_of(w.segment, "ww");
        v.square = square_of(v.segment, "vv");
        const plane_pair r = position("r", between_.value());
        const ex rr = position("rr", dot(r, r));
        const ex k = position("k", (w.square + rr - v.square) / 2);
        const ex area = position("disc", w.square * rr - k * k);
        twice_area_ = position("D", sense_ * GiNaC::sqrt(area));
        per_area_ = position("Dinv", GiNaC::pow(twice_area_, -1));
        const ex per_rr = position("rrinv", GiNaC::pow(rr, -1));
        const ex along = position("kr", k * per_rr);
        const ex across = position("Dr", twice_area_ * per_rr);
        w.side = position("w", along * r + across * quarter_turned(r));
        v.side = position("v", w.side - r);
        turn(w, "Ew");
        turn(v, "Ev");
        tree_.closures.push_back(position("closure", area * GiNaC::pow(w.square * v.square, -1)));
    }

    /// The quotient of a side and its segment as complex numbers.
    void turn(bar& of, const std::string& name) const {
        const plane_pair unit = position(name + "0", GiNaC::pow(of.square, -1) * of.segment.value());
        of.turning = position(name, product(of.side, conjugate(unit)));
    }

    /// A derivative of the segment, in the plane after the turning.
    plane_pair turned_derivative(const bar& of, const GiNaC::symbol& q) const {
        if (of.segment.is_bar(tree_.q)) {
            return of.segment.terms().front().angle.diff(q) * quarter_turned(of.side);
        }
        return product(of.turning, of.segment.derivative(q));
    }

    /// Acceleration of a side while no coordinate accelerates, less what turning it faster adds.
    plane_pair acceleration(const bar& of, const std::string& name) const {
        if (of.segment.is_bar(tree_.q)) {
            const ex angle = of.segment.terms().front().angle;
            const ex rate = velocity(name + "rate", of.velocity + time_derivative(angle, tree_.q, tree_.qd));
            return -velocity(name + "square", rate * rate) * of.side;
        }
        const plane_pair moving = velocity(name + "along", product(of.turning, of.segment.velocity(tree_.q, tree_.qd)));
        const plane_pair still = product(of.turning, velocity(name + "still", of.segment.drift(tree_.q, tree_.qd)));
        const ex square = velocity(name + "square", of.velocity * of.velocity);
        return still + (2 * of.velocity) * quarter_turned(moving) - square * of.side;
    }

    void differentiate() {
        bar& w = bars_[0];
        bar& v = bars_[1];
        for (std::size_t k = 0; k < tree_.q.size(); ++k) {
            const GiNaC::symbol& q = tree_.q[k];
            const std::string number = std::to_string(k + 1);
            const plane_pair gap =
                position("g" + number, turned_derivative(w, q) - turned_derivative(v, q) - between_.derivative(q));
            w.rates.push_back(rate("Gw" + number, gap, v.side));
            v.rates.push_back(rate("Gv" + number, gap, w.side));
            w.velocity += w.rates.back() * tree_.qd[k];
            v.velocity += v.rates.back() * tree_.qd[k];
        }
        if (w.velocity.is_zero() && v.velocity.is_zero()) {
            throw input_error(loop_.where, "no coordinate moves the loop, expected an active joint in it");
        }
        w.velocity = velocity("wd", w.velocity);
        v.velocity = velocity("vd", v.velocity);
        // One after the other: the order of the definitions is the order of the lines written.
        const plane_pair of_w = acceleration(w, "w");
        const plane_pair of_v = acceleration(v, "v");
        const plane_pair gap = velocity("gd", of_w - of_v - between_.drift(tree_.q, tree_.qd));
        w.drift = velocity("wdd", -per_area_ * velocity("gdv", dot(gap, v.side)));
        v.drift = velocity("vdd", -per_area_ * velocity("gdw", dot(gap, w.side)));
    }

    ex rate(const std::string& name, const plane_pair& gap, const plane_pair& other) const {
        return position(name, -per_area_ * position(name + "g", dot(gap, other)));
    }

    void move_joints() const {
        for (std::size_t i = 0; i < 2; ++i) {
            const passive_joint& passive = joints_[i];
            const bar& own = bars_[i];
            const bool carried = passive.on_first_bar;
            const auto relative = [&](const ex& value, const ex& carrying) {
                return passive.sense * (carried ? value - carrying : value);
            };
            kinematic_joint& moved = joint(passive.joint);
            const plane_pair turning = carried ? product(own.turning, conjugate(bars_[0].turning)) : own.turning;
            moved.theta = {define(tree_.from_positions, "C" + moved.label, turning[0]),
                           define(tree_.from_positions, "S" + moved.label, passive.sense * turning[1])};
            moved.variable = 2 * GiNaC::atan(moved.theta.sin / (1 + moved.theta.cos));
            for (std::size_t k = 0; k < tree_.q.size(); ++k) {
                const ex factor = define(tree_.from_positions, fmt::format("G{}_{}", moved.label, k + 1),
                                         relative(own.rates[k], bars_[0].rates[k]));
                if (!factor.is_zero()) {
                    moved.rates.push_back({static_cast<int>(k), factor});
                }
            }
            moved.drift = define(tree_.from_velocities, "drift" + moved.label, relative(own.drift, bars_[0].drift));
        }
    }

    const planar_loop& loop_;
    kinematic_tree& tree_;
    GiNaC::exmap values_;
    std::string label_;
    planar_vector between_;  ///< r
    std::array<bar, 2> bars_;
    std::array<passive_joint, 2> joints_;
    ex before_first_;  ///< angle of the link before the first passive joint
    int sense_ = 1;    ///< sign of w x v
    ex twice_area_, per_area_;
};

}  // namespace

void close_loop(const planar_loop& loop, kinematic_tree& tree) {
    loop_closer(loop, tree).run();
}

}  // namespace idim::generator
