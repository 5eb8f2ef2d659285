// Calls the generated functions of a few robots in single precision. Prints each call with its arguments and results,
// for the host to compare with double precision, and what each function takes: instructions and stack.
#include "board/board.h"
#include "console_line.hpp"
#include "models/robot_model.hpp"

extern const robot_model<float> scara_cpp, scara_c, rx90_cpp, rx90_c, kuka_lwr_cpp, kuka_lwr_c;

namespace {

constexpr int most_joints = 7, most_base = 80, most_standard = 100;
constexpr int states = 20;

struct joint_state {
    float q[most_joints], qd[most_joints], qdd[most_joints], tau[most_joints];
};

/// What the functions read and write, outside the stack that is measured.
struct working_memory {
    float standard[most_standard], chi[most_base];
    joint_state state;
    float tau[most_joints], qdd[most_joints], D[most_joints], M[most_joints * most_joints], W[most_joints * most_base];
};

working_memory memory;

const robot_model<float>* const robots[] = {&scara_cpp, &scara_c, &rx90_cpp, &rx90_c, &kuka_lwr_cpp, &kuka_lwr_c};

/// Numbers between -1 and 1, the same on every run (Numerical Recipes 3rd ed., section 7.1: multiplier and increment).
class uniform_numbers {
  public:
    float next() {
        state_ = state_ * 1664525U + 1013904223U;
        return static_cast<float>(static_cast<std::int32_t>(state_ >> 8U) - (1 << 23)) / static_cast<float>(1 << 23);
    }

