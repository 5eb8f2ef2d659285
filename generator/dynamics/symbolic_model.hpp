#pragma once

#include <ginac/ginac.h>

#include <optional>
#include <string>
#include <vector>

#include "graph/expression_graph.hpp"
#include "kinematics/kinematic_tree.hpp"

namespace idim::generator {

/// A symbol the model takes as given; constants know their value.
struct symbolic_leaf {
    GiNaC::symbol symbol;
    graph_symbol declared;
    std::optional<rational> value;
};

/// symbol := body, the body a short expression of leaves and of symbols assigned before.
struct assignment {
    GiNaC::symbol symbol;
    GiNaC::ex body;
};

struct symbolic_output {
    std::string array;
    int index = 0;
    GiNaC::ex value;
};

/// Equations as a list of named assignments: nothing is ever unfolded, so that size grows with the number of joints and
/// not with the number of terms of the expanded torque.
class symbolic_model {
  public:
    /// Declares the constants of the robot; other leaves are declared as they are needed.
    explicit symbolic_model(const kinematic_tree& tree);

    void declare(const GiNaC::symbol& symbol, const graph_symbol& declared);
    GiNaC::symbol declare(const graph_symbol& declared);

    /// Gives `body` a name. Returns the symbol that stands for it, or the body itself where it is zero, a number, or
    /// plus or minus one symbol, so that zeros and copies vanish on the way.
    GiNaC::ex assign(const std::string& name, const GiNaC::ex& body);
    std::array<GiNaC::ex, 3> assign(const std::string& name, const std::array<GiNaC::ex, 3>& body);

    /// `symbol`, of someone else, stands for `body` from here on.
    void define(const GiNaC::symbol& symbol, const GiNaC::ex& body) { assignments_.push_back({symbol, body.expand()}); }

    void output(const std::string& array, int index, const GiNaC::ex& value) {
        outputs_.push_back({array, index, value});
    }

    const std::vector<symbolic_leaf>& leaves() const { return leaves_; }
    const std::vector<assignment>& assignments() const { return assignments_; }
    const std::vector<symbolic_output>& outputs() const { return outputs_; }

  private:
    std::vector<symbolic_leaf> leaves_;
    std::vector<assignment> assignments_;
    std::vector<symbolic_output> outputs_;
};

/// One line per assignment and output; terms in GiNaC's order, which changes from run to run: for reading only.
std::string to_string(const symbolic_model& model);

enum class constants_as { values, symbols };

/// Builds the ordered expression graph of a model. Bodies are expanded and their terms sorted by the order in which
/// their symbols were declared, so that the result does not depend on GiNaC's own order of terms.
expression_graph build_graph(const symbolic_model& model, constants_as constants);

}  // namespace idim::generator
