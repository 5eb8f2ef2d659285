#pragma once

#include <functional>

#include "idim/filtered_samples.hpp"
#include "idim/model_interface.h"
#include "idim/observation.hpp"
#include "rest_search.hpp"
#include "streaming/filtered_log.hpp"

namespace idim {

/// The decimated rows of a stored log, part by part, and which of them stand.
class decimated_log {
  public:
    /// `data` must outlive it. Looks for the rests of the joints (select_rows), in two passes.
    decimated_log(const stored_log& data, const filter_choice& choice);

    const std::string& file() const { return samples_.file(); }
    double rate() const { return samples_.rate() / choice_.decimation; }  ///< of the rows [Hz]
    Eigen::Index rows() const { return rows_; }                           ///< kept or not
    Eigen::Index kept_rows(std::size_t joint) const;
    /// Rows worth computing at once.
    Eigen::Index rows_at_once() const;
    /// Rows first..first+count-1 as observe gives them; block.t and block.kept begin at the first.
    observation_block part(const idim_model_interface& model, Eigen::Index first, Eigen::Index count) const;

  private:
    /// Samples around rows with which these are decimated as in the whole log.
    struct window {
        filtered_samples samples;
        Eigen::Index lead = 0;  ///< rows of the window before the first wanted
    };
    window around(Eigen::Index first, Eigen::Index count) const;
    /// Calls `use` with the samples of successive rows and their decimated speeds.
    void for_speeds(const std::function<void(const Eigen::MatrixXd& q, const Eigen::MatrixXd& speed)>& use) const;
    void find_rests();

    filtered_log samples_;
    filter_choice choice_;
    Eigen::Index rows_ = 0;
    Eigen::Index reach_ = 0;                      ///< of the decimation filter [rows]
    std::vector<std::vector<sample_run>> rests_;  ///< per joint
};

}  // namespace idim
