#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "idim/effect_trace.hpp"
#include "traced_log.hpp"

namespace idim {

class trace_fit;

/// A linear coefficient of an effect.
struct linear_bound {
    std::string name;
    std::string unit;
    double min = -std::numeric_limits<double>::infinity();
    double negligible = 0.0;  ///< a smaller value is none of the robot's
    double max = std::numeric_limits<double>::infinity();
    bool is_nuisance = false;  ///< fitted, but no coefficient of the effect
    bool is_one = false;       ///< not fitted: the shape says how large the effect is; the only coefficient then
};

/// A coefficient that enters nonlinearly and is searched in [low, high].
struct shape_bound {
    std::string name;
    std::string unit;
    double low = 0.0;
    double high = 0.0;
    bool is_instant = false;   ///< a time at which rows begin or cease to count
    bool is_nuisance = false;  ///< searched, but no coefficient of the effect
};

/// How the coefficient of a column becomes what the description declares.
enum class column_role {
    linear,  ///< the column's coefficient is a linear coefficient of the effect
    shape,   ///< the model is linearised: the coefficient is a shape value itself (a gain error, a delay)
};

/// An effect at one place of the robot that the model may lack: columns to be added to the regressor, m for each joint
/// it touches, given its shape.
class effect_candidate {
  public:
    virtual ~effect_candidate() = default;

    effect_place place() const { return {effect, joints, from}; }

    std::string effect;                ///< as in the catalogue
    std::vector<int> joints;           ///< where it acts, as reported
    std::optional<int> from;           ///< the joint whose signals drive it
    std::vector<linear_bound> linear;  ///< m of them
    std::vector<shape_bound> shape;
    column_role role = column_role::linear;
    bool is_of_the_robot = false;  ///< at no joint in particular: `joints` are all of them
    std::string when_permanent;    ///< why it cannot be seen if it lasts for the whole of every log; empty if it can
    bool per_log = false;          ///< linear coefficients are refitted for each log
    int states = 0;                ///< values that say how its motion begins, chosen anew for each log
    /// A direction of the scaled columns whose norm outside the model's span is below this counts as within it: a drive
    /// gain shows only in 1e-4 of its column, rounding and filter ends in 1e-7.
    double least_outside = 1e-5;
    std::vector<int> touched;  ///< joints whose rows its columns fill

    /// Columns of one joint's rows in one log (rows x m), filtered and decimated as the torque is.
    virtual Eigen::MatrixXd rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const = 0;
    /// The same without the low-pass, from the signals at the rows' own times: good enough to search a shape.
    virtual Eigen::MatrixXd quick_rows(const traced_log& log, int joint, const Eigen::VectorXd& at) const {
        return rows(log, joint, at);
    }
    /// Those of all joints it touches, in their order.
    virtual std::vector<Eigen::MatrixXd> touched_rows(const traced_log& log, const Eigen::VectorXd& at) const {
        std::vector<Eigen::MatrixXd> all;
        for (const int joint : touched) {
            all.push_back(rows(log, joint, at));
        }
        return all;
    }
    /// Value and deviation that the description declares, from those of a coefficient.
    virtual std::pair<double, double> declared(double coefficient, double deviation) const {
        return {coefficient, deviation};
    }
    /// The same effect with the model linearised around the coefficients found; none where its columns do not depend on
    /// them.
    virtual std::shared_ptr<const effect_candidate> relinearised(const Eigen::VectorXd& /*coefficient*/) const {
        return nullptr;
    }
    /// Shapes to begin with, best first, where the effect knows a better way than a grid; none otherwise.
    virtual std::vector<Eigen::VectorXd> starts(const trace_fit& /*fit*/) const { return {}; }
    /// Independent shapes that `starts` chose from, at least.
    virtual int shapes_tried(const trace_fit& /*fit*/) const { return 1; }
    /// A better shape near one that was found, where `starts` knows the way.
    virtual Eigen::VectorXd shape_near(const trace_fit& /*fit*/, const Eigen::VectorXd& at) const { return at; }
};

using candidate_pointer = std::shared_ptr<const effect_candidate>;

/// A candidate with its shape.
struct effect_term {
    candidate_pointer candidate;
    Eigen::VectorXd shape;
};

}  // namespace idim
