#pragma once

#include <map>
#include <utility>
#include <vector>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_frame.hpp"

namespace idim::generator {

/// Values of all standard parameters in a model: a symbol where kept, zero elsewhere; those of links with the payload
/// they carry at the time.
class parameter_values {
  public:
    /// Declares the kept parameters as leaves chi[0..b) of the model, and the gates of payloads.
    parameter_values(symbolic_model& model, const standard_parameters& parameters,
                     const parameter_selection& selection);

    const GiNaC::ex& operator[](std::size_t standard) const { return value_[standard]; }
    /// Zero for a massless link.
    GiNaC::ex inertial(int link, parameter_kind kind) const;
    symmetric3 inertia(int link) const;
    vector3 first_moments(int link) const;

  private:
    const standard_parameters& parameters_;
    std::vector<GiNaC::ex> value_;
    std::map<std::pair<int, parameter_kind>, GiNaC::ex> loaded_;  ///< of links that carry a payload, with it
};

/// 1 while a payload is on, else 0.
GiNaC::ex gate_of(const standard_parameters& parameters, const standard_parameter& load);

/// Declares t, if there are payloads, and what tells when they are on. Needed before their parameters are used.
void declare_gates(symbolic_model& model, const standard_parameters& parameters);

/// Declares t, temperatures, states and motions of motors if some effect uses them.
void declare_signals(symbolic_model& model, const standard_parameters& parameters);

/// The torque of the links and payloads at every coordinate, as further leaves if some effect uses it.
void declare_rigid_torque(symbolic_model& model, const standard_parameters& parameters);

/// Torque of all effects at a coordinate.
GiNaC::ex effect_torque(const standard_parameters& parameters, const parameter_values& values, int coordinate);

}  // namespace idim::generator