  private:
    std::uint32_t state_ = 1;
};

/// A body that is possible: moments of inertia well above what its mass and centre of mass ask for.
float plausible(const char* parameter) {
    const char first = parameter[0], second = parameter[1];
    if (first == 'F') {
        return second == 'v' ? 0.7F : 1.3F;  // viscous, dry friction
    }
    if (first == 'I') {
        return 0.4F;  // rotor
    }
    if (first == 'M') {
        return second == 'X' || second == 'Y' || second == 'Z' ? 0.3F : 2.5F;  // first moment, mass
    }
    return first == second ? 0.6F : 0.02F;  // moment, product of inertia
}

void choose_parameters(const robot_model<float>& robot) {
    for (int i = 0; i < robot.standard_parameters; ++i) {
        memory.standard[i] = plausible(robot.standard_parameter_names[i]);
    }
    robot.regroup(memory.standard, memory.chi);
}

void choose_state(const robot_model<float>& robot, uniform_numbers& numbers) {
    for (int j = 0; j < robot.dof; ++j) {
        memory.state.q[j] = 3.1F * numbers.next();
        memory.state.qd[j] = 2.0F * numbers.next();
        memory.state.qdd[j] = 6.0F * numbers.next();
        memory.state.tau[j] = 40.0F * numbers.next();
    }
}

/// Functions as calls on the working memory: each has a name, the call itself, and prints what went in and came out.
struct regroup_call {
    static constexpr const char* name = "regroup";
    const robot_model<float>& robot;
    void operator()() const { robot.regroup(memory.standard, memory.chi); }
    void print(console_line& line) const {
        line.bits(memory.standard, robot.standard_parameters).bits(memory.chi, robot.base_parameters);
    }
};

struct inverse_dynamics_call {
    static constexpr const char* name = "inverse_dynamics";
    const robot_model<float>& robot;
    void operator()() const {
        robot.inverse_dynamics(memory.state.q, memory.state.qd, memory.state.qdd, memory.chi, memory.tau);
    }
    void print(console_line& line) const {
        line.bits(memory.state.q, robot.dof).bits(memory.state.qd, robot.dof).bits(memory.state.qdd, robot.dof);
        line.bits(memory.chi, robot.base_parameters).bits(memory.tau, robot.dof);
    }
};

struct mass_matrix_call {
    static constexpr const char* name = "mass_matrix";
    const robot_model<float>& robot;
    void operator()() const { robot.mass_matrix(memory.state.q, memory.chi, memory.M); }
    void print(console_line& line) const {
        line.bits(memory.state.q, robot.dof).bits(memory.chi, robot.base_parameters);
        line.bits(memory.M, robot.dof * robot.dof);
    }
};

struct forward_dynamics_call {
    static constexpr const char* name = "forward_dynamics";
    const robot_model<float>& robot;
    void operator()() const {
        robot.forward_dynamics(memory.state.q, memory.state.qd, memory.state.tau, memory.chi, memory.qdd, memory.D);
    }
    void print(console_line& line) const {
        line.bits(memory.state.q, robot.dof).bits(memory.state.qd, robot.dof).bits(memory.state.tau, robot.dof);
        line.bits(memory.chi, robot.base_parameters).bits(memory.qdd, robot.dof).bits(memory.D, robot.dof);
    }
};

struct regressor_call {
    static constexpr const char* name = "regressor";
    const robot_model<float>& robot;
    void operator()() const { robot.regressor(memory.state.q, memory.state.qd, memory.state.qdd, memory.W); }
    void print(console_line& line) const {
        line.bits(memory.state.q, robot.dof).bits(memory.state.qd, robot.dof).bits(memory.state.qdd, robot.dof);
        line.bits(memory.W, robot.dof * robot.base_parameters);
    }
};

/// Of a number of instructions that is known, to see what the counter counts.
struct two_hundred_nops {
    void operator()() const { __asm__ volatile(".rept 200\n nop\n .endr"); }
};

struct no_call {
    void operator()() const { __asm__ volatile("" ::: "memory"); }
};

/// Instructions of a hundred calls in a loop, in counts of the board's counter.
template <class Call>
[[gnu::noinline]] std::uint32_t count_hundred(const Call& call) {
    const std::uint32_t before = read_counter();
    for (int i = 0; i < 100; ++i) {
        call();
    }
    return (before - read_counter()) & 0xFFFFFFU;  // it counts down, 24 bits wide
}

/// Instructions of one call and of passing its arguments.
template <class Call>
std::uint32_t instructions(const Call& call) {
    constexpr std::uint32_t instructions_per_count = 40;
    return (count_hundred(call) - count_hundred(no_call())) * instructions_per_count / 100U;
}

/// Bytes of stack that one call writes to, below the arguments that are handed over.
template <class Call>
[[gnu::noinline]] std::uint32_t stack_bytes(const Call& call) {
    paint_stack();
    std::uintptr_t here = 0;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    call();
    const std::uintptr_t deepest = deepest_stack();
    return deepest < here ? here - deepest : 0;
}

template <class Call>
void print_calls(const robot_model<float>& robot, const Call& call, int count) {
    uniform_numbers numbers;
    std::uint32_t most_instructions = 0, most_stack = 0;
    for (int k = 0; k < count; ++k) {
        choose_state(robot, numbers);
        const std::uint32_t stack = stack_bytes(call), taken = instructions(call);
        most_stack = stack > most_stack ? stack : most_stack;
        most_instructions = taken > most_instructions ? taken : most_instructions;
        console_line line;
        line.word("call").word(robot.name).word(robot.language).word(Call::name);
        call.print(line);
    }
    console_line line;
    line.word("took").word(robot.name).word(robot.language).word(Call::name);
    line.word("instructions").number(most_instructions).word("stack").number(most_stack);
}

void exercise(const robot_model<float>& robot) {
    choose_parameters(robot);
    print_calls(robot, regroup_call{robot}, 1);
    print_calls(robot, inverse_dynamics_call{robot}, states);
    print_calls(robot, mass_matrix_call{robot}, states);
    print_calls(robot, forward_dynamics_call{robot}, states);
    print_calls(robot, regressor_call{robot}, states);
}

}  // namespace

int main() {
    start_counter();
    console_line().word("counted").number(instructions(two_hundred_nops())).word("for 200 nops");
    for (const robot_model<float>* robot : robots) {
        exercise(*robot);
    }
    console_line().word("done");
    return 0;
}
