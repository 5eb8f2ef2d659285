#include <fmt/format.h>

#include <cmath>

#include "declared_law.hpp"
#include "description/robot_description.hpp"
#include "identified_parameters.hpp"
#include "idim/control_check.hpp"
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
    std::string truth_parameters;
    std::string checked_log;
    std::vector<double> position_noise = {0.0};
    std::vector<double> velocity_noise;
    std::vector<double> torque_noise = {0.0};
    std::vector<double> encoder_resolution;
    double position_correlation = 0.0;
    double torque_correlation = 0.0;
    std::uint64_t seed = 1;
    std::string integrator = "rk4";
    std::string friction = "located";
    integration_options integration;
    std::string json_file;
};

/// One number per joint, zero or more, from one for all or one each.
Eigen::VectorXd per_joint(const std::vector<double>& values, int n, const char* what) {
    if (values.size() != 1 && values.size() != static_cast<std::size_t>(n)) {
        throw input_error({"", 0, what}, fmt::format("{} values given, expected 1 or {}", values.size(), n));
    }
    Eigen::VectorXd result(n);
    for (int j = 0; j < n; ++j) {
        result[j] = values[values.size() == 1 ? 0 : static_cast<std::size_t>(j)];
        if (!std::isfinite(result[j]) || result[j] < 0.0) {
            throw input_error({"", 0, what}, fmt::format("{} given, expected numbers of zero or more", result[j]));
        }
    }
    return result;
}

measurement_noise noise_of(const simulate_options& options, int n) {
    measurement_noise noise{per_joint(options.position_noise, n, "--position-noise"),
                            per_joint(options.torque_noise, n, "--torque-noise"), options.seed};
    if (!options.velocity_noise.empty()) {
        noise.velocity = per_joint(options.velocity_noise, n, "--velocity-noise");
    }
    if (!options.encoder_resolution.empty()) {
        noise.resolution = per_joint(options.encoder_resolution, n, "--encoder-resolution");
    }
    noise.position_correlation = options.position_correlation;
    noise.torque_correlation = options.torque_correlation;
    return noise;
}

integration_options integration_of(const simulate_options& options) {
    integration_options integration = options.integration;
    integration.method = options.integrator == "rk4" ? integrator::rk4 : integrator::dopri5;
    integration.friction = options.friction == "located"       ? friction_handling::located
                           : options.friction == "regularised" ? friction_handling::regularised
                                                               : friction_handling::sign;
    return integration;
}

idim::log read_reference(const std::string& file, const loaded_robot& robot) {
    log_columns columns = columns_of(robot);
    columns.torque_required = false;
    idim::log reference = read_log(file, columns);
    if (reference.qr.size() == 0 || reference.samples() < 2) {
        throw input_error({file, 1, ""}, "expected columns t and qr1.. with at least two rows");
    }
    return reference;
}

std::vector<double> listed(const Eigen::VectorXd& values) {
    return {values.data(), values.data() + values.size()};
}

json effects_of(const std::string& robot_file) {
    const generator::robot_description robot = generator::read_robot(robot_file);
    json effects = json::array();
    for (const generator::effect_use& use : robot.effects) {
        json joints = json::array();
        for (const int joint : use.joints) {
            joints.push_back(robot.joints[static_cast<std::size_t>(joint)].name);
        }
        effects.push_back({{"effect", use.effect}, {"joints", joints}, {"shape", use.shape}});
    }
    return effects;
}

/// What the simulated robot was, as a file that --parameters takes.
json truth_of(const simulate_options& options, const loaded_robot& robot, const simulated_loop_setup& setup) {
    json parameters = json::array();
    for (int k = 0; k < robot.model().n_base; ++k) {
        parameters.push_back({{"name", robot.model().parameter_names[k]},
                              {"value", setup.chi[k]},
                              {"unit", robot.model().parameter_units[k]}});
    }
    return {{"robot", robot.generated.robot},
            {"description", options.robot},
            {"parameters", parameters},
            {"effects", effects_of(options.robot)},
            {"noise",
             {{"position", listed(setup.noise.position)},
              {"velocity", listed(setup.noise.velocity)},
              {"torque", listed(setup.noise.torque)},
              {"position_correlation", setup.noise.position_correlation},
              {"torque_correlation", setup.noise.torque_correlation},
              {"encoder_resolution", listed(setup.noise.resolution)},
              {"seed", setup.noise.seed}}},
            {"integrator", options.integrator},
            {"friction", options.friction}};
}

int simulate_loop(const simulate_options& options, const loaded_robot& robot, const Eigen::VectorXd& chi) {
    const idim::log reference = read_reference(options.reference, robot);
    const std::unique_ptr<control_law> law = declared_law(options.robot, robot, chi);
    simulated_loop_setup setup{robot.model(), chi, *law, reference};
    setup.noise = noise_of(options, robot.model().dof);
    setup.integration = integration_of(options);
    const simulated_motion motion = simulate(setup);
    if (motion.failure) {
        throw data_error(motion.failure->message);
    }
    write_log(options.output, motion.measured);
    if (!options.truth.empty()) {
        write_log(options.truth, motion.truth);
    }
    write_json(options.truth_parameters, truth_of(options, robot, setup));
    const double tracking = (motion.truth.q - motion.measured.qr).norm() / motion.measured.qr.norm();
    write_json(options.json_file, {{"robot", robot.generated.robot},
                                   {"samples", motion.measured.samples()},
                                   {"rate", law->rate},
                                   {"seed", options.seed},
                                   {"integrator", options.integrator},
                                   {"friction", options.friction},
                                   {"relative_distance_to_reference", finite(tracking)}});
    if (prints_text(options.json_file)) {
        fmt::print("{}: {} samples at {} Hz in {}, {:.1f} % from the reference ({}, friction {})\n",
                   robot.generated.robot, motion.measured.samples(), law->rate, options.output, 100.0 * tracking,
                   options.integrator, options.friction);
    }
    return exit_done;
}

