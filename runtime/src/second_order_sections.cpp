#include "idim/second_order_sections.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>

namespace idim {
namespace {

using complex = std::complex<double>;

void check(int order, double cutoff) {
    if (order < 1 || order > 12) {
        throw std::invalid_argument("filter order " + std::to_string(order) + " is not in 1..12");
    }
    if (!(cutoff > 0.0 && cutoff < 1.0)) {
        throw std::invalid_argument("filter cut-off " + std::to_string(cutoff) +
                                    " of the Nyquist frequency is not in (0, 1)");
    }
}

/// Bilinear transform z = (1 + s) / (1 - s) of an analogue pole of the filter with cut-off 1, scaled to tan(pi cutoff /
/// 2).
complex digital_pole(complex analogue, double cutoff) {
    const complex s = analogue * std::tan(0.5 * std::numbers::pi * cutoff);
    return (1.0 + s) / (1.0 - s);
}

/// All zeros of a low-pass lie at z = -1. The gain comes from the rounded denominator, so that H(1) = 1 to the last
/// digit however narrow the band.
second_order_section section_of_pair(complex pole) {
    second_order_section section;
    section.a1 = -2.0 * pole.real();
    section.a2 = std::norm(pole);
    section.b0 = section.b2 = 0.25 * (1.0 + section.a1 + section.a2);
    section.b1 = 2.0 * section.b0;
    return section;
}

second_order_section section_of_real(double pole) {
    second_order_section section;
    section.a1 = -pole;
    section.b0 = section.b1 = 0.5 * (1.0 - pole);
    return section;
}

/// Poles of the analogue prototype at angles theta_k on the ellipse with half axes `real_axis` and `imaginary_axis`; a
/// circle for Butterworth.
second_order_sections lowpass(int order, double cutoff, double real_axis, double imaginary_axis) {
    second_order_sections filter;
    filter.order = order;
    if (order % 2 == 1) {
        filter.sections.push_back(section_of_real(digital_pole(-real_axis, cutoff).real()));
    }
    for (int k = order / 2 - 1; k >= 0; --k) {
        const double theta = std::numbers::pi * (2 * k + 1) / (2.0 * order);
        const complex analogue(-real_axis * std::sin(theta), imaginary_axis * std::cos(theta));
        filter.sections.push_back(section_of_pair(digital_pole(analogue, cutoff)));
    }
    return filter;
}

}  // namespace

double second_order_sections::gain(double frequency) const {
    const complex inverse_z = std::polar(1.0, -std::numbers::pi * frequency);
    double product = 1.0;
    for (const second_order_section& s : sections) {
        product *=
            std::abs((s.b0 + inverse_z * (s.b1 + inverse_z * s.b2)) / (1.0 + inverse_z * (s.a1 + inverse_z * s.a2)));
    }
    return product;
}

second_order_sections butterworth_lowpass(int order, double cutoff) {
    check(order, cutoff);
    return lowpass(order, cutoff, 1.0, 1.0);
}

second_order_sections chebyshev_lowpass(int order, double ripple_db, double cutoff) {
    check(order, cutoff);
    if (!(ripple_db > 0.0)) {
        throw std::invalid_argument("filter ripple must be positive");
    }
    const double epsilon = std::sqrt(std::pow(10.0, 0.1 * ripple_db) - 1.0);
    const double mu = std::asinh(1.0 / epsilon) / order;
    second_order_sections filter = lowpass(order, cutoff, std::sinh(mu), std::cosh(mu));
    if (order % 2 == 0) {
        // An even order starts at the bottom of its ripple: |H(1)| = 1 / sqrt(1 + epsilon^2).
        second_order_section& first = filter.sections.front();
        const double start = 1.0 / std::sqrt(1.0 + epsilon * epsilon);
        first.b0 *= start;
        first.b1 *= start;
        first.b2 *= start;
    }
    return filter;
}

}  // namespace idim
