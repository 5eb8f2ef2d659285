// Nanoseconds per call of the generated code beside two libraries and a textbook recursion, one process, one core, the
// same states; the engines have to agree first.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <random>
#include <stdexcept>

#include "description/robot_description.hpp"
#include "evaluation/engine.hpp"

namespace idim::bench {

namespace {

constexpr int states = 64;

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
    }
    collector results;
    benchmark::RunSpecifiedBenchmarks(&results);
    print(robots, names, results.nanoseconds);
    return 0;
}

}  // namespace

}  // namespace idim::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    return idim::bench::run();
}
