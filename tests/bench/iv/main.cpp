// Figures of the instrumental variable method: the tables of its paper beside ours, bias and coverage over many draws
// of the noise, and what one iteration costs. Usage: iv_bench [DRAWS], default 200.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "description/robot_description.hpp"
#include "oracles/mdh_row.hpp"
#include "oracles/mujoco_arm.hpp"
#include "oracles/rigid_link.hpp"
#include "support/loop_experiments.hpp"
#include "support/urdf_text.hpp"

extern "C" const idim_model_interface* idim_model_scara(void);
extern "C" const idim_model_interface* idim_model_rx90(void);

namespace idim::bench {

namespace {

using test::scara_experiment;

const char* const names[] = {"ZZ1R", "Fv1", "Fc1", "ZZ2R", "LMX2", "LMY2", "Fv2", "Fc2"};
const double table_1[] = {3.44, 0.03, 0.82, 0.062, 0.121, 0.007, 0.013, 0.137};
const double table_1_two_sigma[] = {0.034, 0.031, 0.1, 0.0006, 0.0014, 0.0007, 0.006, 0.006};
const double table_4[][4] = {{1.0, 3.46, 3.45, 3.45},   {0, 0.04, 0.02, 0.02},    {0, 0.82, 0.85, 0.85},
                             {1.0, 0.06, 0.061, 0.061}, {0, 0.122, 0.124, 0.124}, {0, 0.05, 0.07, 0.07},
                             {0, 0.005, 0.01, 0.01},    {0, 0.130, 0.132, 0.132}};
const double table_5[] = {1.5, 0.095, 0.55, 0.14, 0.63, 0.1, 0.001, 0.19};
const double table_5_two_sigma[] = {0.05, 0.15, 0.26, 0.018, 0.035, 0.023, 0.143, 0.244};

double in_paper_units(const Eigen::VectorXd& values, int k) {
    return values[k] * scara_experiment::scale()[k];
}

void print_estimate(const std::string& title, const estimate& fit, const double* published,
                    const double* published_two_sigma) {
    fmt::print("\n{}: {}; relative error {:.2f} %\n", title, fit.message, 100.0 * fit.residual.relative_error);
    if (fit.chi.size() == 0) {
        return;
    }
    fmt::print("  {:<6} {:>8} {:>9} {:>9} | {:>9} {:>9}\n", "", "truth", "ours", "2 sigma", "paper", "2 sigma");
    for (int k = 0; k < 8; ++k) {
        fmt::print("  {:<6} {:>8.4g} {:>9.4g} {:>9.2g} |", names[k], table_1[k], in_paper_units(fit.chi, k),
                   2.0 * in_paper_units(fit.deviations(), k));
        if (published != nullptr) {
            fmt::print(" {:>9.4g} {:>9.2g}", published[k], published_two_sigma[k]);
        }
        fmt::print("\n");
    }
}

void print_steps(const estimate& fit) {
    for (int k = 0; k < 8; ++k) {
        fmt::print("  {:<6}", names[k]);
        for (std::size_t step = 0; step < 4; ++step) {
            const std::size_t ours = std::min(step, fit.iterations.size() - 1);
            fmt::print(" {:>8.4g} ({:>5.4g})", in_paper_units(fit.iterations[ours].chi, k), table_4[k][step]);
        }
        fmt::print("\n");
    }
}

/// [IV figures 8-9]: the paper has 0.5, 5 and 10 % from the measured motion, 1.5, 15 and 30 % from the reference.
void print_distances(const estimate& fit) {
    fmt::print("  distance of the simulated motion, position / velocity / acceleration in %\n");
    for (std::size_t k = 0; k < fit.iterations.size(); ++k) {
        for (std::size_t j = 0; j < 2; ++j) {
            const motion_distance& m = fit.iterations[k].to_measured[j];
            const motion_distance& r = fit.iterations[k].to_reference[j];
            fmt::print("  step {} joint {}: measured {:.3f} / {:.3f} / {:.2f}, reference {:.1f} / {:.1f} / {:.1f}\n", k,
                       j + 1, 100.0 * m.q, 100.0 * m.qd, 100.0 * m.qdd, 100.0 * r.q, 100.0 * r.qd, 100.0 * r.qdd);
        }
    }
}

void print_paper(const idim_model_interface& model) {
    const scara_experiment filtered(model, true, 1);
    const scara_experiment raw(model, false, 1);
    const Eigen::VectorXd regular = regular_start(model);
    const estimate ls = filtered.ls();
    print_estimate("Table 1, least squares, filtered", ls, table_1, table_1_two_sigma);
    print_estimate("Table 2, IV from least squares, filtered (paper: 2 steps)", filtered.iv(ls.chi).fit, nullptr,
                   nullptr);
    const estimate from_regular = filtered.iv(regular).fit;
    print_estimate("Table 3, IV from a regular start, filtered (paper: 3 steps)", from_regular, nullptr, nullptr);
    fmt::print("\nTable 4, convergence, steps 0 to 3, ours (paper)\n");
    print_steps(from_regular);
    print_distances(from_regular);
    print_estimate("Table 5, least squares, not filtered", raw.ls(), table_5, table_5_two_sigma);
    print_estimate("Table 6, IV from a regular start, not filtered", raw.iv(regular).fit, nullptr, nullptr);
    print_estimate("Table 7, half the bandwidth (paper: 6 steps)", filtered.iv(regular, 0.5).fit, nullptr, nullptr);
    for (const double scale : {0.33, 0.3, 0.25, 0.2}) {
        fmt::print("\n{} of the bandwidth: {}\n", scale, filtered.iv(regular, scale).fit.message);
    }
}

/// Error of many draws: mean in standard errors, and share of the 95 % intervals that hold the truth.
struct tally {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(8), squares = sum, covered = sum;
    int runs = 0;

