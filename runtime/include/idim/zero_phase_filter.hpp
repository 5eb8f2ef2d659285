#pragma once

#include <Eigen/Core>

#include "idim/second_order_sections.hpp"

namespace idim {

/// Samples in rows and one signal per column, whatever the storage order.
using signal_columns = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>>;

/// Samples added at each end before filtering, 3 (order + 1), the default `padlen` of scipy.signal.filtfilt and
/// sosfiltfilt. A signal must be longer than this.
Eigen::Index padding(const second_order_sections& filter);

/// Samples after which the filter has forgotten what came before to 1e-16 of it: rows of a part of a signal that lie
/// further than this from the part's ends are filtered as in the whole signal, to rounding.
Eigen::Index settling(const second_order_sections& filter);

/// Filters every column forward and backward, so that the phase is zero and the gain |H|^2, and keeps rows 0, stride,
/// 2 stride, ... The ends are continued by odd reflection and both passes start in the steady state of their first
/// value: scipy.signal.filtfilt and sosfiltfilt with their defaults (F. Gustafsson, IEEE Trans. Signal Processing
/// 44(4), 1996, discusses the choice). The operation is linear in the column, ends included. Columns that are zero
/// throughout stay zero. Throws std::invalid_argument if there are not more than padding() rows.
Eigen::MatrixXd zero_phase_filter(const second_order_sections& filter, const signal_columns& signals,
                                  Eigen::Index stride = 1);

/// The filter of the parallel decimation (METHODS.md, IDIM-LS 3): Chebyshev type I of order 8 with 0.05 dB up to 0.8 of
/// the new Nyquist frequency, as `decimate` of MATLAB and scipy.signal.decimate(x, decimation, ftype='iir',
/// zero_phase=True) use it.
second_order_sections decimation_filter(int decimation);

/// One row in `decimation` of every column after the zero-phase decimation_filter; the signals themselves for 1.
Eigen::MatrixXd decimate(const signal_columns& signals, int decimation);

}  // namespace idim
