#pragma once

#include <cstdint>

#include "idim/fourier_series.hpp"
#include "idim/motion_limits.hpp"

namespace idim {

/// Highest frequencies of the published excitation [n, Hz]: f_j = A_qd,j / (2 pi A_q,j), A_q half the range of the
/// joint and A_qd its speed (Bahloul, Tliba and Chitour 2018, section III.B).
Eigen::VectorXd limit_frequencies(const motion_limits& limits);

/// The published excitation (section III.B there): for each joint `count` sinusoids of equal amplitudes and random
/// phases around the centre of its range, their sum scaled so that its largest value is half the range (less 3e-5).
/// Frequencies are `count` different multiples of 1 / period, spread evenly from the first to the last below the limit
/// frequency; fewer where there are not so many. No speed passes its limit, since that of a band-limited signal is at
/// most 2 pi f times its largest value (Bernstein's inequality).
struct multisine_options {
    double period = 0.0;  ///< [s]
    int count = 0;        ///< of sinusoids for each joint
    std::uint64_t seed = 1;
};

/// Throws std::invalid_argument where a joint has no multiple below its limit frequency.
fourier_series make_multisine(const motion_limits& limits, const multisine_options& options);

/// The same with the band of each joint raised, above its limit frequency, until its largest speed or acceleration is
/// at its limit: what the form can do within the limits.
fourier_series make_fast_multisine(const motion_limits& limits, const multisine_options& options);

}  // namespace idim
