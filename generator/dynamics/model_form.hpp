#pragma once

namespace idim::generator {

/// The ways in which the equations of one model may be written: all give the same values, at different cost.
struct model_form {
    /// Which links have their mass counted with that of their antecedent, so that only what their own joint adds to the
    /// antecedent's motion is left to be computed for them: none, those that nothing follows, or all. Of the tips, one
    /// that turns about a parallel to its antecedent's axis only keeps the antecedent's axes: its wrench is as simple.
    enum class merging { none, tips, all } merged = merging::none;
    /// Inertias as second moments of mass, and what lies on a joint's axis moved to the antecedent: fewer terms to a
    /// link, and sums of parameters in front of it.
    bool second_moments = false;
    /// A link whose joint is followed by a parallel one keeps the axes of its antecedent; the next turns by the sum.
    bool parallel_axes = false;
    /// Wrenches outward of the last point where axes begin to intersect are met there by the axes of the joints before.
    bool meeting = false;
};

/// The same with the links merged, as the composite bodies of M have them.
inline model_form merging_all(model_form form) {
    form.merged = model_form::merging::all;
    return form;
}

}  // namespace idim::generator
