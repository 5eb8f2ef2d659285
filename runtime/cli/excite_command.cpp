#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>

#include "description/robot_description.hpp"
#include "excitation_limits.hpp"
#include "excitation_report.hpp"
#include "idim/excitation_search.hpp"
#include "idim/input_error.hpp"
#include "idim/multisine.hpp"
#include "interrupt_watch.hpp"

namespace idim::cli {

namespace {

struct excite_options {
    std::string robot;
    std::string output;
    std::string form = "optimised";
    std::string criterion = "condition";
    limit_options limits;
    double period = 0.0;
    int periods = 12;
    int sinusoids = 0;
    double rest = 4.0;
    double connection = 5.0;
    double rate = 0.0;
    bool with_derivatives = false;
    search_options search;
    std::string json_file;
};

/// A line on standard error at most every two seconds, and what the user says by an interrupt.
class progress_line {
  public:
    explicit progress_line(excitation_criterion criterion) : criterion_(criterion) {}

    bool operator()(const search_progress& progress) {
        if (progress.seconds >= next_) {
            next_ = progress.seconds + 2.0;
            const std::string best = std::isnan(progress.best) ? "no motion within the limits yet"
                                     : criterion_ != excitation_criterion::information
                                         ? fmt::format("condition number {:.2f}", progress.best)
                                         : fmt::format("log det {:.2f}", progress.best);
            fmt::print(stderr, "idim: start {} of {}, {} evaluations, {:.0f} s: {}\n", progress.start, progress.starts,
                       progress.evaluations, progress.seconds, best);
        }
        return !interrupt_watch::interrupted();
    }

