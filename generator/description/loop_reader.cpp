#include "description/loop_reader.hpp"

#include <algorithm>

namespace idim::generator {

namespace {

constexpr std::size_t most_loops = 50;
constexpr const char* example_of_cut =
    "two points [{link: <joint>, point: [x, y, z]}, {link: <joint>, point: [x, y, z]}]";

int find_link(const yaml_value& written, const std::vector<joint_description>& joints) {
    const std::string name = written.text("the name of a joint, or base");
    const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& j) { return j.name == name; });
    if (found == joints.end() && name != "base") {
        written.reject("the name of a joint of this robot, or base");
    }
    return name == "base" ? -1 : static_cast<int>(found - joints.begin());
}

link_point read_point(const yaml_value& written, const std::vector<joint_description>& joints) {
    const yaml_fields fields(written, {"link", "point"});
    link_point result;
    result.link = find_link(fields.require("link", "the name of a joint, or base"), joints);
    const yaml_value point = fields.require("point", "three entries [m] in the link's frame such as [L, 0, 0]");
    const auto entries = point.items("three entries [m] in the link's frame such as [L, 0, 0]");
    if (entries.size() != result.point.size()) {
        throw input_error(point.where(), "expected three entries [m] in the link's frame such as [L, 0, 0], got " +
                                             std::to_string(entries.size()));
    }
    std::transform(entries.begin(), entries.end(), result.point.begin(), [](const yaml_value& entry) {
        return expression_text{entry.expression(), entry.where()};
    });
    return result;
}

int read_passive(const yaml_value& written, std::vector<joint_description>& joints) {
    const int index = find_link(written, joints);
    if (index < 0) {
        written.reject("the name of a joint of this robot");
    }
    joint_description& joint = joints[static_cast<std::size_t>(index)];
    if (joint.type != joint_type::revolute) {
        throw input_error(written.where(), "joint " + quote(joint.name) + " is not revolute, expected one that is");
    }
    if (joint.passive) {
        throw input_error(written.where(),
                          "joint " + quote(joint.name) + " is passive twice, expected joints that one loop determines");
    }
    if (joint.theta.text != "q") {
        throw input_error(joint.theta.where, "\"" + joint.theta.text + "\" given, expected \"q\" for a joint whose " +
                                                 "angle a loop determines");
    }
    joint.passive = true;
    return index;
}

loop_assembly read_assembly(const yaml_value& written) {
    const char* expected = "1, -1 or parallelogram";
    const std::string text = written.text(expected);
    if (text == "parallelogram") {
        return loop_assembly::parallelogram;
    }
    if (text != "1" && text != "+1" && text != "-1") {
        written.reject(expected);
    }
    return text == "-1" ? loop_assembly::clockwise : loop_assembly::counterclockwise;
}

loop_description read_loop(const yaml_value& written, std::vector<joint_description>& joints) {
    const yaml_fields fields(written, {"cut", "passive", "assembly"});
    loop_description loop;
    loop.where = written.where();
    const yaml_value cut = fields.require("cut", example_of_cut);
    const auto points = cut.items(example_of_cut);
    const yaml_value passive = fields.require("passive", "the two joints that the loop determines");
    const auto names = passive.items("the two joints that the loop determines");
    if (points.size() != loop.cut.size() || names.size() != loop.passive.size()) {
        const bool of_cut = points.size() != loop.cut.size();
        throw input_error((of_cut ? cut : passive).where(),
                          std::string("expected ") + (of_cut ? example_of_cut : "two joints that the loop determines") +
                              ", got " + std::to_string((of_cut ? points : names).size()) + " entries");
    }
    for (std::size_t i = 0; i < 2; ++i) {
        loop.cut[i] = read_point(points[i], joints);
        loop.passive[i] = read_passive(names[i], joints);
    }
    if (loop.cut[0].link == loop.cut[1].link) {
        throw input_error(cut.where(), "both points lie on one link, expected those of two links");
    }
    const yaml_value assembly = fields.require("assembly", "1, -1 or parallelogram");
    loop.assembly = read_assembly(assembly);
    loop.cut_where = cut.where();
    loop.passive_where = passive.where();
    loop.assembly_where = assembly.where();
    return loop;
}

}  // namespace

std::vector<loop_description> read_loops(const yaml_value& written, std::vector<joint_description>& joints) {
    std::vector<loop_description> loops;
    const auto items = written.items("a list of loops {cut, passive, assembly}");
    if (items.size() > most_loops) {
        throw input_error(written.where(), "expected at most " + std::to_string(most_loops) + " loops, got " +
                                               std::to_string(items.size()));
    }
    for (const yaml_value& item : items) {
        loops.push_back(read_loop(item, joints));
    }
    return loops;
}

std::string to_string(loop_assembly assembly) {
    return assembly == loop_assembly::parallelogram ? "parallelogram"
           : assembly == loop_assembly::clockwise   ? "-1"
                                                    : "1";
}

std::string to_string(const loop_description& loop, const std::vector<joint_description>& joints) {
    std::string text = "{cut: [";
    for (const link_point& at : loop.cut) {
        text += (&at == loop.cut.data() ? "{link: " : ", {link: ") + link_name(joints, at.link) + ", point: [" +
                at.point[0].text + ", " + at.point[1].text + ", " + at.point[2].text + "]}";
    }
    return text + "], passive: [" + link_name(joints, loop.passive[0]) + ", " + link_name(joints, loop.passive[1]) +
           "], assembly: " + to_string(loop.assembly) + "}";
}

}  // namespace idim::generator
