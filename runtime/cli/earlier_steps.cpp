#include "earlier_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "idim/input_error.hpp"

namespace idim::cli {

namespace {

class step_reader {
  public:
    step_reader(const std::string& file, const traced_robot& traced) : file_(file), traced_(traced) {}

    std::vector<trace_step> read(const json& content) const {
        require(content.at("robot") == traced_.robot.generated.robot, "robot",
                "made for the robot " + content.at("robot").dump());
        const double band = traced_.filter.band(traced_.fitted.front().rate);
        require(std::abs(content.at("band").get<double>() - band) < 1e-9 * band, "band",
                fmt::format("made from rows of another band, expected {} Hz: other logs, or another filter", band));
        std::vector<trace_step> steps;
        for (const json& entry : content.at("steps")) {
            steps.push_back(step(entry));
        }
        return steps;
    }

  private:
    void require(bool holds, const char* field, const std::string& what) const {
        if (!holds) {
            throw input_error({file_, 0, field}, what);
        }
    }

    std::vector<int> joints(const json& names) const {
        std::vector<int> places;
        for (const json& name : names) {
            int joint = 0;
            while (joint < traced_.robot.model().dof && joint_name(traced_.robot, joint) != name) {
                ++joint;
            }
            require(joint < traced_.robot.model().dof, "steps", "the robot has no joint " + name.dump());
            places.push_back(joint);
        }
        return places;
    }

    effect_place place(const json& entry) const {
        effect_place found{entry.at("effect"), joints(entry.at("joints")), std::nullopt};
        if (entry.contains("from")) {
            found.from = joints(entry["from"]).at(0);
        }
        return found;
    }

    static error_summary errors(const json& entry) {
        error_summary summary;
        summary.relative_error = number(entry.at("relative_error"));
        for (const json& joint : entry.at("joints")) {
            summary.joints.push_back({number(joint.at("rms")), number(joint.at("relative_error"))});
        }
        return summary;
    }

    static double number(const json& value) { return value.is_null() ? NAN : value.get<double>(); }

    trace_step step(const json& entry) const {
        trace_step found;
        found.place = place(entry);
        for (const auto& [name, parameter] : entry.at("parameters").items()) {
            found.parameters.push_back(
                {name, parameter.at("unit"), number(parameter.at("value")), number(parameter.at("std"))});
        }
        found.p_value = entry.at("p_value");
        found.explained_fraction = entry.at("explained_fraction");
        for (const json& other : entry.at("confusable_with")) {
            found.confusable_with.push_back(place(other));
        }
        found.before = errors(entry.at("before"));
        found.after = errors(entry.at("after"));
        return found;
    }

    const std::string& file_;
    const traced_robot& traced_;
};

}  // namespace

std::vector<trace_step> read_steps(const std::string& file, const traced_robot& traced) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw input_error({file, 0, ""}, "cannot be read, expected what refine wrote before");
    }
    try {
        return step_reader(file, traced).read(json::parse(stream));
    } catch (const json::exception& error) {
        throw input_error({file, 0, ""}, fmt::format("expected what refine wrote before: {}", error.what()));
    }
}

}  // namespace idim::cli
