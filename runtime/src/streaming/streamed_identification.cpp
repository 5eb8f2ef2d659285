#include "idim/streamed_identification.hpp"

#include <stdexcept>

#include "streaming/streamed_rows.hpp"
#include "weighted_fit.hpp"

namespace idim {

streamed_identification identify_streamed(const idim_model_interface& model, const std::vector<stored_log>& logs,
                                          const filter_choice& choice, least_squares_method method) {
    if (method == least_squares_method::irls) {
        throw std::invalid_argument("identify_streamed: irls needs the rows in memory");
    }
    const streamed_rows rows(model, logs, choice);
    const joint_triangles joints = triangles_of(rows);
    streamed_identification found;
    found.fit = least_squares(rows, joints, method);
    if (found.fit.chi.size() > 0) {
        found.essential = find_essential(rows, joints, found.fit);
        found.residual = test_residual(rows, found.fit);
    }
    for (const decimated_log& log : rows.decimated()) {
        found.row_rates.push_back(log.rate());
    }
    return found;
}

}  // namespace idim
