#include "dynamics/symbolic_model.hpp"

#include <cln/real.h>

#include <sstream>

namespace idim::generator {

namespace {

bool is_trivial(const GiNaC::ex& body) {
    if (GiNaC::is_a<GiNaC::numeric>(body) || GiNaC::is_a<GiNaC::symbol>(body)) {
        return true;
    }
    return GiNaC::is_a<GiNaC::mul>(body) && body.nops() == 2 && GiNaC::is_a<GiNaC::symbol>(body.op(0)) &&
           body.op(1).is_equal(-1);
}

}  // namespace

symbolic_model::symbolic_model(const kinematic_tree& tree) {
    for (std::size_t i = 0; i < tree.constants.size(); ++i) {
        const kinematic_constant& constant = tree.constants[i];
        declare(constant.symbol, {constant.symbol.get_name(), symbol_role::constant, static_cast<int>(i)});
        leaves_.back().value = cln::the<cln::cl_RA>(constant.value.to_cl_N());
    }
}

void symbolic_model::declare(const GiNaC::symbol& symbol, const graph_symbol& declared) {
    symbolic_leaf& leaf = leaves_.emplace_back();
    leaf.symbol = symbol;
    leaf.declared = declared;
}

GiNaC::symbol symbolic_model::declare(const graph_symbol& declared) {
    const GiNaC::symbol symbol(declared.name);
    declare(symbol, declared);
    return symbol;
}

GiNaC::ex symbolic_model::assign(const std::string& name, const GiNaC::ex& body) {
    const GiNaC::ex expanded = body.expand();
    if (is_trivial(expanded)) {
        return expanded;
    }
    const GiNaC::symbol symbol(name);
    assignments_.push_back({symbol, expanded});
    return symbol;
}

std::array<GiNaC::ex, 3> symbolic_model::assign(const std::string& name, const std::array<GiNaC::ex, 3>& body) {
    std::array<GiNaC::ex, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = assign(name + "_" + std::to_string(i + 1), body[i]);
    }
    return result;
}

std::string to_string(const symbolic_model& model) {
    std::ostringstream text;
    for (const assignment& step : model.assignments()) {
        text << step.symbol << " = " << step.body << "\n";
    }
    for (const symbolic_output& out : model.outputs()) {
        text << out.array << "[" << out.index << "] = " << out.value << "\n";
    }
    return text.str();
}

}  // namespace idim::generator
