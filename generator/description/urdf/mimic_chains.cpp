#include "description/urdf/mimic_chains.hpp"

#include <algorithm>

#include "description/decimal.hpp"
#include "description/urdf/urdf_number.hpp"
#include "description/urdf/urdf_skeleton.hpp"
#include "description/yaml_reader.hpp"

namespace idim::generator {

namespace {

class mimic_resolver {
  public:
    explicit mimic_resolver(urdf_tree& tree) : tree_(tree) {}

    void run() {
        std::vector<bool> is_resolved(tree_.joints.size(), false);
        for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
            std::vector<int> chain;
            int joint = static_cast<int>(j);
            while (joint_at(joint).mimic && !is_resolved[static_cast<std::size_t>(joint)]) {
                if (const auto first = std::find(chain.begin(), chain.end(), joint); first != chain.end()) {
                    refuse_mimics({first, chain.end()});
                }
                chain.push_back(joint);
                joint = joint_at(joint).mimic->joint;
            }
            for (; !chain.empty(); chain.pop_back()) {
                resolve_mimic(joint_at(chain.back()));
                is_resolved[static_cast<std::size_t>(chain.back())] = true;
            }
        }
    }

  private:
    urdf_joint& joint_at(int index) { return tree_.joints[static_cast<std::size_t>(index)]; }

    /// The joint that `joint` mimics is driven, or resolved itself.
    void resolve_mimic(urdf_joint& joint) {
        urdf_mimic& own = *joint.mimic;
        const urdf_joint& master = joint_at(own.joint);
        if (!master.has_one_axis()) {
            throw input_error(joint.where, "mimics joint " + quote(master.name) +
                                               ", expected a revolute, continuous or prismatic joint");
        }
        if (master.mimic) {
            const decimal factor = decimal_of(own.multiplier);
            const decimal offset = decimal_of(own.offset) + factor * decimal_of(master.mimic->offset);
            own = {master.mimic->joint, nearest_double(factor * decimal_of(master.mimic->multiplier)),
                   nearest_double(offset)};
        }
        bounded(own.multiplier, joint.where);
        bounded(1.0 / own.multiplier, joint.where);
        bounded(own.offset, joint.where);
    }

    [[noreturn]] void refuse_mimics(const std::vector<int>& cycle) {
        std::vector<std::string> names;
        for (const int joint : cycle) {
            names.push_back(joint_at(joint).name);
        }
        throw input_error(joint_at(cycle.front()).where,
                          "joints mimic each other: " + cycle_text(names) + ", expected one that is driven");
    }

    urdf_tree& tree_;
};

}  // namespace

void resolve_mimics(urdf_tree& tree) {
    mimic_resolver(tree).run();
}

}  // namespace idim::generator
