#pragma once

#include <cstdint>
#include <functional>

#include "idim/excitation_plan.hpp"
#include "idim/fourier_series.hpp"
#include "idim/motion_limits.hpp"

namespace idim {

/// What is minimised.
enum class excitation_criterion {
    condition,           ///< condition number of W with columns of norm one
    unscaled_condition,  ///< condition number of W in the units of the parameters
    information          ///< -log det of W'W
};

/// How far a search is.
struct search_progress {
    int start = 0;  ///< from 1
    int starts = 0;
    int evaluations = 0;  ///< in this start
    double seconds = 0.0;
    double best = 0.0;  ///< smallest condition number so far, or largest log det; NaN before the first motion in limits
};

struct search_options {
    int harmonics = 16;  ///< of the Fourier series of each joint
    excitation_criterion criterion = excitation_criterion::condition;
    std::uint64_t seed = 1;
    int starts = 6;
    int evaluations = 300;   ///< of each start
    double seconds = 120.0;  ///< at most; the result is the same on every machine if this is not reached
    std::function<bool(const search_progress&)> proceed;  ///< called at every evaluation; false stops the search
};

struct search_result {
    bool found = false;    ///< a motion within the limits
    excitation_plan plan;  ///< the best one, if found
    limit_breach breach;   ///< what the least bad motion breaks, if not found
    int starts = 0;        ///< begun
    bool stopped = false;  ///< by the caller
    bool out_of_time = false;
};

/// Looks for the periodic motion that shows the base parameters best, a Fourier series of `harmonics` terms per joint
/// with its mean, under all limits and with both connections.
///
/// From random motions within the limits, sequential quadratic programming (Kraft 1994, SLSQP of NLopt) with exact
/// gradients in the series: dF/dW follows in closed form, and W is differentiated by the state of each sample alone, so
/// that the effort does not depend on the number of coefficients. The condition number is smoothed, first more then
/// less, as a mean of powers of the eigenvalues of the scaled Gram matrix; largest values over a period as a mean of
/// exponentials, which is never below them (Kreisselmeier and Steinhauser 1979). `form` gives period, rate, rest and
/// connections.
search_result search_excitation(const limited_robot& robot, const excitation_plan& form, const search_options& options);

}  // namespace idim
