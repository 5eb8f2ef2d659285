#include "swing_sensitivity.hpp"

#include <algorithm>

#include "idim/recorded_states.hpp"
#include "idim/zero_phase_filter.hpp"
#include "links_behind.hpp"
#include "swing_start.hpp"

namespace idim {

namespace {

/// Links of one log as they swing behind their motors with the present parameters.
class swinging_log {
  public:
    swinging_log(const idim_model_interface& model, const filtered_samples& motor, const Eigen::VectorXd& chi)
        : model_(model),
          soft_(transmissions_of(model)),
          links_(completed(model, motor, chi)),
          dynamics_(dynamics_of(links_, motor, soft_,
                                [&](const filtered_samples& at) { return rigid_torques(model, at, chi); })) {
        const Eigen::MatrixXd torque = rigid_torques(model, links_, chi);
        filtered_samples probe = links_;
        for (const soft_transmission& t : soft_) {
            probe.qdd.col(t.joint).array() += 1.0;
            inertia_.emplace_back(rigid_torques(model, probe, chi) - torque);
            probe.qdd.col(t.joint) = links_.qdd.col(t.joint);
        }
    }

    std::size_t transmissions() const { return soft_.size(); }
    /// M of the links, samples x n: the column of the i-th soft joint.
    const Eigen::MatrixXd& inertia(std::size_t i) const { return inertia_[i]; }

    /// Acceleration of the twists that a unit of parameter k drives, samples x s.
    Eigen::MatrixXd acceleration(Eigen::Index k) const {
        const Eigen::MatrixXd torque = rigid_torques(model_, links_, Eigen::VectorXd::Unit(model_.n_base, k));
        swing_dynamics driven{Eigen::MatrixXd(torque.rows(), static_cast<Eigen::Index>(soft_.size())),
                              dynamics_.inertia};
        for (std::size_t i = 0; i < soft_.size(); ++i) {
            driven.forcing.col(static_cast<Eigen::Index>(i)) = torque.col(soft_[i].joint);
        }
        if (driven.forcing.isZero(0.0)) {
            return driven.forcing;
        }
        return swing(driven, soft_, links_.rate, slow_start(driven, soft_, links_.rate)).acceleration;
    }

  private:
    const idim_model_interface& model_;
    std::vector<soft_transmission> soft_;
    filtered_samples links_;
    swing_dynamics dynamics_;
    std::vector<Eigen::MatrixXd> inertia_;
};

/// Adds what the twists change to the columns of one log. The filter of the decimation is that of the acceleration
/// alone: inertias change slowly.
void add_twists(const swinging_log& log, int decimation, int n_base, observation_block& block) {
    for (Eigen::Index k = 0; k < n_base; ++k) {
        const Eigen::MatrixXd acceleration = log.acceleration(k);
        if (acceleration.isZero(0.0)) {
            continue;
        }
        const Eigen::MatrixXd filtered = decimate(acceleration, decimation);
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            for (std::size_t row = 0; row < block.kept[j].size(); ++row) {
                const Eigen::Index place = block.kept[j][row];
                for (std::size_t i = 0; i < log.transmissions(); ++i) {
                    const Eigen::MatrixXd& M = log.inertia(i);
                    const Eigen::Index sample = std::min(place * decimation, M.rows() - 1);
                    block.W[j](static_cast<Eigen::Index>(row), k) -=
                        M(sample, static_cast<Eigen::Index>(j)) * filtered(place, static_cast<Eigen::Index>(i));
                }
            }
        }
    }
}

}  // namespace

observation linearised(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                       const filter_choice& choice, observation rows, const Eigen::VectorXd& chi) {
    for (std::size_t l = 0; l < logs.size(); ++l) {
        observation_block& block = rows.blocks[l];
        std::vector<Eigen::VectorXd> residual;
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            residual.emplace_back(block.Y[j] - block.W[j] * chi);
        }
        add_twists({model, logs[l], chi.head(model.n_base)}, choice.decimation, model.n_base, block);
        for (std::size_t j = 0; j < block.W.size(); ++j) {
            block.Y[j] = residual[j] + block.W[j] * chi;
        }
    }
    return rows;
}

}  // namespace idim
