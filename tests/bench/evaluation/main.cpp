// Nanoseconds per call of the generated code beside two libraries and a textbook recursion, one process, one core, the
// same states; then those per sample of its batch form. The engines have to agree first.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <random>
#include <stdexcept>

#include "description/robot_description.hpp"
#include "evaluation/engine.hpp"

namespace idim::bench {

namespace {

constexpr int states = 1024;

rigid_robot read(const std::string& name) {
    const std::string file = std::string(IDIM_SOURCE_DIR) + "/robots/" + name + "/" + name + ".yaml";
    rigid_robot robot{name, test::mdh_table_of(generator::read_robot(file)), {}};
    std::mt19937_64 random(5);
    robot.links = test::plausible_links(static_cast<int>(robot.table.rows.size()), random);
    return robot;
}

std::vector<test::joint_state> draw(Eigen::Index n) {
    std::mt19937_64 random(6);
    std::vector<test::joint_state> result;
    for (int k = 0; k < states; ++k) {
        result.push_back(test::random_state(n, random));
    }
    return result;
}

void require_agreement(const std::string& what, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    if (!((a - b).norm() <= 1e-8 * (1.0 + b.norm()))) {
        throw std::runtime_error(what + " differs between the engines");
    }
}

motion_samples stacked(const std::vector<test::joint_state>& all) {
    const auto rows = static_cast<Eigen::Index>(all.size());
    const Eigen::Index n = all.front().q.size();
    motion_samples result{Eigen::MatrixXd(rows, n), Eigen::MatrixXd(rows, n), Eigen::MatrixXd(rows, n)};
    for (Eigen::Index k = 0; k < rows; ++k) {
        const test::joint_state& s = all[static_cast<std::size_t>(k)];
        result.q.row(k) = s.q;
        result.qd.row(k) = s.qd;
        result.qdd.row(k) = s.qdd;
    }
    return result;
}

void check_batch(engine& e, const std::vector<test::joint_state>& all) {
    Eigen::MatrixXd tau, W;
    const motion_samples samples = stacked(all);
    if (!e.inverse_dynamics(samples, tau) || !e.regressor(samples, W)) {
        return;
    }
    const Eigen::Index n = samples.q.cols();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        Eigen::VectorXd expected(n);
        row_major expected_W(n, e.parameters().size());
        e.inverse_dynamics(all[k], expected);
        e.regressor(all[k], expected_W);
        require_agreement(e.name() + ": torque of a batch", tau.row(row).transpose(), expected);
        require_agreement(e.name() + ": regressor of a batch", W.row(row).transpose(),
                          expected_W.reshaped<Eigen::RowMajor>());
    }
}

void check(engine& e, engine& reference, const std::vector<test::joint_state>& all) {
    const Eigen::Index n = all.front().q.size();
    for (const test::joint_state& s : all) {
        Eigen::VectorXd tau(n), expected(n), qdd(n);
        row_major M(n, n), expected_M(n, n), W(n, n);
        e.inverse_dynamics(s, tau);
        reference.inverse_dynamics(s, expected);
        require_agreement(e.name() + ": torque", tau, expected);
        e.mass_matrix(s.q, M);
        reference.mass_matrix(s.q, expected_M);
        require_agreement(e.name() + ": inertia matrix", M.reshaped(), expected_M.reshaped());
        e.forward_dynamics(s, expected, qdd);
        require_agreement(e.name() + ": acceleration", qdd, s.qdd);
        if (e.regressor(s, W)) {
            require_agreement(e.name() + ": regressor", W * e.parameters(), expected);
        }
    }
}

/// Collects nanoseconds by the name of the run.
class collector : public benchmark::BenchmarkReporter {
  public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.aggregate_name == "median") {
                nanoseconds[run.run_name.function_name] = run.GetAdjustedCPUTime();
            }
        }
    }
    std::map<std::string, double> nanoseconds;
};

using call = std::function<void(engine&, const test::joint_state&)>;

std::map<std::string, call> calls(Eigen::Index n) {
    const auto tau = std::make_shared<Eigen::VectorXd>(Eigen::VectorXd::Ones(n));
    const auto out = std::make_shared<Eigen::VectorXd>(n);
    const auto M = std::make_shared<row_major>(n, n);
    const auto W = std::make_shared<row_major>(n, n);
    return {
        {"1 inverse dynamics", [=](engine& e, const test::joint_state& s) { e.inverse_dynamics(s, *out); }},
        {"2 regressor", [=](engine& e, const test::joint_state& s) { e.regressor(s, *W); }},
        {"3 inertia matrix", [=](engine& e, const test::joint_state& s) { e.mass_matrix(s.q, *M); }},
        {"4 direct model", [=](engine& e, const test::joint_state& s) { e.forward_dynamics(s, *tau, *out); }},
    };
}

