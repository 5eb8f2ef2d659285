#pragma once

#include <ginac/ginac.h>

#include <array>
#include <vector>

namespace idim::generator {

/// x and y.
using plane_pair = std::array<GiNaC::ex, 2>;

plane_pair operator+(const plane_pair& a, const plane_pair& b);
plane_pair operator-(const plane_pair& a, const plane_pair& b);
plane_pair operator*(const GiNaC::ex& scale, const plane_pair& a);
GiNaC::ex dot(const plane_pair& a, const plane_pair& b);
/// As complex numbers.
plane_pair product(const plane_pair& a, const plane_pair& b);
plane_pair conjugate(const plane_pair& a);
plane_pair quarter_turned(const plane_pair& a);

/// (x, y) turned by `angle`, which is linear in the coordinates; x and y are constant, or linear in them.
struct plane_term {
    GiNaC::ex angle = 0;
    plane_pair xy = {0, 0};
};

/// A vector in a plane as a sum of terms of different angles.
class planar_vector {
  public:
    void add(const plane_term& term);
    void add(const planar_vector& other, int sign);

    const std::vector<plane_term>& terms() const { return terms_; }
    plane_pair value() const;
    /// Derivative by a coordinate.
    plane_pair derivative(const GiNaC::symbol& q) const;
    /// First and second derivative by time while no coordinate accelerates.
    plane_pair velocity(const std::vector<GiNaC::symbol>& q, const std::vector<GiNaC::symbol>& qd) const;
    plane_pair drift(const std::vector<GiNaC::symbol>& q, const std::vector<GiNaC::symbol>& qd) const;

    /// One term with constant x and y: it turns as a rigid bar does.
    bool is_bar(const std::vector<GiNaC::symbol>& q) const;

  private:
    std::vector<plane_term> terms_;
};

/// Derivative by time of what is linear in the coordinates.
GiNaC::ex time_derivative(const GiNaC::ex& linear, const std::vector<GiNaC::symbol>& q,
                          const std::vector<GiNaC::symbol>& qd);

}  // namespace idim::generator
