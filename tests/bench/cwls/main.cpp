// Constrained least squares of six links, 84 parameters, to a gap of 1e-8 of the objective: our barrier method beside
// the semi-definite solver CSDP on the same problem.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "oracles/csdp.hpp"
#include "support/cone_problem.hpp"

namespace idim::bench {

namespace {

/// Median of several runs [ms].
double milliseconds(const std::function<void()>& work) {
    constexpr int runs = 5;
    std::vector<double> taken;
    for (int k = 0; k < runs; ++k) {
        const auto start = std::chrono::steady_clock::now();
        work();
        taken.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(taken.begin(), taken.begin() + runs / 2, taken.end());
    return taken[runs / 2];
}

void compare(const char* title, double noise) {
    const test::random_problem problem(noise);
    cone_solution found;
    const double ours = milliseconds([&] { found = solve(problem.program, problem.start, 1e-8); });
    std::optional<test::csdp_optimum> other;
    const double csdp = milliseconds([&] { other = test::solve_with_csdp(problem.program, found.objective); });
    if (!found.converged || !other) {
        fmt::print("{}: {}\n", title, found.converged ? "csdp cannot be run" : "ours stalled");
        return;
    }
    fmt::print("{:<34} {:>8.2f} ms {:>4} steps  {:>8.2f} ms  {:>6.2f}  {:>10.2g}\n", title, ours, found.steps, csdp,
               csdp / ours, problem.objective(other->x) / found.objective - 1.0);
}

}  // namespace

}  // namespace idim::bench

int main() {
    fmt::print(
        "cwls of 6 links, {} parameters seen through {} combinations, gap 1e-8; csdp: a process, its files read "
        "and written\n{:<34} {:>22}  {:>11}  {:>6}  {:>10}\n",
        idim::test::random_problem::parameter_count, idim::test::random_problem::equations, "", "ours", "csdp", "ratio",
        "objective");
    idim::bench::compare("truth consistent, little noise", 1.0);
    idim::bench::compare("noise that leads outside", 300.0);
}
