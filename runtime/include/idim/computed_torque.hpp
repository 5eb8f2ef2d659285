#pragma once

#include "idim/control_law.hpp"

namespace idim {

/// Computed torque: g v = ID(q, qd, qddr + kd (qdr - qd) + kp (qr - q)) with the generated inverse dynamic model and
/// the parameters the controller believes in. `model` outlives the law.
class computed_torque : public control_law {
  public:
    computed_torque(const idim_model_interface& model, Eigen::VectorXd nominal)
        : model_(&model), nominal_(std::move(nominal)) {}

    Eigen::VectorXd kp;  ///< [n] 1/s^2
    Eigen::VectorXd kd;  ///< [n] 1/s

    std::unique_ptr<control_law> clone() const override { return std::make_unique<computed_torque>(*this); }

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;

  private:
    const idim_model_interface* model_;
    Eigen::VectorXd nominal_;  ///< [b] chi
};

}  // namespace idim
