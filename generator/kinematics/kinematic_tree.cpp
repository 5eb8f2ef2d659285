#include "kinematics/kinematic_tree.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "graph/rational.hpp"
#include "kinematics/planar_loop.hpp"

namespace idim::generator {

namespace {

using GiNaC::ex;

/// Number of quarter turns if an angle is a multiple of pi/2, otherwise -1.
int quarter_turns(const ex& angle) {
    const ex turns = (angle * 2 / GiNaC::Pi).expand();
    if (!GiNaC::is_a<GiNaC::numeric>(turns) || !GiNaC::ex_to<GiNaC::numeric>(turns).is_integer()) {
        return -1;
    }
    return GiNaC::mod(GiNaC::ex_to<GiNaC::numeric>(turns), 4).to_int();
}

std::string printed(const ex& e) {
    std::ostringstream text;
    text << e;
    return text.str();
}

/// Made of symbols and fractions by + - * / and integer powers alone.
bool is_rational(const ex& e) {
    if (GiNaC::is_a<GiNaC::numeric>(e)) {
        return GiNaC::ex_to<GiNaC::numeric>(e).is_rational();
    }
    if (GiNaC::is_a<GiNaC::power>(e)) {
        return e.op(1).info(GiNaC::info_flags::integer) && is_rational(e.op(0));
    }
    if (GiNaC::is_a<GiNaC::add>(e) || GiNaC::is_a<GiNaC::mul>(e)) {
        return std::all_of(e.begin(), e.end(), is_rational);
    }
    return GiNaC::is_a<GiNaC::symbol>(e);
}

/// Turns the texts of one description into symbolic entries.
class tree_reader {
  public:
    explicit tree_reader(const robot_description& robot) : robot_(robot) { tree_.robot = robot.name; }

    kinematic_tree run() {
        for (const constant_description& constant : robot_.constants) {
            read_constant(constant);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            tree_.gravity[i] = finite(parse_expression(robot_.gravity[i], names_), robot_.gravity[i].where);
        }
        number_coordinates();
        for (const joint_description& joint : robot_.joints) {
            read_joint(joint);
        }
        for (const loop_description& loop : robot_.loops) {
            read_loop(loop);
        }
        tree_.constant_names = names_;
        return std::move(tree_);
    }

  private:
    /// One coordinate for each joint that names its own; others may name it as q_<joint>.
    void number_coordinates() {
        for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
            if (!has_own_coordinate(robot_.joints[j])) {
                continue;
            }
            const std::string name = "q_" + robot_.joints[j].name;
            if (names_.count(name) != 0) {
                throw input_error(robot_.joints[j].where,
                                  fmt::format("constant {} has the name of this joint's coordinate, expected another "
                                              "name for one of them",
                                              name));
            }
            const std::size_t number = tree_.driven.size() + 1;
            tree_.driven.push_back(static_cast<int>(j));
            tree_.q.emplace_back(fmt::format("q{}", number));
            tree_.qd.emplace_back(fmt::format("qd{}", number));
            tree_.qdd.emplace_back(fmt::format("qdd{}", number));
            coordinates_[name] = tree_.q.back();
        }
    }

    void read_constant(const constant_description& constant) {
        const ex value = parse_expression(constant.value, names_).subs(values_);
        const GiNaC::numeric number = constant_value(value, constant.value.where);
        if (number.is_zero()) {
            names_[constant.name] = 0;
            return;
        }
        const GiNaC::symbol symbol(constant.name);
        names_[constant.name] = symbol;
        values_[symbol] = value;
        tree_.constants.push_back({symbol, constant.name, true, number, -1, false});
    }

    void check_finite(const ex& value, const input_location& where) { constant_value(value.subs(values_), where); }

    /// The value as it stands if exact arithmetic can follow it; otherwise (pi, sqrt(2), L*sin(a)) its number to 60
    /// digits.
    ex finite(const ex& value, const input_location& where) {
        const GiNaC::numeric number = constant_value(value.subs(values_), where);
        return is_rational(value) ? value : ex(number);
    }

    ex length(const expression_text& text) {
        const ex value = finite(parse_expression(text, names_), text.where);
        return is_number(value) ? literal(value) : value.expand();
    }

    static bool is_number(const ex& value) { return GiNaC::is_a<GiNaC::numeric>(value) && !value.is_zero(); }

