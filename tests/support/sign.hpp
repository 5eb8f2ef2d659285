#pragma once

namespace idim::test {

/// Zero at zero.
inline double sign(double x) {
    return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0);
}

}  // namespace idim::test