    void add(const estimate& fit) {
        if (fit.chi.size() == 0) {
            return;
        }
        const Eigen::ArrayXd error = (fit.chi - scara_experiment::truth()).array();
        sum += error;
        squares += error.square();
        covered += (error.abs() < 1.96 * fit.deviations().array()).cast<double>();
        ++runs;
    }
    std::string text(int k) const {
        const double mean = sum[k] / runs;
        const double error = std::sqrt((squares[k] / runs - mean * mean) / runs);
        return fmt::format("{:>8.2f} {:>6.1f} {:>5.1f}", 100.0 * mean / scara_experiment::truth()[k], mean / error,
                           100.0 * covered[k] / runs);
    }
};

void print_draws(const idim_model_interface& model, int draws) {
    for (const bool filtered : {true, false}) {
        tally ls, iv, corrected;
        for (int draw = 1; draw <= draws; ++draw) {
            const scara_experiment experiment(model, filtered, static_cast<std::uint64_t>(draw));
            const estimate start = experiment.ls();
            const Eigen::VectorXd from = filtered ? start.chi : scara_experiment::truth();
            ls.add(start);
            iv.add(experiment.iv(from).fit);
            corrected.add(experiment.iv(from, 1.0, true).fit);
        }
        fmt::print("\n{} draws, {}: bias in %, in standard errors of the mean, coverage of the 95 % intervals in %\n",
                   draws, filtered ? "filtered" : "not filtered");
        fmt::print("  {:<6} {:>21}   {:>21}   {:>21}\n", "", "least squares", "IV", "IV, processing off");
        for (int k = 0; k < 8; ++k) {
            fmt::print("  {:<6} {}   {}   {}\n", names[k], ls.text(k), iv.text(k), corrected.text(k));
        }
        fmt::print("  results in {}, {} and {} draws\n", ls.runs, iv.runs, corrected.runs);
    }
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_speed(const idim_model_interface& model) {
    const std::string file = std::string(IDIM_SOURCE_DIR) + "/robots/rx90/rx90.yaml";
    const test::mdh_table table = test::mdh_table_of(generator::read_robot(file));
    std::mt19937_64 random(11);
    const std::vector<test::rigid_link> links = test::plausible_links(6, random);
    test::value_table standard = test::standard_parameters_of(links);
    std::vector<std::string> joints;
    for (int j = 1; j <= 6; ++j) {
        joints.push_back("j" + std::to_string(j));
        standard["Ia" + std::to_string(j)] = 0.3;
        standard["Fv" + std::to_string(j)] = 1.0;
        standard["Fc" + std::to_string(j)] = 1.0;
    }
    Eigen::VectorXd values = Eigen::VectorXd::Zero(model.n_standard);
    for (int s = 0; s < model.n_standard; ++s) {
        const auto found = standard.find(model.standard_names[s]);
        values[s] = found == standard.end() ? 0.0 : found->second;
    }
    Eigen::VectorXd truth(model.n_base);
    model.regroup(values.data(), truth.data());
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(6);
    const Eigen::VectorXd wn = 25.0 * ones;
    const pd_cascade law = tune_pd_cascade(1000.0, wn, ones, largest_inertia(model, truth), ones);
    const test::mujoco_arm arm{test::mujoco_robot(test::urdf_of(table, links), joints),
                               0.3 * ones,
                               ones,
                               ones,
                               1000.0,
                               law.kp,
                               law.kv,
                               1e-5,
                               ones};
    const log reference = test::arm_reference(0.0 * ones, 1.0, 60.0, 5);
    std::vector<log> logs(1);
    const double mujoco = seconds_of([&] { logs[0] = arm.record(reference, 7); });
    const double simulation = seconds_of([&] { simulate(model, truth, law, logs[0], {0.0 * ones, 0.0 * ones, 1}, 2); });
    const filter_choice filter = choose_filter(logs, {});
    const loop_experiment experiment{model, logs, filter};
    const closed_loop loop = test::cascade_loop(model, 1000.0, wn);
    const observation rows = observe_steady(experiment, loop);
    loop_options once;
    once.most_iterations = 1;
    const double iterations =
        seconds_of([&] { identify_in_loop(experiment, loop, rows, loop_method::iv, truth, once); });
    fmt::print(
        "\nrx90, 6 joints, {} parameters, 60 s at 1 kHz control, Runge-Kutta with two steps a period\n"
        "  simulation: {:.2f} s, {:.0f} times real time; the same loop on MuJoCo: {:.2f} s, {:.0f} times\n"
        "  an iteration of IV (four steps a period, filter, regressor, QR): {:.2f} s\n",
        model.n_base, simulation, 60.0 / simulation, mujoco, 60.0 / mujoco, 0.5 * iterations);
}

}  // namespace

}  // namespace idim::bench

int main(int count, char** arguments) {
    const int draws = count > 1 ? std::atoi(arguments[1]) : 200;
    idim::bench::print_paper(*idim_model_scara());
    idim::bench::print_speed(*idim_model_rx90());
    idim::bench::print_draws(*idim_model_scara(), draws);
}
