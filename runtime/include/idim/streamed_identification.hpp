#pragma once

#include <string>
#include <vector>

#include "idim/estimate.hpp"
#include "idim/residual_test.hpp"
#include "idim/stored_log.hpp"

namespace idim {

/// What least squares makes of logs that need not fit into memory.
struct streamed_identification {
    estimate fit;
    essential_parameters essential;       ///< empty where fit has no parameters
    std::vector<residual_test> residual;  ///< per joint; likewise
    std::vector<double> row_rates;        ///< of each log [Hz]
};

/// What of a model needs logs as a whole, one phrase: effects with states or of the links' torque, soft transmissions,
/// delays, parameters that are each log's own. Empty where its logs can be streamed.
std::string whole_log_need(const idim_model_interface& model);

/// filter_log, observe, least_squares (ols or wls), find_essential and test_residual of stored logs: the same rows and
/// the same results to rounding, but that correlations between rows are cut at 1e-12 of them, and at 2^14 rows. The
/// logs are evaluated part by part in several passes: one for the triangles of the joints (joint_triangles), which give
/// every solution and every error, one for the residual, five for each set of deviations (sandwich.hpp). Memory does
/// not depend on the length of the logs, but for 16 bytes for each rest of a joint. Throws input_error for a model with
/// a whole_log_need, std::invalid_argument for irls.
streamed_identification identify_streamed(const idim_model_interface& model, const std::vector<stored_log>& logs,
                                          const filter_choice& choice, least_squares_method method);

}  // namespace idim
