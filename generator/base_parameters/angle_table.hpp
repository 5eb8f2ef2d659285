#pragma once

#include <map>
#include <vector>

#include "graph/expression_graph.hpp"

namespace idim::generator {

/// An angle as a sum: turned by `constant`, and `power` times by each base angle.
struct angle_form {
    struct term {
        int base = 0;
        int power = 1;
    };
    std::vector<term> terms;
    rational cos = 1, sin = 0;  ///< of the constant part, exactly on the unit circle
};

/// How the angles under the sines and cosines of a graph hang together. Angles that share a coordinate, such as q2, q3
/// and q3 - q2 + 0.2 of a parallelogram, are written in common base angles, q2 and q3, so that a random state in exact
/// numbers obeys the addition theorems. All other angles are base angles themselves; so are those with a factor that is
/// no fraction of at most 16 turns, since the regressor, a polynomial of small degree in each sine and cosine, cannot
/// tell.
class angle_table {
  public:
    explicit angle_table(const expression_graph& graph);

    /// Form of the angle that an argument node of sin or cos holds.
    const angle_form& operator[](int argument) const { return forms_.at(argument); }

  private:
    std::map<int, angle_form> forms_;
};

}  // namespace idim::generator
