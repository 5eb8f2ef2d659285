#include "idim/law_declaration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

#include "idim/computed_torque.hpp"
#include "idim/emps_law.hpp"
#include "idim/p_position.hpp"
#include "idim/pd_cascade.hpp"
#include "idim/pid.hpp"
#include "idim/user_law.hpp"

namespace idim {

namespace {

/// Hands out the values of a declaration and knows which were asked for.
class declared_values {
  public:
    declared_values(const law_declaration& declaration, int dof) : declaration_(declaration), dof_(dof) {}

    bool has(const std::string& name) const { return declaration_.values.count(name) != 0; }

    /// Throws input_error where it is missing or not positive.
    Eigen::VectorXd positive(const std::string& name) {
        return checked(name, std::numeric_limits<double>::denorm_min(), " above zero");
    }

    /// Zero or more; zero where it is missing.
    Eigen::VectorXd optional(const std::string& name) {
        return has(name) ? checked(name, 0.0, " of zero or more") : Eigen::VectorXd::Zero(dof_);
    }

    /// Throws input_error where it is missing; of any sign.
    Eigen::VectorXd any(const std::string& name) { return checked(name, std::numeric_limits<double>::lowest(), ""); }

    void refuse_others() const {
        for (const auto& [name, values] : declaration_.values) {
            if (used_.count(name) == 0) {
                throw input_error(field(name), fmt::format("no value of the law {} as declared, expected one of {}",
                                                           declaration_.law, fmt::join(used_, ", ")));
            }
        }
    }

    input_location field(const std::string& name) const {
        input_location where = declaration_.where;
        where.field += where.field.empty() ? name : "." + name;
        return where;
    }

  private:
    Eigen::VectorXd checked(const std::string& name, double least, const char* expected) {
        used_.insert(name);
        const auto found = declaration_.values.find(name);
        if (found == declaration_.values.end()) {
            throw input_error(field(name),
                              fmt::format("missing, the law {} expects one number per joint", declaration_.law));
        }
        if (found->second.size() != static_cast<std::size_t>(dof_)) {
            throw input_error(field(name), fmt::format("{} values, expected {}", found->second.size(), dof_));
        }
        for (const double value : found->second) {
            if (!std::isfinite(value) || value < least) {
                throw input_error(field(name), fmt::format("{} given, expected finite numbers{}", value, expected));
            }
        }
        return Eigen::Map<const Eigen::VectorXd>(found->second.data(), dof_);
    }

    const law_declaration& declaration_;
    int dof_;
    std::set<std::string> used_ = {"saturation"};
};

template <typename Law>
void read_bandwidth(Law& law, declared_values& values) {
    law.natural_frequency = values.positive("wn");
    law.damping = values.positive("zeta");
}

template <typename Law>
void read_cascade(Law& law, declared_values& values) {
    if (values.has("wn")) {
        read_bandwidth(law, values);
        law.kp = law.natural_frequency.cwiseQuotient(2.0 * law.damping);
    } else {
        law.kp = values.positive("kp");
        law.kv = values.positive("kv");
    }
}

std::unique_ptr<control_law> make_pd_cascade(declared_values& values) {
    auto law = std::make_unique<pd_cascade>();
    read_cascade(*law, values);
    return law;
}

std::unique_ptr<control_law> make_p_position(declared_values& values) {
    auto law = std::make_unique<p_position>();
    read_cascade(*law, values);
    law->ki = values.optional("ki");
    law->kf = values.optional("kf");
    return law;
}

std::unique_ptr<control_law> make_pid(declared_values& values) {
    auto law = std::make_unique<pid>();
    if (values.has("wn")) {
        read_bandwidth(*law, values);
    } else {
        law->kp = values.positive("kp");
        law->kd = values.optional("kd");
    }
    law->ki = values.optional("ki");
    return law;
}

std::unique_ptr<control_law> make_emps(declared_values& values) {
    auto law = std::make_unique<emps_law>();
    law->kp = values.positive("kp");
    law->kv = values.positive("kv");
    return law;
}

std::unique_ptr<control_law> make_computed_torque(declared_values& values, const idim_model_interface& model,
                                                  const Eigen::VectorXd& chi) {
    auto law = std::make_unique<computed_torque>(model, chi);
    if (values.has("wn")) {
        const Eigen::VectorXd wn = values.positive("wn");
        law->kp = wn.cwiseAbs2();
        law->kd = 2.0 * wn.cwiseProduct(values.positive("zeta"));
    } else {
        law->kp = values.positive("kp");
        law->kd = values.positive("kd");
    }
    return law;
}

std::unique_ptr<control_law> make_user_law(const std::shared_ptr<const compiled_law>& code, declared_values& values) {
    std::vector<Eigen::VectorXd> given;
    for (int k = 0; k < code->table().n_values; ++k) {
        given.push_back(values.any(code->table().value_names[k]));
    }
    return std::make_unique<user_law>(code, std::move(given));
}

std::unique_ptr<control_law> make_named(const law_declaration& declaration, declared_values& values,
                                        const idim_model_interface& model, const Eigen::VectorXd& chi) {
    if (declaration.own) {
        return make_user_law(declaration.own, values);
    }
    if (declaration.law == "pd_cascade") {
        return make_pd_cascade(values);
    }
    if (declaration.law == "pid") {
        return make_pid(values);
    }
    if (declaration.law == "p_position") {
        return make_p_position(values);
    }
    if (declaration.law == "computed_torque") {
        return make_computed_torque(values, model, chi);
    }
    if (declaration.law == "emps") {
        return make_emps(values);
    }
    throw input_error(values.field("law"), fmt::format("{} given, expected pd_cascade, pid, p_position, "
                                                       "computed_torque, emps or a header such as my_law.hpp",
                                                       declaration.law));
}

int samples_of_delay(const law_declaration& declaration, const declared_values& values) {
    const double samples = declaration.delay * declaration.rate;
    const double whole = std::round(samples);
    constexpr double most = 1000.0;
    if (!(std::abs(samples - whole) < 1e-6) || whole > most) {
        throw input_error(values.field("delay"),
                          fmt::format("{} s given, expected a whole number of sampling periods (1/{} s), at most {}",
                                      declaration.delay, declaration.rate, most));
    }
    return static_cast<int>(whole);
}

}  // namespace

std::unique_ptr<control_law> make_control_law(const law_declaration& declaration, const idim_model_interface& model,
                                              const Eigen::VectorXd& chi) {
    declared_values values(declaration, model.dof);
    if (!(declaration.rate > 0.0)) {
        throw input_error(values.field("rate"), "missing, expected the sampling rate of the control law [Hz]");
    }
    std::unique_ptr<control_law> law = make_named(declaration, values, model, chi);
    law->rate = declaration.rate;
    law->delay = samples_of_delay(declaration, values);
    law->saturation = values.has("saturation") ? values.positive("saturation") : Eigen::VectorXd();
    values.refuse_others();
    law->drive_gain.resize(model.dof);
    for (int j = 0; j < model.dof; ++j) {
        law->drive_gain[j] = model.drive_gain[j] != 0.0 ? model.drive_gain[j] : 1.0;
    }
    law->tune(largest_inertia(model, chi));
    return law;
}

}  // namespace idim