int check_declared_law(const simulate_options& options, const loaded_robot& robot, const Eigen::VectorXd& chi) {
    const std::unique_ptr<control_law> law = declared_law(options.robot, robot, chi);
    const std::vector<joint_control_check> checks =
        check_control(*law, read_log(options.checked_log, columns_of(robot)));
    json joints = json::array();
    for (std::size_t j = 0; j < checks.size(); ++j) {
        const joint_control_check& check = checks[j];
        const std::string& name = robot.generated.joints[j].name;
        joints.push_back({{"joint", name},
                          {"recorded_rms", check.recorded_rms},
                          {"rms", check.rms},
                          {"share", check.share},
                          {"best_delay", check.best_delay},
                          {"best_rms", check.best_rms}});
        if (prints_text(options.json_file)) {
            fmt::print(
                "{}: the declared law misses the recorded command by {:.4g} rms of {:.4g} ({:.2f} %); best fit "
                "with {} more samples of delay: {:.4g} rms\n",
                name, check.rms, check.recorded_rms, 100.0 * check.share, check.best_delay, check.best_rms);
        }
    }
    write_json(options.json_file, {{"robot", robot.generated.robot}, {"rate", law->rate}, {"joints", joints}});
    return exit_done;
}

void require(const std::string& value, const char* option) {
    if (value.empty()) {
        throw input_error({"", 0, option}, "missing, expected unless --check-control is given");
    }
}

/// Gains from wn and zeta, and computed_torque, need the parameters; gains that are numbers do not.
Eigen::VectorXd parameters_of(const simulate_options& options, const loaded_robot& robot) {
    if (!options.parameters.empty()) {
        return read_parameters(options.parameters, robot).chi;
    }
    const auto control = generator::read_robot(options.robot).control;
    if (control && (control->law == "computed_torque" || control->values.count("wn") != 0)) {
        throw input_error({"", 0, "--parameters"}, "missing, expected for a law that depends on the robot's inertia");
    }
    return Eigen::VectorXd::Zero(robot.model().n_base);
}

int run(const simulate_options& options) {
    const bool checks = !options.checked_log.empty();
    if (!checks) {
        require(options.parameters, "--parameters");
        require(options.reference, "--reference");
        require(options.output, "-o");
    }
    const loaded_robot robot = load_robot(options.robot);
    const Eigen::VectorXd chi = parameters_of(options, robot);
    return checks ? check_declared_law(options, robot, chi) : simulate_loop(options, robot, chi);
}

}  // namespace

void add_simulate_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<simulate_options>();
    CLI::App* command = app.add_subcommand("simulate", "closed-loop simulation with noise");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf) with a control law")->required();
    command->add_option("--parameters", options->parameters,
                        "base parameters: result of identify, or a map of names to values");
    command->add_option("--reference", options->reference, "reference motion: CSV with t, qr1..");
    command->add_option("-o,--output", options->output, "log to write (.csv, .csv.gz)");
    command->add_option("--check-control", options->checked_log,
                        "instead: how well the declared law reproduces the drive command of this log");
    command->add_option("--truth-parameters", options->truth_parameters,
                        "JSON to write: parameters, effects, noise and seed of the simulated robot");
    command->add_option("--truth", options->truth, "motion without noise to write, with velocities and accelerations");
    command->add_option("--position-noise", options->position_noise,
                        "standard deviation [rad or m], one or one per joint");
    command->add_option("--torque-noise", options->torque_noise, "standard deviation [N*m or N], one or one per joint");
    command->add_option("--seed", options->seed, "of the noise");
    command->add_option("--velocity-noise", options->velocity_noise,
                        "standard deviation of the speed that the controller sees [rad/s or m/s]");
    command
        ->add_option("--position-correlation", options->position_correlation,
                     "correlation time of the position noise [s]; default 0, white")
        ->check(CLI::Range(0.0, 1e6));
    command->add_option("--torque-correlation", options->torque_correlation, "of the torque noise [s]")
        ->check(CLI::Range(0.0, 1e6));
    command->add_option("--encoder-resolution", options->encoder_resolution,
                        "step of the encoders [rad or m], one or one per joint");
    command->add_option("--integrator", options->integrator, "rk4 (fixed steps, default) or dopri5 (adaptive)")
        ->check(CLI::IsMember({"rk4", "dopri5"}));
    command
        ->add_option("--friction", options->friction,
                     "located (sign changes found, joints rest; default), regularised or sign")
        ->check(CLI::IsMember({"located", "regularised", "sign"}));
    command->add_option("--friction-band", options->integration.band, "of regularised friction [rad/s or m/s]")
        ->check(CLI::Range(1e-9, 1e3));
    command->add_option("--tolerance", options->integration.tolerance, "of dopri5, absolute and relative")
        ->check(CLI::Range(1e-14, 1e-2));
    command
        ->add_option("--substeps", options->integration.substeps,
                     "steps of rk4 in one control period; default: 1 ms or shorter")
        ->check(CLI::Range(1, 10000));
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
