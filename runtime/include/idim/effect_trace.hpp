#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "idim/effect_interface.h"
#include "idim/estimate.hpp"
#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"

namespace idim {

/// An effect at one place of the robot.
struct effect_place {
    std::string effect;       ///< as in the catalogue
    std::vector<int> joints;  ///< where it acts
    std::optional<int> from;  ///< joint whose signals drive it, if another

    bool operator==(const effect_place& other) const {
        return effect == other.effect && joints == other.joints && from == other.from;
    }
};

/// A coefficient of an effect as found.
struct effect_parameter {
    std::string name;
    std::string unit;
    double value = 0.0;     ///< not a number where the model's own terms take the coefficient up
    double std = 0.0;       ///< robust to the autocorrelation of the residual; not a number where none is known
    bool is_shape = false;  ///< enters the description as a shape value
};

/// Errors on the logs that were fitted and on those held back.
struct trace_errors {
    error_summary identification;
    error_summary validation;
};

/// An effect that was added, and why.
struct trace_step {
    effect_place place;
    std::vector<effect_parameter> parameters;
    double p_value = 1.0;             ///< partial F on effective rows, corrected for everything tried
    double explained_fraction = 0.0;  ///< of its joints' residual variance beyond the noise floor, on data held back
    std::vector<effect_place> confusable_with;
    error_summary before;  ///< on the data held back
    error_summary after;
    std::string torque = {};  ///< expression of an effect that was proposed for it
};

/// A candidate that was tried at the end, most likely first.
struct trace_candidate {
    effect_place place;
    double p_value = 1.0;
    double explained_fraction = 0.0;
    double f_statistic = 0.0;         ///< partial F on effective rows
    double correlation_length = 1.0;  ///< of the residual it leaves [rows]
    double held_back_z = 0.0;         ///< gain on data held back in its own deviations, all rows
    double moving_z = 0.0;            ///< the same away from reversals
    std::vector<double> values;       ///< linear coefficients, then shapes
    std::string objection;            ///< why it is not in the model
};

/// An effect that no residual of these logs can show, and why.
struct hidden_effect {
    effect_place place;
    std::string reason;
};

/// A term of the description that the data does not support.
struct unsupported_term {
    effect_place place;
    std::vector<std::string> parameters;  ///< base parameters that are its own
    double p_value = 1.0;                 ///< partial F on effective rows
    trace_errors without;                 ///< errors without it and those listed before it
};

/// Dependence of the residual on signals that no known effect fits.
struct unexplained_structure {
    int joint = 0;
    std::vector<std::string> signals;  ///< "q2", "qd1", "t" ...
    double explained_fraction = 0.0;   ///< of the residual variance away from reversals, on data held back
    /// A torque that may be its form: a sum of these terms, each with a linear coefficient, in the words of an effect
    /// file; empty where none is stable.
    std::vector<std::string> terms;
    std::vector<std::string> units;  ///< of the terms' coefficients
    std::optional<int> from;         ///< joint of the signals ..._from
    std::string proposed;            ///< name of the effect that was added for it
};

/// Deviation of the noise of each joint's rows, and where it was taken from; empty where it cannot be known.
struct noise_floor {
    std::string from;
    Eigen::VectorXd rms;
};

struct effect_trace {
    trace_errors before;
    trace_errors after;
    noise_floor floor;
    std::vector<trace_step> steps;
    std::vector<trace_candidate> candidates;
    std::vector<hidden_effect> not_identifiable;  ///< within the span of the model: no residual can show them
    std::vector<unsupported_term> unsupported;    ///< declared, least significant first
    std::vector<unexplained_structure> unexplained;
    double alignment = 0.0;    ///< torque behind the motion by this part of a sample, taken off [s]
    double tests = 0.0;        ///< candidates and shapes tried in the last round
    bool interrupted = false;  ///< ended by trace_input::go_on: more may be missing
};

/// The model of the same robot with gravity turned, its standard parameters the same.
struct turned_model {
    std::string shape;  ///< "tilt_x", "tilt_y" or "tilt_z"
    double angle = 0.0;
    const idim_model_interface* model = nullptr;
};

/// What the tracer starts from.
struct trace_input {
    const idim_model_interface* model = nullptr;
    std::vector<turned_model> turned;  ///< about each axis that gravity is not along
    std::vector<filtered_samples> fitted;
    std::vector<filtered_samples> held_back;
    filter_choice filter;
    const idim_effect_table* catalogue = nullptr;
    std::vector<effect_place> declared;                ///< effects the description has already
    std::vector<effect_place> only;                    ///< tried, and nothing else; empty: everything
    int most_effects = 12;                             ///< 0: only look
    std::vector<trace_step> found;                     ///< steps of an earlier trace of the same data, to go on from
    std::function<void(const std::string&)> progress;  ///< one line for the user; may be empty
    /// Asked now and then by any thread; false ends the trace with the steps it has. May be empty.
    std::function<bool()> go_on;
};

/// Finds what the model lacks: looks at the residual of weighted least squares, tries every effect of the catalogue at
/// every joint, adds the one that gains most where it is significant (partial F on effective rows, corrected for
/// everything tried), gains on data it was not fitted to, away from reversals too, and is plausible; then again, terms
/// that others made needless taken out, until nothing passes. METHODS.md has the equations; the tests of acceptance
/// stand in effect_tracer. Steps of an earlier trace come first, fitted again, unless they have become needless; those
/// of effects that are not in the catalogue, or tried nowhere, are left out. Throws data_error where the rows are too
/// few.
effect_trace trace_effects(const trace_input& input);

/// Cuts the last `share` of a log off to be held back, `gap` seconds left out between: where no log was given for
/// validation.
std::pair<filtered_samples, filtered_samples> hold_back(const filtered_samples& samples, double share, double gap);

}  // namespace idim
