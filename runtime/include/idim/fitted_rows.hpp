#pragma once

#include <vector>

#include "idim/estimate.hpp"
#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"
#include "idim/observation.hpp"

namespace idim {

/// Rows and the estimate they belong to.
struct fitted_rows {
    observation rows;
    estimate result;
};

/// Observes the logs and fits them by least squares. Where rows depend on the parameters (see depends_on_parameters)
/// both are repeated with each other's result until the parameters stay. Behind soft transmissions these are steps of
/// Gauss and Newton, shortened where they lead too far: `rows` are then linearised (W the derivative of the torque,
/// Y such that Y - W chi is what the model leaves), and the first parameters are the better of those that the measured
/// torque gives for the links' and those of rigid transmissions. `result.iterations` has every step; `converged` is
/// false where fifty did not do. Parameters that are each log's own have columns for each log (see log_parameters).
fitted_rows fit_rows(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                     const filter_choice& choice, least_squares_method method);

}  // namespace idim
