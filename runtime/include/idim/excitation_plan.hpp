#pragma once

#include <optional>

#include "idim/fourier_series.hpp"
#include "idim/log.hpp"
#include "idim/motion_limits.hpp"

namespace idim {

/// A whole reference: rest, connection, periods, connection, rest. A connection is a polynomial of degree five between
/// rest and the position, velocity and acceleration at which a period begins, so that all three are continuous.
/// Each part takes a whole number of samples.
struct excitation_plan {
    fourier_series series;
    Eigen::VectorXd rest;  ///< [n] position before and after
    double start = 0.0;    ///< instant of the series at which its first period begins [s]
    int periods = 1;
    double rest_time = 0.0;        ///< at either end [s]
    double connection_time = 0.0;  ///< at either end [s]
    double rate = 0.0;             ///< samples per second

    /// 2 rests, 2 connections and the periods [s].
    double duration() const;
};

/// Chooses where in the period the motion begins: at instant 0 if both connections keep the limits from there, else at
/// the one that does so best. Returns what they break there, 0 or less if nothing.
limit_breach choose_start(const limited_robot& robot, excitation_plan& plan);

/// What the whole motion breaks, looked at in steps of a fortieth of its fastest sinusoid or finer.
limit_breach largest_breach(const limited_robot& robot, const excitation_plan& plan);

/// The reference as a log of t and qr1.., and of its qd and qdd where asked for.
log reference_of(const excitation_plan& plan, bool with_derivatives);

}  // namespace idim
