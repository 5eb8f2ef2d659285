#pragma once

#include <Eigen/Core>
#include <vector>

namespace idim {

/// One sinusoid of a joint: sine * sin(m w t) + cosine * cos(m w t), w = 2 pi / period [rad or m].
struct harmonic {
    int multiple = 1;  ///< m, 1 or more
    double sine = 0.0;
    double cosine = 0.0;
};

/// A periodic motion, a finite Fourier series for every joint.
struct fourier_series {
    double period = 0.0;                        ///< [s]
    Eigen::VectorXd offset;                     ///< [n] mean position [rad or m]
    std::vector<std::vector<harmonic>> joints;  ///< [n]

    int largest_multiple() const;
};

/// Instants of a motion, samples in rows, joints in columns [rad or m, and per s].
struct motion_samples {
    Eigen::VectorXd t;  ///< [s]
    Eigen::MatrixXd q, qd, qdd;
};

/// One period at t = k period / count, k = 0..count-1.
motion_samples sample_period(const fourier_series& series, Eigen::Index count);

/// Instants enough for the fastest sinusoid to have forty, at least `least`.
Eigen::Index samples_of_period(const fourier_series& series, Eigen::Index least);

}  // namespace idim
