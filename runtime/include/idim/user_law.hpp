#pragma once

#include <memory>
#include <string>
#include <vector>

#include "idim/compiled_model.hpp"
#include "idim/control_law.hpp"
#include "idim/input_error.hpp"

namespace idim {

/// A control law that its user wrote (law_interface.h).
class user_law : public control_law {
  public:
    /// `values` [n] each, in the order of the law's names. `code` may be shared between laws.
    user_law(std::shared_ptr<const compiled_law> code, std::vector<Eigen::VectorXd> values);
    user_law(const user_law& other);
    user_law& operator=(const user_law&) = delete;

    std::unique_ptr<control_law> clone() const override { return std::make_unique<user_law>(*this); }

  protected:
    Eigen::VectorXd unlimited(const control_sample& sample) override;
    void limited(const Eigen::VectorXd& wanted, const Eigen::VectorXd& given) override;
    void forget() override;

  private:
    using memory = std::unique_ptr<void, void (*)(void*)>;

    std::shared_ptr<const compiled_law> code_;
    std::vector<Eigen::VectorXd> values_;
    memory law_;
};

/// Compiles the law in the text of a header `name`, such as "my_law.hpp"; `interface` holds law_interface.h and
/// law_adapter.hpp as "idim/...". Throws input_error at `where` with the compiler's first error.
compiled_law compile_user_law(const model_source& header, const std::vector<model_source>& interface,
                              const input_location& where, const compile_options& options = {});

}  // namespace idim
