#include "turned_robot.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "description/robot_description.hpp"
#include "measured_motion.hpp"
#include "refined_description.hpp"

namespace idim::cli {

namespace {

/// Gravity changes in proportion to so small an angle, and by far more than rounding.
constexpr double angle = 1e-3;

/// A new folder, removed with all it holds at the end of the scope.
class scratch_folder {
  public:
    scratch_folder() : path_((std::filesystem::temp_directory_path() / "idim-turned-XXXXXX").string()) {
        if (mkdtemp(path_.data()) == nullptr) {
            throw std::system_error(errno, std::generic_category(), path_);
        }
    }
    ~scratch_folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    scratch_folder(const scratch_folder&) = delete;
    scratch_folder& operator=(const scratch_folder&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

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
            const scratch_folder folder;
            const std::string file =
                write_with_effects(robot_file, {{"base_tilt", {}, {}, {{shapes[axis], angle}}}}, folder.path());
            turned.push_back({shapes[axis], angle, load_variant(file)});
        }
    }
    return turned;
}

}  // namespace idim::cli
