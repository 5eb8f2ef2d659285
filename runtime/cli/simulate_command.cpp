#include <fmt/format.h>

#include "description/robot_description.hpp"
#include "identified_parameters.hpp"
#include "idim/input_error.hpp"
#include "idim/simulation.hpp"
#include "measured_motion.hpp"

namespace idim::cli {

namespace {

struct simulate_options {
    std::string robot;
    std::string parameters;
    std::string reference;
    std::string output;
    std::string truth;
    std::vector<double> position_noise = {0.0};
    std::vector<double> torque_noise = {0.0};
    std::uint64_t seed = 1;
    int substeps = 10;
    std::string json_file;
};

/// One number per joint from one for all or one each.
Eigen::VectorXd per_joint(const std::vector<double>& values, int n, const char* what) {
    if (values.size() != 1 && values.size() != static_cast<std::size_t>(n)) {
        throw input_error({"", 0, what}, fmt::format("{} values given, expected 1 or {}", values.size(), n));
    }
    Eigen::VectorXd result(n);
    for (int j = 0; j < n; ++j) {
        result[j] = values[values.size() == 1 ? 0 : static_cast<std::size_t>(j)];
    }
    return result;
}

/// Values of the description's `control`, one per joint.
class control_reader {
  public:
    control_reader(const generator::robot_description& robot, int dof) : robot_(robot), dof_(dof) {
        if (!robot.control) {
            throw input_error({robot.file, 0, "control"},
                              "missing, expected a control law to simulate the closed loop");
        }
        if (robot.control->law != "pd_cascade") {
            throw input_error(robot.control->where, "law " + robot.control->law + " given, expected pd_cascade");
        }
        if (!(robot.control->rate > 0.0)) {
            throw input_error(robot.control->where, "expected rate: <Hz>");
        }
    }

    double rate() const { return robot_.control->rate; }
    bool has(const std::string& name) const { return robot_.control->values.count(name) != 0; }
    Eigen::VectorXd values(const std::string& name) const {
        const auto found = robot_.control->values.find(name);
        if (found == robot_.control->values.end()) {
            throw input_error(robot_.control->where, "expected " + name + ", or wn and zeta, one number per joint");
        }
        return per_joint(found->second, dof_, name.c_str());
    }

  private:
    const generator::robot_description& robot_;
    int dof_;
};

/// The declared law; a drive gain that is not given is 1, so that the drive command is the torque.
pd_cascade declared_law(const generator::robot_description& description, const loaded_robot& robot,
                        const Eigen::VectorXd& chi) {
    const idim_model_interface& model = robot.model();
    const control_reader control(description, model.dof);
    Eigen::VectorXd gain(model.dof);
    for (int j = 0; j < model.dof; ++j) {
        gain[j] = model.drive_gain[j] != 0.0 ? model.drive_gain[j] : 1.0;
    }
    pd_cascade law;
    if (control.has("wn")) {
        law = tune_pd_cascade(control.rate(), control.values("wn"), control.values("zeta"), largest_inertia(model, chi),
                              gain);
    } else {
        law = {control.rate(), control.values("kp"), control.values("kv"), gain, {}};
    }
    if (control.has("saturation")) {
        law.saturation = control.values("saturation");
    }
    return law;
}

int run(const simulate_options& options) {
    const loaded_robot robot = load_robot(options.robot);
    const Eigen::VectorXd chi = read_parameters(options.parameters, robot).chi;
    log_columns columns = columns_of(robot);
    columns.torque_required = false;
    const idim::log reference = read_log(options.reference, columns);
    if (reference.qr.size() == 0 || reference.samples() < 2) {
        throw input_error({options.reference, 1, ""}, "expected columns t and qr1.. with at least two rows");
    }
    const pd_cascade law = declared_law(generator::read_robot(options.robot), robot, chi);
    const int n = robot.model().dof;
    const measurement_noise noise{per_joint(options.position_noise, n, "--position-noise"),
                                  per_joint(options.torque_noise, n, "--torque-noise"), options.seed};
    const simulated_motion motion = simulate(robot.model(), chi, law, reference, noise, options.substeps);
    write_log(options.output, motion.measured);
    if (!options.truth.empty()) {
        write_log(options.truth, motion.truth);
    }
    const double tracking = (motion.truth.q - motion.measured.qr).norm() / motion.measured.qr.norm();
    write_json(options.json_file, {{"robot", robot.generated.robot},
                                   {"samples", motion.measured.samples()},
                                   {"rate", law.rate},
                                   {"seed", options.seed},
                                   {"relative_distance_to_reference", finite(tracking)}});
    if (prints_text(options.json_file)) {
        fmt::print("{}: {} samples at {} Hz in {}, {:.1f} % from the reference\n", robot.generated.robot,
                   motion.measured.samples(), law.rate, options.output, 100.0 * tracking);
    }
    return exit_done;
}

}  // namespace

void add_simulate_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<simulate_options>();
    CLI::App* command = app.add_subcommand("simulate", "closed-loop simulation with noise");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf) with a control law")->required();
    command
        ->add_option("--parameters", options->parameters,
                     "base parameters: result of identify, or a map of names to values")
        ->required();
    command->add_option("--reference", options->reference, "reference motion: CSV with t, qr1..")->required();
    command->add_option("-o,--output", options->output, "log to write (.csv, .csv.gz)")->required();
    command->add_option("--truth", options->truth, "motion without noise to write, with velocities and accelerations");
    command->add_option("--position-noise", options->position_noise,
                        "standard deviation [rad or m], one or one per joint");
    command->add_option("--torque-noise", options->torque_noise, "standard deviation [N*m or N], one or one per joint");
    command->add_option("--seed", options->seed, "of the noise");
    command->add_option("--substeps", options->substeps, "Runge-Kutta steps in one control period")
        ->check(CLI::Range(1, 10000));
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
