#pragma once

/// The generated functions of a robot over one scalar: single precision in the firmware, a number with its bound on the
/// host. A thin interface, so that each robot is compiled once, apart. Arguments as in the generated headers.
template <class Scalar>
struct robot_model {
    const char* name;
    const char* language;  ///< of the generated code: cpp or c
    int dof, base_parameters, standard_parameters;
    const char* const* standard_parameter_names;
    void (*regroup)(const Scalar* standard, Scalar* chi);
    void (*inverse_dynamics)(const Scalar* q, const Scalar* qd, const Scalar* qdd, const Scalar* chi, Scalar* tau);
    void (*mass_matrix)(const Scalar* q, const Scalar* chi, Scalar* M);
    void (*forward_dynamics)(const Scalar* q, const Scalar* qd, const Scalar* tau, const Scalar* chi, Scalar* qdd,
                             Scalar* D);
    void (*regressor)(const Scalar* q, const Scalar* qd, const Scalar* qdd, Scalar* W);
};
