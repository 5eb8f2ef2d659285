#include "proposed_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

namespace idim::cli {

namespace {

namespace fs = std::filesystem;

/// Pa, Pb .. of the effect's number: no two proposals at one joint have the same.
std::string coefficient(int number, std::size_t term) {
    return fmt::format("P{}{}", number, static_cast<char>('a' + term));
}

std::string torque_of(const unexplained_structure& structure, int number) {
    std::string torque;
    for (std::size_t k = 0; k < structure.terms.size(); ++k) {
        torque += fmt::format("{}{}*{}", k == 0 ? "" : " + ", coefficient(number, k), structure.terms[k]);
    }
    return torque;
}

std::string file_text(const unexplained_structure& structure, const std::string& joint, int number) {
    std::string linear;
    for (std::size_t k = 0; k < structure.terms.size(); ++k) {
        linear += fmt::format("{}{}: {{unit: {}}}", k == 0 ? "" : ", ", coefficient(number, k), structure.units[k]);
    }
    return fmt::format(
        "effect: proposed_{}\nproposed: true\nper: {}\ntorque: {}\nlinear: {{{}}}\n"
        "about: proposed from the residual of joint {}, which depends on {}; no known effect fits\n",
        number, structure.from ? "pair" : "joint", torque_of(structure, number), linear, joint,
        fmt::join(structure.signals, " and "));
}

}  // namespace

std::vector<proposed_effect> write_proposed_effects(const effect_trace& trace, const traced_robot& traced,
                                                    const std::string& robot_file, const std::string& folder) {
    const fs::path beside = fs::path(robot_file).parent_path();
    std::vector<proposed_effect> written;
    int number = 0;
    for (std::size_t s = 0; s < trace.unexplained.size(); ++s) {
        const unexplained_structure& structure = trace.unexplained[s];
        if (structure.terms.empty()) {
            continue;
        }
        while (fs::exists(beside / fmt::format("proposed_{}.yaml", ++number))) {
        }
        const std::string name = fmt::format("proposed_{}", number);
        const fs::path path = fs::path(folder) / (name + ".yaml");
        write_text(path, file_text(structure, joint_name(traced.robot, structure.joint), number));
        written.push_back({s, {name, {structure.joint}, structure.from}, path.string(), torque_of(structure, number)});
    }
    return written;
}

}  // namespace idim::cli
