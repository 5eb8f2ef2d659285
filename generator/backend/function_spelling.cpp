#include "backend/function_spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "backend/body_printer.hpp"
#include "graph/shared_sines.hpp"

namespace idim::generator {

namespace {

using argument_list = std::vector<function_argument>;

std::vector<std::string> meanings_of(const argument_list& list) {
    std::vector<std::string> meanings;
    for (const function_argument& argument : list) {
        meanings.push_back(argument.meaning);
    }
    return meanings;
}

std::set<function_kind> functions_called(const expression_graph& graph) {
    std::set<function_kind> called;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        if (live[id] && graph.nodes()[id].kind == operation::function) {
            called.insert(graph.nodes()[id].function);
        }
    }
    return called;
}

/// Names of the arguments that the live part of a graph reads.
std::set<std::string> arrays_read(const expression_graph& graph) {
    std::set<std::string> names;
    const std::vector<bool> live = graph.live();
    for (std::size_t id = 0; id < live.size(); ++id) {
        if (live[id] && graph.nodes()[id].kind == operation::symbol) {
            names.insert(argument_name(graph.nodes()[id].role));
        }
    }
    return names;
}

argument_list marked_unused(argument_list list, const expression_graph& graph) {
    const std::set<std::string> read = arrays_read(graph);
    for (function_argument& argument : list) {
        argument.used = argument.is_output || read.count(argument.name) != 0;
    }
    return list;
}

/// Names of all arguments of all models, so that a variable has the same name in each of them.
std::set<std::string> reserved_names(const std::vector<model_function>& models) {
    std::set<std::string> names = {"sc"};
    for (const model_function& model : models) {
        for (const function_argument& argument : model.arguments) {
            names.insert(argument.name);
        }
    }
    for (int kind = static_cast<int>(function_kind::sin); kind <= static_cast<int>(function_kind::pow); ++kind) {
        names.insert(to_string(static_cast<function_kind>(kind)));
    }
    return names;
}

class speller {
  public:
    speller(const std::vector<model_function>& models, element_names names)
        : names_(std::move(names)), reserved_(reserved_names(models)) {
        for (const model_function& model : models) {
            given_.push_back(sines_.taken_from(model.graph));
        }
    }

    function_context model(const model_function& plain, std::size_t number, const languages& spellings) {
        const std::set<int> places = sines_read(given_[number]);
        if (places.empty()) {
            return described(plain, plain.arguments, spellings,
                             [&](const language& spelling) { return std::vector{routine(plain, spelling)}; });
        }
        const model_function given{plain.name + "_sc", plain.summary + " Cosines and sines are given.",
                                   with_sines(plain.arguments), std::move(given_[number])};
        return described(plain, given.arguments, spellings, [&](const language& spelling) {
            return std::vector{routine(given, spelling), wrapper(plain, given, places, spelling)};
        });
    }

    function_context sines(const function_argument& q, const languages& spellings) const {
        std::set<int> all;
        for (int place = 0; place < sines_.size(); ++place) {
            all.insert(all.end(), place);
        }
        function_argument sc = sines_argument();
        sc.is_output = true;
        const model_function model{"sines",
                                   "Cosines and sines of joint positions, for the functions whose names end in _sc.",
                                   {q, sc},
                                   sines_.graph(all)};
        function_context result = described(model, model.arguments, spellings, [&](const language& spelling) {
            return all.empty() ? std::vector<routine_context>{} : std::vector{routine(model, spelling)};
        });
        for (const std::string& statement : print_body(model.graph, *spellings.front(), reserved_)) {
            result.meanings.push_back("  " + statement);
        }
        return result;
    }

    int count() const { return sines_.size(); }

  private:
    template <class Routines>
    static function_context described(const model_function& model, const argument_list& list,
                                      const languages& spellings, const Routines& routines) {
        function_context result{model.name, model.summary, meanings_of(list), count_operations(model.graph), {}};
        const bool calls_sign = functions_called(model.graph).count(function_kind::sign) != 0;
        for (const auto& spelling : spellings) {
            result.variants.push_back({spelling->scalar(), spelling->suffix(), calls_sign, routines(*spelling)});
        }
        return result;
    }

    function_argument sines_argument() const {
        return {"sc", sines_.size(), fmt::format("sc [{}] cosines and sines, as sines gives them", sines_.size())};
    }

    argument_list with_sines(argument_list list) const {
        const auto q = std::find_if(list.begin(), list.end(), [](const auto& a) { return a.name == "q"; });
        list.insert(std::next(q), sines_argument());
        return list;
    }

    routine_context routine(const model_function& model, const language& spelling) const {
        const argument_list marked = marked_unused(model.arguments, model.graph);
        return {model.summary, meanings_of(marked), spelling.signature(names_.robot, model.name, marked),
                spelling.prologue(functions_called(model.graph), marked),
                print_body(model.graph, spelling, reserved_, names_)};
    }

    routine_context wrapper(const model_function& plain, const model_function& given, const std::set<int>& places,
                            const language& spelling) const {
        const expression_graph needed = sines_.graph(places);
        routine_context result{plain.summary,
                               meanings_of(plain.arguments),
                               spelling.signature(names_.robot, plain.name, plain.arguments),
                               spelling.prologue(functions_called(needed), plain.arguments),
                               {spelling.local_array("sc", sines_.size())}};
        const std::vector<std::string> evaluated = print_body(needed, spelling, reserved_, names_);
        result.statements.insert(result.statements.end(), evaluated.begin(), evaluated.end());
        result.statements.push_back(spelling.invocation(names_.robot, given.name, given.arguments));
        return result;
    }

    element_names names_;
    std::set<std::string> reserved_;
    shared_sines sines_;
    std::vector<expression_graph> given_;  ///< per model that is not spelled yet, with sines as leaves
};

}  // namespace

spelled_models spell(const std::vector<model_function>& models, const element_names& names,
                     const languages& spellings) {
    speller all(models, names);
    spelled_models result;
    for (std::size_t i = 0; i < models.size(); ++i) {
        result.functions.push_back(all.model(models[i], i, spellings));
    }
    result.functions.push_back(all.sines(models.front().arguments.front(), spellings));
    result.sines = all.count();
    return result;
}

}  // namespace idim::generator
