#include "description/urdf/urdf_skeleton.hpp"

#include <algorithm>

#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

constexpr int no_joint = -1;

class skeleton_reader {
  public:
    skeleton_reader(const xml_element& root, const std::string& file) : root_(root), file_(file) {
        result_.tree.file = file;
    }

    urdf_skeleton read() {
        check_root();
        list_elements();
        link_up();
        find_root();
        refuse_cycles();
        return std::move(result_);
    }

  private:
    input_location at(const xml_element& element) const { return {file_, element.line, ""}; }

    void check_root() {
        if (root_.name != "robot") {
            throw input_error(at(root_), "expected a URDF, <robot name=\"...\">, got element " + quote(root_.name));
        }
        const std::string* name = root_.attribute("name");
        if (name == nullptr) {
            throw input_error(at(root_), "robot has no name, expected <robot name=\"...\">");
        }
        result_.tree.name = *name;
        for (const xml_element& child : root_.children) {
            if (child.name.starts_with("xacro:")) {
                throw input_error(at(child), "macros are not expanded, expected a URDF written by xacro");
            }
        }
    }

    void list_elements() {
        for (const xml_element& element : root_.children) {
            const bool is_link = element.name == "link";
            if (!is_link && element.name != "joint") {
                continue;
            }
            const std::string* name = element.attribute("name");
            if (name == nullptr || name->empty()) {
                throw input_error(at(element),
                                  element.name + " has no name, expected <" + element.name + " name=\"...\">");
            }
            auto& index = is_link ? result_.link_index : result_.joint_index;
            auto& elements = is_link ? result_.link_elements : result_.joint_elements;
            const auto [first, is_new] = index.emplace(*name, static_cast<int>(elements.size()));
            if (!is_new) {
                throw input_error(at(element),
                                  element.name + " " + quote(*name) + " is already on line " +
                                      std::to_string(elements[static_cast<std::size_t>(first->second)]->line));
            }
            elements.push_back(&element);
            const input_location where = {file_, element.line, element.name + " " + quote(*name)};
            if (is_link) {
                result_.tree.links.push_back({*name, where, std::nullopt});
            } else {
                result_.tree.joints.push_back({});
                result_.tree.joints.back().name = *name;
                result_.tree.joints.back().where = where;
            }
        }
        if (result_.tree.links.empty()) {
            throw input_error(at(root_), "robot has no links, expected <link name=\"...\"/>");
        }
    }

    int link_of(std::size_t joint, const char* end) const {
        const xml_element* element = result_.joint_elements[joint]->child(end);
        const std::string* name = element == nullptr ? nullptr : element->attribute("link");
        if (name == nullptr) {
            throw input_error(result_.tree.joints[joint].where,
                              std::string("has no ") + end + ", expected <" + end + " link=\"...\"/>");
        }
        const auto found = result_.link_index.find(*name);
        if (found == result_.link_index.end()) {
            throw input_error({file_, element->line, result_.tree.joints[joint].where.field},
                              std::string(end) + " link " + quote(*name) + " is not in the file");
        }
        return found->second;
    }

    void link_up() {
        parent_joint_.assign(result_.tree.links.size(), no_joint);
        for (std::size_t j = 0; j < result_.tree.joints.size(); ++j) {
            urdf_joint& joint = result_.tree.joints[j];
            joint.parent = link_of(j, "parent");
            joint.child = link_of(j, "child");
            int& above = parent_joint_[static_cast<std::size_t>(joint.child)];
            if (above != no_joint) {
                const urdf_joint& other = result_.tree.joints[static_cast<std::size_t>(above)];
                throw input_error(joint.where, "link " + quote(link_name(joint.child)) +
                                                   " is already the child of joint " + quote(other.name) + ", line " +
                                                   std::to_string(other.where.line) + ": expected a tree");
            }
            above = static_cast<int>(j);
        }
    }

    const std::string& link_name(int link) const { return result_.tree.links[static_cast<std::size_t>(link)].name; }

    int link_above(int link) const {
        const int joint = parent_joint_[static_cast<std::size_t>(link)];
        return joint == no_joint ? no_joint : result_.tree.joints[static_cast<std::size_t>(joint)].parent;
    }

    void find_root() {
        int found = no_joint;
        for (std::size_t l = 0; l < result_.tree.links.size(); ++l) {
            if (parent_joint_[l] != no_joint) {
                continue;
            }
            if (found != no_joint) {
                throw input_error(result_.tree.links[l].where,
                                  "no joint moves this link nor link " + quote(link_name(found)) + ", line " +
                                      std::to_string(result_.tree.links[static_cast<std::size_t>(found)].where.line) +
                                      ": expected one root");
            }
            found = static_cast<int>(l);
        }
        result_.tree.root = found == no_joint ? 0 : found;
    }

    /// A link from which no way leads to the root hangs on a cycle.
    void refuse_cycles() const {
        std::vector<bool> reaches_root(result_.tree.links.size(), false);
        for (std::size_t l = 0; l < result_.tree.links.size(); ++l) {
            std::vector<int> walk;
            int link = static_cast<int>(l);
            while (link != no_joint && !reaches_root[static_cast<std::size_t>(link)]) {
                if (walk.size() > result_.tree.links.size()) {
                    refuse_cycle(link);
                }
                walk.push_back(link);
                link = link_above(link);
            }
            for (const int passed : walk) {
                reaches_root[static_cast<std::size_t>(passed)] = true;
            }
        }
    }

    /// Named from the link of the cycle that comes first in the file.
    [[noreturn]] void refuse_cycle(int on_cycle) const {
        std::vector<int> cycle = {on_cycle};
        for (int link = link_above(on_cycle); link != on_cycle; link = link_above(link)) {
            cycle.insert(cycle.begin(), link);
        }
        std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
        std::vector<std::string> names;
        for (const int link : cycle) {
            names.push_back(link_name(link));
        }
        throw input_error(result_.tree.links[static_cast<std::size_t>(cycle.front())].where,
                          "links form a cycle: " + cycle_text(names) + ", expected a tree");
    }

    const xml_element& root_;
    const std::string& file_;
    urdf_skeleton result_;
    std::vector<int> parent_joint_;
};

}  // namespace

std::string cycle_text(const std::vector<std::string>& names) {
    constexpr std::size_t most_names = 6;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most_names); ++i) {
        text += quote(names[i]) + " -> ";
    }
    return text + (names.size() > most_names ? "... -> " : "") + quote(names.front());
}

urdf_skeleton read_skeleton(const xml_element& root, const std::string& file) {
    return skeleton_reader(root, file).read();
}

}  // namespace idim::generator
