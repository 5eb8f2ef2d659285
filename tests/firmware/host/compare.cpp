// Reads what the firmware printed and computes each call again, in double precision with a bound on what single
// precision may differ by. Exit status 1 where a result lies outside its bound, or where a bound says nothing.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/rounded.hpp"
#include "models/robot_model.hpp"

extern const robot_model<rounded> scara_cpp, rx90_cpp, kuka_lwr_cpp;

namespace {

using model = robot_model<rounded>;
using numbers = std::vector<rounded>;

const model& find_model(const std::string& robot) {
    for (const model* known : {&scara_cpp, &rx90_cpp, &kuka_lwr_cpp}) {
        if (robot == known->name) {
            return *known;
        }
    }
    throw std::runtime_error("no robot " + robot);
}

/// One function: how many numbers it reads and writes, and the call.
struct function {
    std::size_t arguments, results;
    void (*call)(const model& m, const rounded* in, rounded* out);
};

function find_function(const model& m, const std::string& name) {
    const auto n = static_cast<std::size_t>(m.dof), b = static_cast<std::size_t>(m.base_parameters);
    if (name == "regroup") {
        return {static_cast<std::size_t>(m.standard_parameters), b,
                [](const model& r, const rounded* in, rounded* out) { r.regroup(in, out); }};
    }
    if (name == "inverse_dynamics") {
        return {3 * n + b, n, [](const model& r, const rounded* in, rounded* out) {
                    r.inverse_dynamics(in, in + r.dof, in + 2 * r.dof, in + 3 * r.dof, out);
                }};
    }
    if (name == "mass_matrix") {
        return {n + b, n * n,
                [](const model& r, const rounded* in, rounded* out) { r.mass_matrix(in, in + r.dof, out); }};
    }
    if (name == "forward_dynamics") {
        return {3 * n + b, 2 * n, [](const model& r, const rounded* in, rounded* out) {
                    r.forward_dynamics(in, in + r.dof, in + 2 * r.dof, in + 3 * r.dof, out, out + r.dof);
                }};
    }
    if (name == "regressor") {
        return {3 * n, n * b, [](const model& r, const rounded* in, rounded* out) {
                    r.regressor(in, in + r.dof, in + 2 * r.dof, out);
                }};
    }
    throw std::runtime_error("no function " + name);
}

std::vector<float> read_bits(std::istream& words) {
    std::vector<float> values;
    for (std::string word; words >> word;) {
        values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(word, nullptr, 16))));
    }
    return values;
}

/// Over all calls of one function.
struct agreement {
    int calls = 0;
    double worst = 0.0;     ///< largest difference over its bound
    double greatest = 0.0;  ///< largest bound over the largest result of its call
};

void compare(agreement& sum, const std::vector<float>& found, const numbers& expected) {
    double largest = 0.0, bound = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double difference = std::abs(static_cast<double>(found[i]) - expected[i].value());
        const double smallest_normal = 0x1p-126;  // below, single precision has fewer digits
        const double ratio = difference / (expected[i].error() + smallest_normal);
        sum.worst = std::max(sum.worst, std::isnan(ratio) ? INFINITY : ratio);
        largest = std::max(largest, std::abs(expected[i].value()));
        bound = std::max(bound, expected[i].error());
    }
    sum.greatest = std::max(sum.greatest, bound / largest);
    ++sum.calls;
}

/// A line `call ROBOT LANGUAGE FUNCTION ARGUMENTS... RESULTS...`, the numbers as bits of floats.
void check_call(std::istream& words, std::map<std::string, agreement>& sums) {
    std::string robot, language, name;
    words >> robot >> language >> name;
    const model& m = find_model(robot);
    const function f = find_function(m, name);
    const std::vector<float> values = read_bits(words);
    if (values.size() != f.arguments + f.results) {
        throw std::runtime_error(robot + " " + name + ": " + std::to_string(values.size()) + " numbers");
    }
    numbers in, out(f.results);
    std::transform(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(f.arguments), std::back_inserter(in),
                   rounded::exact);
    f.call(m, in.data(), out.data());
    compare(sums[robot + " " + language + " " + name],
            {values.begin() + static_cast<std::ptrdiff_t>(f.arguments), values.end()}, out);
}

int report(const std::map<std::string, agreement>& sums) {
    constexpr double meaningful = 1e-3;  // a bound of more digits than that would let a wrong term pass
    int status = sums.empty() ? 1 : 0;
    for (const auto& [what, sum] : sums) {
        const bool agrees = sum.worst <= 1.0 && sum.greatest < meaningful;
        std::printf("%-32s %3d calls, differs by at most %.3f of the bound, which is at most %.1e of the result%s\n",
                    what.c_str(), sum.calls, sum.worst, sum.greatest, agrees ? "" : "  FAILED");
        status = agrees ? status : 1;
    }
    return status;
}

}  // namespace

int main() {
    std::map<std::string, agreement> sums;
    bool done = false;
    try {
        for (std::string line; std::getline(std::cin, line);) {
            std::istringstream words(line);
            std::string kind;
            words >> kind;
            if (kind == "call") {
                check_call(words, sums);
            }
            done = done || kind == "done";
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    if (!done) {
        std::fprintf(stderr, "the firmware did not come to its end\n");
        return 1;
    }
    return report(sums);
}
