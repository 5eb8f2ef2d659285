#include "kinematics/planar_vector.hpp"

#include <algorithm>

namespace idim::generator {

using GiNaC::ex;

plane_pair operator+(const plane_pair& a, const plane_pair& b) {
    return {a[0] + b[0], a[1] + b[1]};
}

plane_pair operator-(const plane_pair& a, const plane_pair& b) {
    return {a[0] - b[0], a[1] - b[1]};
}

plane_pair operator*(const ex& scale, const plane_pair& a) {
    return {scale * a[0], scale * a[1]};
}

ex dot(const plane_pair& a, const plane_pair& b) {
    return a[0] * b[0] + a[1] * b[1];
}

plane_pair product(const plane_pair& a, const plane_pair& b) {
    return {a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]};
}

plane_pair conjugate(const plane_pair& a) {
    return {a[0], -a[1]};
}

plane_pair quarter_turned(const plane_pair& a) {
    return {-a[1], a[0]};
}

namespace {

plane_pair turned(const plane_pair& a, const ex& angle) {
    return angle.is_zero() ? a : product(a, {GiNaC::cos(angle), GiNaC::sin(angle)});
}

}  // namespace

ex time_derivative(const ex& linear, const std::vector<GiNaC::symbol>& q, const std::vector<GiNaC::symbol>& qd) {
    ex sum = 0;
    for (std::size_t k = 0; k < q.size(); ++k) {
        sum += linear.diff(q[k]) * qd[k];
    }
    return sum;
}

void planar_vector::add(const plane_term& term) {
    const auto same = std::find_if(terms_.begin(), terms_.end(), [&term](const plane_term& known) {
        return (known.angle - term.angle).expand().is_zero();
    });
    plane_pair xy = same == terms_.end() ? term.xy : same->xy + term.xy;
    xy = {xy[0].expand(), xy[1].expand()};
    const bool vanishes = xy[0].is_zero() && xy[1].is_zero();
    if (same != terms_.end()) {
        same->xy = xy;
        if (vanishes) {
            terms_.erase(same);
        }
    } else if (!vanishes) {
        terms_.push_back({term.angle, xy});
    }
}

void planar_vector::add(const planar_vector& other, int sign) {
    for (const plane_term& term : other.terms_) {
        add({term.angle, ex(sign) * term.xy});
    }
}

plane_pair planar_vector::value() const {
    plane_pair sum = {0, 0};
    for (const plane_term& term : terms_) {
        sum = sum + turned(term.xy, term.angle);
    }
    return sum;
}

plane_pair planar_vector::derivative(const GiNaC::symbol& q) const {
    plane_pair sum = {0, 0};
    for (const plane_term& term : terms_) {
        const plane_pair along = {term.xy[0].diff(q), term.xy[1].diff(q)};
        sum = sum + turned(along + term.angle.diff(q) * quarter_turned(term.xy), term.angle);
    }
    return sum;
}

plane_pair planar_vector::velocity(const std::vector<GiNaC::symbol>& q, const std::vector<GiNaC::symbol>& qd) const {
    plane_pair sum = {0, 0};
    for (std::size_t k = 0; k < q.size(); ++k) {
        sum = sum + qd[k] * derivative(q[k]);
    }
    return sum;
}

plane_pair planar_vector::drift(const std::vector<GiNaC::symbol>& q, const std::vector<GiNaC::symbol>& qd) const {
    plane_pair sum = {0, 0};
    for (const plane_term& term : terms_) {
        const ex rate = time_derivative(term.angle, q, qd);
        const plane_pair along = {time_derivative(term.xy[0], q, qd), time_derivative(term.xy[1], q, qd)};
        sum = sum + turned((2 * rate) * quarter_turned(along) - (rate * rate) * term.xy, term.angle);
    }
    return sum;
}

bool planar_vector::is_bar(const std::vector<GiNaC::symbol>& q) const {
    return terms_.size() == 1 && std::none_of(q.begin(), q.end(), [this](const ex& one) {
               return terms_.front().xy[0].has(one) || terms_.front().xy[1].has(one);
           });
}

}  // namespace idim::generator
