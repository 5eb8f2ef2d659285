#include "turned_robot.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>

#include "description/robot_description.hpp"
#include "idim/private_folder.hpp"
#include "measured_motion.hpp"
#include "refined_description.hpp"

namespace idim::cli {

namespace {

/// Gravity changes in proportion to so small an angle, and by far more than rounding.
constexpr double tilt = 1e-3;

bool is_written_as_zero(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == '\0' && value == 0.0;
}

}  // namespace

std::vector<turned_robot> load_turned(const std::string& robot_file) {
    constexpr std::array<const char*, 3> shapes = {"tilt_x", "tilt_y", "tilt_z"};
    const generator::robot_description robot = generator::read_robot(robot_file);
    std::vector<turned_robot> turned;
    for (std::size_t axis = 0; axis < shapes.size(); ++axis) {
        const bool across = !is_written_as_zero(robot.gravity[(axis + 1) % 3].text) ||
                            !is_written_as_zero(robot.gravity[(axis + 2) % 3].text);
        if (across) {
            const private_folder folder(std::filesystem::temp_directory_path() / "idim-turned-");
            const std::string file =
                write_with_effects(robot_file, {{"base_tilt", {}, {}, {{shapes[axis], tilt}}}}, folder.path().string());
            turned.push_back({shapes[axis], tilt, load_variant(file)});
        }
    }
    return turned;
}

}  // namespace idim::cli
