#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backend/language.hpp"
#include "emit/template_renderer.hpp"
#include "graph/cost_model.hpp"
#include "graph/operation_count.hpp"
#include "idim/input_error.hpp"

/// The generator as one call: description -> kinematic tree -> symbolic model -> base parameters -> expression graph ->
/// template context -> files. No GiNaC here, so that users of this header do not see it.
namespace idim::generator {

/// A standard parameter, in the order of the models' standard_parameter_names.
struct standard_report {
    std::string name, unit;
    std::string joint;  ///< whose link or effect it belongs to
    int inertial = -1;  ///< 0..9: XX XY XZ YY YZ ZZ MX MY MZ M of a link or payload; -1: coefficient of an effect
    int payload = -1;   ///< of a payload: which time it is on for
    std::optional<double> min;  ///< smallest value of a coefficient
};

struct base_report {
    std::string robot;
    std::vector<parameter_context> parameters;
    int standard = 0;
    std::vector<standard_report> standard_parameters;
    std::vector<std::string> without_effect;
    std::vector<std::string> notes;  ///< what a user should know of how the description was read
    int qr_rank = 0;
    double smallest_kept_pivot = 0.0;
    double largest_dropped_pivot = 0.0;
    int exact_rank = 0;
    int exact_points = 0;
    int modulo_prime_only = 0;
    bool has_loops = false;  ///< that are no parallelograms: then exact_points are points modulo a prime, not rational
};

struct operation_table {
    operation_count inverse_dynamics, regressor, mass_matrix, forward_dynamics;
};

/// What to write of a robot.
struct generation_options {
    std::string target = "cpp";  ///< one of target_names()
    std::string cost = "ops";    ///< one of cost_target_names(): what the forms of the models are chosen for
    bool derivatives = false;    ///< of the inverse dynamics by q and qd, as one more function
};

/// A model of one robot, in memory.
struct generated_model {
    std::string robot;
    std::string target;
    std::string cost;
    std::string input_hash;
    base_report base;
    std::vector<joint_context> joints;
    std::vector<rendered_file> files;  ///< manifest.json last
    operation_table operations;
    operation_table rigid_operations;
    double seconds = 0.0;
};

/// Base parameters of a robot description. `templates` is the folder that holds effects/ and those of the targets.
/// Throws input_error, and rank_disagreement (a std::runtime_error) where the rank cannot be proven.
base_report find_base(const std::string& robot_file, const std::string& templates);

/// All models of a robot description as source files.
generated_model generate(const std::string& robot_file, const std::string& templates,
                         const generation_options& options = {});

/// The version of idim.
const char* version();

}  // namespace idim::generator
