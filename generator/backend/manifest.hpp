#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/operation_count.hpp"

namespace idim::generator {

/// A joint as the robot description has it.
struct manifest_joint {
    std::string name;
    std::string type;        ///< "revolute", "prismatic" or "fixed"
    std::string antecedent;  ///< name of the joint before it, or "base"
    bool driven = false;     ///< has a coordinate of its own
    /// Entries of its Denavit-Hartenberg row that are not zero, as written: {"alpha", "pi/2"}.
    std::vector<std::pair<std::string, std::string>> row;
    std::optional<std::pair<double, double>> position;   ///< limits [rad or m]
    std::optional<double> velocity, effort, drive_gain;  ///< [rad/s or m/s], [N*m or N], [N*m or N per unit of v]
};

/// A closed loop as the robot description has it.
struct manifest_loop {
    struct point {
        std::string link;               ///< name of its joint, or "base"
        std::array<std::string, 3> at;  ///< expressions [m], in the frame of that joint
    };
    std::array<point, 2> cut;
    std::array<std::string, 2> passive;  ///< names of the joints it determines
    std::string assembly;                ///< "1", "-1" or "parallelogram"
};

struct manifest_effect {
    std::string effect;
    std::vector<std::string> joints;
    std::vector<std::string> from;  ///< pair effects: the other joint, one for each of `joints`
    std::vector<std::pair<std::string, double>> shape;
    std::string torque;  ///< expression, as the effect's file has it
};

/// What a folder of generated code says of itself in manifest.json: what it was made from, and what it costs. Names and
/// regroupings of the parameters stand in the code (model.hpp).
struct manifest {
    std::string generator;  ///< "idim 0.1.0"
    std::string robot;
    std::string target;  ///< "cpp"
    std::string cost;    ///< what the forms of the models were chosen for: "ops"
    std::string input_hash;
    std::vector<std::string> files;
    std::vector<std::string> gravity;  ///< three expressions [m/s^2]
    std::vector<std::pair<std::string, double>> constants;
    std::vector<manifest_joint> joints;
    std::vector<manifest_loop> loops;
    std::vector<manifest_effect> effects;
    std::vector<std::pair<std::string, operation_count>> operations;  ///< of each generated function
};

}  // namespace idim::generator
