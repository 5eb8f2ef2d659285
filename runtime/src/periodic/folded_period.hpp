#pragma once

#include "idim/periodic.hpp"

namespace idim {

/// Average of the samples over the periods; t is that of the first.
filtered_samples mean_period(const motion_source& motion, const periodic_part& part);

/// Samples by which an averaged period is repeated at both ends: the response of the decimation filter has died out
/// after 25 of its rows. A whole number of rows.
Eigen::Index period_margin(const filter_choice& choice);

/// Decimated rows of one period; where the period is no whole number of them, the last is shorter.
Eigen::Index rows_in_period(const periodic_part& part, const filter_choice& choice);

/// The scatter of all periods but p; at least two must be left.
torque_scatter without_period(torque_scatter scatter, std::size_t p);

}  // namespace idim