    /// A bare number becomes a symbol too, one for each magnitude, so that regroupings stay formulas until they are
    /// printed.
    ex literal(const ex& value) {
        const GiNaC::numeric number = GiNaC::ex_to<GiNaC::numeric>(value);
        const GiNaC::numeric magnitude = GiNaC::abs(number);
        for (const kinematic_constant& known : tree_.constants) {
            if (!known.is_named && known.angle < 0 && known.value == magnitude) {
                return number.is_negative() ? -known.symbol : known.symbol;
            }
        }
        const std::string text = to_decimal(cln::the<cln::cl_RA>(magnitude.to_cl_N()));
        const GiNaC::symbol symbol("length_" + text);
        tree_.constants.push_back({symbol, text, false, magnitude, -1, false});
        return number.is_negative() ? -symbol : symbol;
    }

    angle_pair constant_angle(const expression_text& text) {
        const ex angle = parse_expression(text, names_);
        check_finite(angle, text.where);
        const int quarters = quarter_turns(angle.subs(values_));
        return quarters >= 0 ? turned({1, 0}, quarters) : angle_symbols(angle, text);
    }

    /// Cosine and sine of an angle that is no multiple of pi/2, on the unit circle exactly: from t = tan(angle/2) to 60
    /// digits.
    angle_pair angle_symbols(const ex& angle, const expression_text& text) {
        for (std::size_t i = 0; i < angles_.size(); ++i) {
            if (angles_[i].is_equal(angle)) {
                return angle_pairs_[i];
            }
        }
        const GiNaC::numeric t = constant_value(GiNaC::tan(angle.subs(values_) / 2), text.where);
        const GiNaC::numeric norm = 1 + t * t;
        const int number = static_cast<int>(angles_.size());
        const std::string shown = is_number(angle) ? text.text : printed(angle);
        const GiNaC::symbol c("cos_" + std::to_string(number));
        const GiNaC::symbol s("sin_" + std::to_string(number));
        tree_.constants.push_back({c, "cos(" + shown + ")", true, (1 - t * t) / norm, number, false});
        tree_.constants.push_back({s, "sin(" + shown + ")", true, 2 * t / norm, number, true});
        angles_.push_back(angle);
        angle_pairs_.push_back({c, s});
        return angle_pairs_.back();
    }

    void read_joint(const joint_description& source) {
        kinematic_joint joint;
        joint.name = source.name;
        joint.type = source.type;
        joint.antecedent = source.antecedent;
        joint.gamma = constant_angle(source.gamma);
        joint.alpha = constant_angle(source.alpha);
        joint.b = length(source.b);
        joint.d = length(source.d);
        if (source.type == joint_type::revolute) {
            joint.r = length(source.r);
            if (!source.passive) {
                read_revolute(joint, source.theta);
            }
        } else if (source.type == joint_type::prismatic) {
            joint.theta = constant_angle(source.theta);
            read_prismatic(joint, source.r);
        } else {
            joint.theta = constant_angle(source.theta);
            joint.r = length(source.r);
        }
        joint.massless = source.massless;
        joint.passive = source.passive;
        joint.label = joint.coordinate >= 0 ? std::to_string(joint.coordinate + 1) : "_" + joint.name;
        tree_.joints.push_back(joint);
    }

    /// Splits the variable of a joint into its rates, which it stores, and its constant part, which it returns.
    ex linear_in_coordinates(kinematic_joint& joint, const expression_text& text) {
        const auto own = std::find(tree_.driven.begin(), tree_.driven.end(), static_cast<int>(tree_.joints.size()));
        named_values names = names_;
        names.insert(coordinates_.begin(), coordinates_.end());
        if (own != tree_.driven.end()) {
            joint.coordinate = static_cast<int>(own - tree_.driven.begin());
            names["q"] = tree_.q[static_cast<std::size_t>(joint.coordinate)];
        }
        const ex value = parse_expression(text, names);
        GiNaC::exmap at_zero;
        for (const GiNaC::symbol& q : tree_.q) {
            at_zero[q] = 0;
        }
        const ex offset = value.subs(at_zero).expand();
        ex rest = value - offset;
        for (std::size_t k = 0; k < tree_.q.size(); ++k) {
            const ex factor = value.diff(tree_.q[k]);
            if (!factor.is_zero()) {
                joint.rates.push_back({static_cast<int>(k), factor});
                rest -= factor * tree_.q[k];
            }
        }
        check_linear(joint, rest.expand(), text);
        check_finite(offset, text.where);
        for (joint_rate& rate : joint.rates) {
            rate.factor = finite(rate.factor, text.where);
            joint.variable += rate.factor * tree_.q[static_cast<std::size_t>(rate.coordinate)];
        }
        return offset;
    }