void print(const std::vector<std::string>& robots, const std::vector<std::string>& engines,
           const std::map<std::string, double>& nanoseconds) {
    fmt::print("{:<12} {:<18}", "robot", "ns per call");
    for (const std::string& name : engines) {
        fmt::print(" {:>20}", name);
    }
    fmt::print("\n");
    for (const std::string& robot : robots) {
        for (const auto& [what, function] : calls(1)) {
            fmt::print("{:<12} {:<18}", robot, what.substr(2));
            const double ours = nanoseconds.at(robot + "/" + what + "/" + engines.front());
            for (const std::string& name : engines) {
                const auto found = nanoseconds.find(robot + "/" + what + "/" + name);
                fmt::print(" {:>20}", found == nanoseconds.end()
                                          ? "-"
                                          : fmt::format("{:.0f} ({:.1f}x)", found->second, found->second / ours));
            }
            fmt::print("\n");
        }
    }
}

/// Nanoseconds per sample of the batch form beside those of one call.
void print_batch(const std::vector<std::string>& robots, const std::string& name,
                 const std::map<std::string, double>& nanoseconds) {
    fmt::print("\n{:<12} {:<18} {:>20} {:>20}\n", "robot", "ns per sample", name, "in a batch");
    for (const std::string& robot : robots) {
        for (const std::string what : {"1 inverse dynamics", "2 regressor"}) {
            const double one = nanoseconds.at(robot + "/" + what + "/" + name);
            const double batch = nanoseconds.at(robot + "/" + what + "/batch") / states;
            fmt::print("{:<12} {:<18} {:>20.0f} {:>20}\n", robot, what.substr(2), one,
                       fmt::format("{:.0f} ({:.2f}x)", batch, batch / one));
        }
    }
}

void register_batch(const std::string& robot, const std::shared_ptr<engine>& e,
                    const std::vector<test::joint_state>& all) {
    const auto samples = std::make_shared<motion_samples>(stacked(all));
    const auto out = std::make_shared<Eigen::MatrixXd>();
    const auto measure = [&](const std::string& what, const std::function<void()>& function) {
        benchmark::RegisterBenchmark((robot + "/" + what + "/batch").c_str(),
                                     [function](benchmark::State& state) {
                                         for (auto _ : state) {
                                             function();
                                             benchmark::ClobberMemory();
                                         }
                                     })
            ->Repetitions(5)
            ->MinTime(0.05);
    };
    measure("1 inverse dynamics", [=] { e->inverse_dynamics(*samples, *out); });
    measure("2 regressor", [=] { e->regressor(*samples, *out); });
}

int run() {
    std::vector<std::shared_ptr<engine>> keep;
    std::vector<std::string> names;
    const std::vector<std::string> robots = {"scara", "rx90", "kuka_lwr"};
    for (const std::string& name : robots) {
        const rigid_robot robot = read(name);
        const auto all =
            std::make_shared<std::vector<test::joint_state>>(draw(static_cast<Eigen::Index>(robot.links.size())));
        names.clear();
        for (const auto make : {generated_engine, kdl_engine, mujoco_engine, eigen_engine}) {
            const std::shared_ptr<engine> e = make(robot);
            check(*e, *kdl_engine(robot), *all);
            check_batch(*e, *all);
            keep.push_back(e);
            names.push_back(e->name());
            row_major none;
            const bool has_regressor = e->regressor(all->front(), none);
            for (const auto& [what, function] : calls(static_cast<Eigen::Index>(robot.links.size()))) {
                if (what == "2 regressor" && !has_regressor) {
                    continue;
                }
                const std::string title = robot.name + "/" + what + "/" + e->name();
                benchmark::RegisterBenchmark(title.c_str(),
                                             [e, all, function](benchmark::State& state) {
                                                 std::size_t k = 0;
                                                 for (auto _ : state) {
                                                     function(*e, (*all)[k++ % states]);
                                                     benchmark::ClobberMemory();
                                                 }
                                             })
                    ->Repetitions(5)
                    ->MinTime(0.05);
            }
        }
        register_batch(name, keep[keep.size() - names.size()], *all);
    }
    collector results;
    benchmark::RunSpecifiedBenchmarks(&results);
    print(robots, names, results.nanoseconds);
    print_batch(robots, names.front(), results.nanoseconds);
    return 0;
}

}  // namespace

}  // namespace idim::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    return idim::bench::run();
}
