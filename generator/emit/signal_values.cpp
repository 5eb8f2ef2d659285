#include "emit/signal_values.hpp"

#include <fmt/format.h>

#include <functional>
#include <tuple>
#include <vector>

namespace idim::generator {

namespace {

/// Arguments that functions take beside the motion, as the code around them spells each; its place is that in the
/// array of signals of model_interface.h.
class signal_arguments {
  public:
    explicit signal_arguments(const template_context& context)
        : context_(context),
          n_(context.joints.size()),
          motor_(n_ + context.states.size()),
          rigid_(motor_ + (context.has_elastic_joint ? 3 * n_ : 0)) {}

    using spelling = std::function<std::string(const std::string& name, std::size_t place)>;

    std::string text(const std::string& names, const spelling& spelled) const {
        const std::vector<std::tuple<std::string, bool, std::size_t>> all = {
            {"t", context_.uses_time, 0},
            {"temp", context_.uses_temperature, 0},
            {"state", !context_.states.empty(), n_},
            {"tau_rigid", context_.uses_rigid_torque, rigid_},
            {"motor", context_.has_elastic_joint, motor_}};
        std::string result;
        for (const auto& [name, used, place] : all) {
            const bool wanted = (" " + names + " ").find(" " + name + " ") != std::string::npos;
            result += used && wanted ? spelled(name, place) + ", " : "";
        }
        return result;
    }
    std::size_t motor_place() const { return motor_; }
    std::size_t rigid_place() const { return rigid_; }
    std::size_t count() const {
        const std::size_t further = rigid_ + (context_.uses_rigid_torque ? n_ : 0);
        return further > n_ || context_.uses_temperature ? further : 0;
    }

  private:
    const template_context& context_;
    std::size_t n_, motor_, rigid_;
};

std::string in_signals(const std::string& name, std::size_t place) {
    return name == "t" ? name : place == 0 ? "signals" : fmt::format("signals + {}", place);
}

std::string in_pack(const std::string& name, std::size_t /*place*/) {
    return "at." + name;
}

}  // namespace

void set_signals(context_data& values, const template_context& context) {
    const signal_arguments arguments(context);
    const auto without_load = [](const std::string& name, std::size_t place) {
        return name == "tau_rigid" ? "no_load" : in_signals(name, place);
    };
    values.set("time_argument", context.uses_time ? "double t" : "double");
    values.set("time_or_zero", context.uses_time ? "t" : "0.0");
    values.set("load_time_argument", context.has_payload ? "double t" : "double");
    values.set("load_time", context.has_payload ? "t, " : "");
    values.set("no_load_time", context.has_payload ? "std::numeric_limits<double>::infinity(), " : "");
    const auto argument = [](bool used) { return used ? "const double* signals" : "const double*"; };
    values.set("signals_argument", argument(arguments.count() > 0));
    values.set("state_signals_argument", argument(context.uses_temperature || !context.states.empty()));
    values.set("torque_signals_argument",
               argument(context.uses_temperature || !context.states.empty() || context.has_elastic_joint));
    values.set("first_signals_argument", argument(context.uses_temperature || context.has_elastic_joint));
    values.set("regressor_signals", arguments.text("t temp state tau_rigid motor", in_signals));
    values.set("torque_signals", arguments.text("t temp state motor", in_signals));
    values.set("bias_signals", arguments.text("t temp state", in_signals));
    values.set("first_signals", arguments.text("t temp motor", in_signals));
    values.set("start_signals", arguments.text("t temp state tau_rigid", without_load));
    values.set("packed_regressor_signals", arguments.text("t temp state tau_rigid motor", in_pack));
    values.set("packed_torque_signals", arguments.text("t temp state motor", in_pack));
    values.set("n_signals", std::to_string(arguments.count()));
    values.set("n_states", std::to_string(context.states.size()));
    values.set("state_place", std::to_string(context.joints.size()));
    values.set("motor_place", std::to_string(arguments.motor_place()));
    values.set("rigid_place", std::to_string(arguments.rigid_place()));
}

}  // namespace idim::generator
