#pragma once

#include <vector>

namespace idim {

/// H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2).
struct second_order_section {
    double b0 = 1.0;
    double b1 = 0.0;
    double b2 = 0.0;
    double a1 = 0.0;
    double a2 = 0.0;
};

/// A digital filter as a cascade of sections; sections instead of one polynomial, whose coefficients lose all digits at
/// the narrow bands of a large decimation.
struct second_order_sections {
    int order = 0;
    std::vector<second_order_section> sections;

    /// |H| at `frequency`, a fraction of the Nyquist frequency in [0, 1].
    double gain(double frequency) const;
};

/// Butterworth low-pass by the bilinear transform with prewarping: |H| = 1 / sqrt(2) at `cutoff`, a fraction of the
/// Nyquist frequency in (0, 1). Same filter as scipy.signal.butter(order, cutoff). Throws std::invalid_argument for an
/// order outside 1..12 or a cut-off outside (0, 1).
///
/// Written here because Debian 12 packages no maintained C++ library that designs IIR filters.
/// Source: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., 7.2 (bilinear transform), appendix
/// B.
second_order_sections butterworth_lowpass(int order, double cutoff);

/// Chebyshev type I low-pass: ripple of `ripple_db` decibel up to `cutoff`. Same filter as scipy.signal.cheby1(order,
/// ripple_db, cutoff). Errors and source as above.
second_order_sections chebyshev_lowpass(int order, double ripple_db, double cutoff);

}  // namespace idim
