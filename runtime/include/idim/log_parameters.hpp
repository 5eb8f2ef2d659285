#pragma once

#include "idim/model_interface.h"
#include "idim/observation.hpp"

namespace idim {

/// Rows in which every log has columns of its own for the parameters that are each log's own (such as those of a
/// phase): those of the first log stay where they are, those of the others stand behind all base parameters; see
/// observation::columns. Rows of models without such parameters, and of one log, come back as they are.
observation with_log_columns(const idim_model_interface& model, observation rows);

/// Parameters of the columns of `rows`, from base parameters: what is each log's own is fitted to the residual of that
/// log alone.
Eigen::VectorXd with_log_parameters(const idim_model_interface& model, const observation& rows,
                                    const Eigen::VectorXd& chi);

}  // namespace idim
