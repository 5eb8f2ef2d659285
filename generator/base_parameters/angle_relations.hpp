#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// An angle as a sum of integer multiples of free angles and a constant angle.
struct composed_angle {
    std::vector<std::pair<int, int>> terms;                 ///< node whose angle gives the free one, multiple
    std::optional<std::pair<rational, rational>> constant;  ///< its cosine and sine, if it is not zero
};

/// How the angles depend on each other whose cosine or sine a graph takes: with coupled joints one may be the sum of
/// others, q3 = (q3 - q2) + q2. Angles that are linear in the symbols and depend on earlier ones (by ascending node)
/// are composed of these; all others are free. `constants`: values of the symbols of this role, by index.
class angle_relations {
  public:
    angle_relations(const expression_graph& graph, const std::vector<rational>& constants);

    /// By the node of the angle; nothing where the angle is a free one itself.
    const composed_angle* find(int node) const {
        const auto known = composed_.find(node);
        return known == composed_.end() ? nullptr : &known->second;
    }

  private:
    std::map<int, composed_angle> composed_;
};

}  // namespace idim::generator
