#pragma once

#include "idim/control_law.hpp"

namespace idim {

/// Law of the EMPS benchmark (Janot, Gautier, Brunot 2019): v = kv (kp (qr - q) - d), where d is the difference of the
/// mean of two successive positions over one period; at the first sample d is zero.
class emps_law : public control_law {
  public:
    Eigen::VectorXd kp;  ///< [n] 1/s
    Eigen::VectorXd kv;  ///< [n] drive command per unit of velocity

    std::unique_ptr<control_law> clone() const override { return std::make_unique<emps_law>(*this); }

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;
    void forget() override;

  private:
    Eigen::VectorXd last_, before_last_;  ///< [n] positions one and two samples ago
};

}  // namespace idim
