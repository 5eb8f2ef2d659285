#pragma once

#include <vector>

#include "dynamics/dynamic_models.hpp"
#include "dynamics/link_frame.hpp"

namespace idim::generator {

/// Values of all standard parameters in a model: a symbol where kept, zero elsewhere.
class parameter_values {
  public:
    /// Declares the kept parameters as leaves chi[0..b) of the model.
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
};

/// Declares t and the temperatures if some effect uses them.
void declare_signals(symbolic_model& model, const standard_parameters& parameters);

/// Torque of all effects at a coordinate.
GiNaC::ex effect_torque(const standard_parameters& parameters, const parameter_values& values, int coordinate);

}  // namespace idim::generator