    void check_linear(const kinematic_joint& joint, const ex& rest, const expression_text& text) const {
        const auto is_constant = [this](const joint_rate& rate) {
            return std::none_of(tree_.q.begin(), tree_.q.end(), [&rate](const ex& q) { return rate.factor.has(q); });
        };
        const bool moves_itself = joint.coordinate < 0 ||
                                  std::any_of(joint.rates.begin(), joint.rates.end(), [&joint](const joint_rate& rate) {
                                      return rate.coordinate == joint.coordinate;
                                  });
        if (joint.rates.empty() || !moves_itself || !rest.is_zero() ||
            !std::all_of(joint.rates.begin(), joint.rates.end(), is_constant)) {
            throw input_error(text.where,
                              fmt::format("\"{}\" given, expected a constant times q plus a constant, such as \"q\" or "
                                          "\"q + pi/2\", or a linear function of q and other joints' q_<joint>",
                                          text.text));
        }
    }

    void read_revolute(kinematic_joint& joint, const expression_text& text) {
        const ex offset = linear_in_coordinates(joint, text);
        const int quarters = quarter_turns(offset.subs(values_));
        joint.angle = joint.variable + (quarters >= 0 ? ex(0) : finite(offset, text.where));
        joint.theta = turned({GiNaC::cos(joint.angle), GiNaC::sin(joint.angle)}, quarters);
        joint.variable += finite(offset, text.where);
    }

    void read_prismatic(kinematic_joint& joint, const expression_text& text) {
        const ex offset = finite(linear_in_coordinates(joint, text), text.where);
        joint.r = joint.variable + (is_number(offset) ? literal(offset) : offset);
        joint.variable = joint.r;
    }

    void read_loop(const loop_description& source) {
        planar_loop loop;
        for (std::size_t side = 0; side < 2; ++side) {
            loop.cut[side].link = source.cut[side].link;
            for (std::size_t i = 0; i < 3; ++i) {
                loop.cut[side].point[i] = length(source.cut[side].point[i]);
            }
        }
        loop.passive = source.passive;
        loop.assembly = source.assembly;
        loop.where = source.where;
        loop.cut_where = source.cut_where;
        loop.passive_where = source.passive_where;
        loop.assembly_where = source.assembly_where;
        for (const int joint : tree_.driven) {
            const joint_description& driven = robot_.joints[static_cast<std::size_t>(joint)];
            loop.ranges.push_back(driven.limits.position.value_or(std::pair(-3.2, 3.2)));
        }
        close_loop(loop, tree_);
    }

    const robot_description& robot_;
    kinematic_tree tree_;
    named_values names_;
    named_values coordinates_;  ///< q_<joint>
    GiNaC::exmap values_;
    std::vector<ex> angles_;
    std::vector<angle_pair> angle_pairs_;
};

}  // namespace

angle_pair turned(const angle_pair& angle, int quarters) {
    switch (quarters) {
        case 1:
            return {-angle.sin, angle.cos};
        case 2:
            return {-angle.cos, -angle.sin};
        case 3:
            return {angle.sin, -angle.cos};
        default:
            return angle;
    }
}

std::array<GiNaC::ex, 3> kinematic_joint::position() const {
    const ex y = -alpha.sin * r;
    return {(gamma.cos * d - gamma.sin * y).expand(), (gamma.sin * d + gamma.cos * y).expand(),
            (b + alpha.cos * r).expand()};
}

std::vector<int> kinematic_tree::path_to_base(int joint) const {
    std::vector<int> path;
    for (int j = joint; j >= 0; j = joints[static_cast<std::size_t>(j)].antecedent) {
        path.push_back(j);
    }
    return path;
}

kinematic_tree build_kinematic_tree(const robot_description& robot) {
    return tree_reader(robot).run();
}

GiNaC::exmap values_of_constants(const kinematic_tree& tree) {
    GiNaC::exmap values;
    for (const kinematic_constant& constant : tree.constants) {
        values[constant.symbol] = constant.value;
    }
    return values;
}

double number_of(const ex& constant, const GiNaC::exmap& values) {
    return GiNaC::ex_to<GiNaC::numeric>(constant.subs(values).evalf()).to_double();
}

}  // namespace idim::generator