  private:
    excitation_criterion criterion_;
    double next_ = 2.0;
};

void require_whole_samples(double seconds, double rate, const char* option) {
    const double samples = seconds * rate;
    if (std::abs(samples - std::round(samples)) > 1e-6 * std::max(1.0, samples)) {
        throw input_error({"", 0, option},
                          fmt::format("{} s, expected a whole number of samples at {} Hz", seconds, rate));
    }
}

/// The published ratio: 55 sinusoids for 48 base parameters.
int sinusoids_of(const excite_options& options, const idim_model_interface& model) {
    return options.sinusoids > 0 ? options.sinusoids : model.n_base + 7;
}

double rate_of(const excite_options& options) {
    const auto description = generator::read_robot(options.robot);
    return options.rate > 0.0 ? options.rate : description.control ? description.control->rate : 100.0;
}

/// Rest, connections, rate and periods; the series is empty but for its period.
excitation_plan form_of(const excite_options& options, const limited_robot& robot) {
    constexpr double optimised_period = 20.0;
    excitation_plan form;
    form.periods = options.periods;
    form.rest_time = options.rest;
    form.connection_time = options.connection;
    form.rate = rate_of(options);
    const double lowest = limit_frequencies(robot.limits).minCoeff();
    form.series.period = options.period > 0.0          ? options.period
                         : options.form == "optimised" ? optimised_period
                                                       : std::ceil(sinusoids_of(options, robot.model) / lowest);
    require_whole_samples(form.series.period, form.rate, "--period");
    require_whole_samples(form.rest_time, form.rate, "--rest");
    require_whole_samples(form.connection_time, form.rate, "--connection");
    if (options.form == "multisine" && form.series.period * lowest < 1.0) {
        throw input_error({"", 0, "--period"},
                          fmt::format("{} s, expected at least {:.4g} s, a period of the lowest limit frequency",
                                      form.series.period, 1.0 / lowest));
    }
    return form;
}

/// The published form has its rest at the centre of the ranges; others where the limits allow it.
rest_choice rest_of(const excite_options& options, const limited_robot& robot) {
    if (options.form == "multisine") {
        return {robot.limits.centre(), {}};
    }
    rest_choice rest = choose_rest(robot, options.search.seed);
    if (rest.breach.share >= 0.0) {
        throw input_error({options.limits.workspace.empty() ? options.robot : "", 0, rest.breach.limit},
                          fmt::format("no position keeps this limit and the others, the best one is {:.3g} % past it; "
                                      "expected limits that leave room",
                                      100.0 * rest.breach.share));
    }
    return rest;
}

excitation_plan published_plan(const excite_options& options, const limited_robot& robot, excitation_plan plan) {
    plan.series =
        make_multisine(robot.limits, {plan.series.period, sinusoids_of(options, robot.model), options.search.seed});
    choose_start(robot, plan);
    const limit_breach breach = largest_breach(robot, plan);
    if (breach.share > 0.0) {
        throw input_error({"", 0, breach.limit},
                          fmt::format("the published form goes {:.3g} % past it, expected wider limits, a longer "
                                      "--connection, another --seed, or --form optimised",
                                      100.0 * breach.share));
    }
    return plan;
}

search_result found_plan(const excite_options& options, const limited_robot& robot, const excitation_plan& form) {
    search_options search = options.search;
    search.criterion = options.criterion == "condition"  ? excitation_criterion::condition
                       : options.criterion == "unscaled" ? excitation_criterion::unscaled_condition
                                                         : excitation_criterion::information;
    search.proceed = progress_line(search.criterion);
    const interrupt_watch watch;
    search_result result = search_excitation(robot, form, search);
    if (!result.found && result.stopped) {
        throw data_error("interrupted before a motion within the limits was found: nothing written");
    }
    if (!result.found) {
        throw input_error({options.robot, 0, "limits"},
                          fmt::format("no motion found within them, the best one goes {:.3g} % past the {}; expected "
                                      "wider limits, or a longer --period or --connection",
                                      100.0 * result.breach.share, result.breach.limit));
    }
    return result;
}

int run(const excite_options& options) {
    const loaded_robot loaded = load_robot(options.robot);
    const limited_robot robot = limited(loaded, options.robot, options.limits);
    excitation_plan form = form_of(options, robot);
    form.rest = rest_of(options, robot).q;
    search_result result;
    if (options.form == "multisine") {
        result.plan = published_plan(options, robot, form);
    } else {
        result = found_plan(options, robot, form);
    }
    excitation_report report =
        report_on(robot, result, sinusoids_of(options, robot.model), options.search.seed, options.form == "optimised");
    report.form = options.form;
    report.criterion = options.criterion;
    write_log(options.output, reference_of(result.plan, options.with_derivatives));
    write_json(options.json_file, to_json(report, robot, options.output));
    if (prints_text(options.json_file)) {
        print(report, robot, options.output);
    }
    return exit_done;
}

void add_search_options(CLI::App& command, excite_options& options) {
    command
        .add_option("--criterion", options.criterion,
                    "of optimised: condition (default; condition number of the regressor with columns of norm one), "
                    "unscaled (columns in the units of the parameters) or information (-log det)")
        ->check(CLI::IsMember({"condition", "unscaled", "information"}));
    command.add_option("--harmonics", options.search.harmonics, "of optimised: terms of each series; default 16")
        ->check(CLI::Range(1, 200));
    command.add_option("--starts", options.search.starts, "of optimised: random starts; default 6")
        ->check(CLI::Range(1, 100000));
    command.add_option("--evaluations", options.search.evaluations, "of optimised: of each start; default 300")
        ->check(CLI::Range(3, 1000000));
    command
        .add_option("--time-limit", options.search.seconds,
                    "of optimised [s]; default 120. The result is the same everywhere if this is not reached")
        ->check(CLI::PositiveNumber);
}

}  // namespace

void add_excite_command(CLI::App& app, action& chosen) {
    const auto options = std::make_shared<excite_options>();
    CLI::App* command = app.add_subcommand("excite", "an exciting reference within the limits");
    command->add_option("robot", options->robot, "robot description (.yaml, .urdf)")->required();
    command->add_option("-o,--output", options->output, "reference to write (.csv, .csv.gz)")->required();
    command
        ->add_option("--form", options->form,
                     "optimised (default; Fourier series) or multisine (as published: equal amplitudes, random phases)")
        ->check(CLI::IsMember({"optimised", "multisine"}));
    command->add_option("--period", options->period, "[s]; default 20, of multisine: long enough for its sinusoids")
        ->check(CLI::PositiveNumber);
    command->add_option("--periods", options->periods, "default 12")->check(CLI::Range(1, 100000));
    command
        ->add_option("--sinusoids", options->sinusoids,
                     "of multisine, for each joint; default: 7 more than base parameters, as published")
        ->check(CLI::Range(1, 100000));
    command->add_option("--seed", options->search.seed, "of phases and random starts; default 1");
    command->add_option("--rest", options->rest, "at rest before and after [s]; default 4")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--connection", options->connection, "between rest and the periods [s]; default 5")
        ->check(CLI::PositiveNumber);
    command->add_option("--rate", options->rate, "of the reference [Hz]; default: of the control law, else 100")
        ->check(CLI::PositiveNumber);
    command->add_flag("--derivatives", options->with_derivatives, "write velocities and accelerations too");
    add_search_options(*command, *options);
    add_limit_options(*command, options->limits);
    add_json_option(*command, options->json_file);
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace idim::cli
