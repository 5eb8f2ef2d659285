#include "model_comparison.hpp"

namespace idim::cli {

bool model_comparison::same() const {
    return difference.empty() && torques->verdict != torque_verdict::different;
}

const char* model_comparison::joint_name(int joint) const {
    return after.compiled.interface().joint_names[joint];
}

const char* model_comparison::unit(int joint) const {
    return after.compiled.interface().joint_is_prismatic[joint] != 0 ? "N" : "N*m";
}

}  // namespace idim::cli
