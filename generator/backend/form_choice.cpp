#include "backend/form_choice.hpp"

#include <utility>

#include "dynamics/link_axes.hpp"

namespace idim::generator {

namespace {

/// Keeps the cheapest graph it has seen.
class cheapest_graph {
  public:
    cheapest_graph(const model_form& start, cost_target target, const form_builder& build)
        : target_(target), build_(build), form_(start), graph_(build(start)), cost_(cost(graph_, target)) {}

    template <class Change>
    void try_change(const Change& change) {
        model_form changed = form_;
        change(changed);
        expression_graph graph = build_(changed);
        const int found = cost(graph, target_);
        if (found < cost_) {
            form_ = changed;
            graph_ = std::move(graph);
            cost_ = found;
        }
    }

    expression_graph take() { return std::move(graph_); }

  private:
    cost_target target_;
    const form_builder& build_;
    model_form form_;
    expression_graph graph_;
    int cost_;
};

}  // namespace

expression_graph in_cheapest_form(const kinematic_tree& tree, const form_space& space, cost_target target,
                                  const form_builder& build) {
    model_form start = space.start;
    const bool has_parallel = has_parallel_axes(tree);
    const bool has_wrist = last_before_wrist(tree) >= 0;
    start.parallel_axes = start.parallel_axes && has_parallel;
    start.meeting = start.meeting && has_wrist;
    cheapest_graph best(start, target, build);
    if (space.meeting && has_wrist) {
        best.try_change([](model_form& form) { form.meeting = !form.meeting; });
    }
    if (target == cost_target::operations) {
        return best.take();  // in which sums of parameters are free, and the rest of `start` is cheapest
    }
    if (space.parallel_axes && has_parallel) {
        best.try_change([](model_form& form) { form.parallel_axes = !form.parallel_axes; });
    }
    if (space.second_moments) {
        best.try_change([](model_form& form) { form.second_moments = !form.second_moments; });
    }
    if (space.merged) {
        best.try_change([](model_form& form) { form.merged = model_form::merging::none; });
    }
    return best.take();
}

}  // namespace idim::generator
