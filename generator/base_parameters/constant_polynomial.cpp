#include "base_parameters/constant_polynomial.hpp"

#include <fmt/format.h>

namespace idim::generator {

namespace {

constexpr int longest_denominator = 1000;  // of a fraction that reads better than a decimal number

rational power(const rational& base, int exponent) {
    return cln::expt(base, exponent);
}

monomial product_of(const monomial& a, const monomial& b) {
    std::map<std::size_t, int> exponents(a.begin(), a.end());
    for (const auto& [constant, exponent] : b) {
        exponents[constant] += exponent;
    }
    return {exponents.begin(), exponents.end()};
}

std::string printed_monomial(const monomial& m, const kinematic_tree& tree) {
    std::string text;
    for (const auto& [constant, exponent] : m) {
        text += (text.empty() ? "" : "*") + tree.constants[constant].text;
        text += exponent == 1 ? "" : "^" + std::to_string(exponent);
    }
    return text;
}

}  // namespace

constant_polynomial::constant_polynomial(const rational& number) {
    add(number, {});
}

void constant_polynomial::add(const rational& coefficient, const monomial& m) {
    rational& sum = terms.try_emplace(m, rational(0)).first->second;
    sum = sum + coefficient;
    if (cln::zerop(sum)) {
        terms.erase(m);
    }
}

constant_polynomial& constant_polynomial::operator+=(const constant_polynomial& other) {
    for (const auto& [m, coefficient] : other.terms) {
        add(coefficient, m);
    }
    return *this;
}

constant_polynomial operator*(const constant_polynomial& a, const constant_polynomial& b) {
    constant_polynomial result;
    for (const auto& [m, coefficient] : a.terms) {
        for (const auto& [other, factor] : b.terms) {
            result.add(coefficient * factor, product_of(m, other));
        }
    }
    return result;
}

rational constant_polynomial::value(const std::vector<rational>& constants) const {
    rational sum = 0;
    for (const auto& [m, coefficient] : terms) {
        rational product = coefficient;
        for (const auto& [constant, exponent] : m) {
            product = product * power(constants[constant], exponent);
        }
        sum = sum + product;
    }
    return sum;
}

std::string constant_polynomial::text(const kinematic_tree& tree) const {
    bool named = true;
    for (const auto& [m, coefficient] : terms) {
        named = named && cln::denominator(coefficient) < longest_denominator;
        for (const auto& [constant, exponent] : m) {
            named = named && tree.constants[constant].is_named;
        }
    }
    if (!named) {
        return to_decimal(value(constant_values(tree)));
    }
    std::string text;
    for (const auto& [m, coefficient] : terms) {
        const bool negative = cln::minusp(coefficient);
        const rational magnitude = cln::abs(coefficient);
        const std::string factors = printed_monomial(m, tree);
        text += text.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
        if (factors.empty() || magnitude != 1) {
            text += to_fraction(magnitude) + (factors.empty() ? "" : "*");
        }
        text += factors;
    }
    return text;
}

std::vector<rational> constant_values(const kinematic_tree& tree) {
    std::vector<rational> values;
    for (const kinematic_constant& constant : tree.constants) {
        values.push_back(cln::the<cln::cl_RA>(constant.value.to_cl_N()));
    }
    return values;
}

std::vector<monomial> candidate_monomials(const std::vector<std::vector<std::size_t>>& groups) {
    struct candidate {
        monomial factors;
        int length_degree = 0;
    };
    std::vector<candidate> all = {{}};
    for (const std::vector<std::size_t>& group : groups) {
        std::vector<candidate> extended = all;
        for (const candidate& base : all) {
            const auto extend = [&](const monomial& factors, int degree) {
                if (base.length_degree + degree <= 2) {
                    candidate longer = base;
                    longer.factors.insert(longer.factors.end(), factors.begin(), factors.end());
                    longer.length_degree += degree;
                    extended.push_back(longer);
                }
            };
            if (group.size() == 1) {
                extend({{group[0], 1}}, 1);
                extend({{group[0], 2}}, 2);
            } else {
                extend({{group[0], 1}}, 0);
                extend({{group[1], 1}}, 0);
                extend({{group[0], 2}}, 0);
                extend({{group[0], 1}, {group[1], 1}}, 0);
            }
        }
        all = extended;
    }
    std::vector<monomial> result;
    for (const candidate& one : all) {
        result.push_back(one.factors);
    }
    return result;
}

prime_field evaluate(const monomial& m, const std::vector<prime_field>& constants) {
    prime_field product(std::uint64_t{1});
    for (const auto& [constant, exponent] : m) {
        for (int i = 0; i < exponent; ++i) {
            product = product * constants[constant];
        }
    }
    return product;
}

}  // namespace idim::generator
