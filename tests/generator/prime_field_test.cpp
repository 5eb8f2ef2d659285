#include "base_parameters/prime_field.hpp"

#include <cln/integer.h>
#include <cln/numtheory.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace idim::generator {

namespace {

constexpr std::uint64_t prime = prime_field::modulus;

/// The same residue by CLN's integers.
std::uint64_t reduced(const cln::cl_I& value) {
    return static_cast<std::uint64_t>(
        cln::cl_I_to_ulong(cln::mod(value, cln::cl_I(static_cast<unsigned long>(prime)))));
}

cln::cl_I integer(prime_field x) {
    return cln::cl_I(static_cast<unsigned long>(x.value()));
}

}  // namespace

TEST(PrimeField, ComputesAsIntegersModuloThePrimeDo) {
    std::mt19937_64 random(61);
    for (int k = 0; k < 2000; ++k) {
        const prime_field a(random());
        const prime_field b(random());
        EXPECT_EQ((a + b).value(), reduced(integer(a) + integer(b)));
        EXPECT_EQ((a - b).value(), reduced(integer(a) - integer(b)));
        EXPECT_EQ((a * b).value(), reduced(integer(a) * integer(b)));
        EXPECT_EQ((-a).value(), reduced(-integer(a)));
        EXPECT_EQ(a * a.inverse(), prime_field(std::uint64_t{1}));
        EXPECT_EQ((a / b) * b, a);
    }
}

TEST(PrimeField, ValuesAtTheEdgesAreReduced) {
    const prime_field largest(prime - 1);
    EXPECT_TRUE(prime_field(prime).is_zero());
    EXPECT_EQ(prime_field(prime + 5).value(), 5u);
    EXPECT_EQ((largest + prime_field(std::uint64_t{1})).value(), 0u);
    EXPECT_EQ((largest * largest).value(), 1u);
    EXPECT_EQ((prime_field() - prime_field(std::uint64_t{1})).value(), prime - 1);
    EXPECT_TRUE((-prime_field()).is_zero());
}

TEST(PrimeField, ZeroHasNoInverse) {
    EXPECT_THROW(prime_field().inverse(), std::domain_error);
    EXPECT_THROW(prime_field(std::uint64_t{3}) / prime_field(), std::domain_error);
    EXPECT_THROW(prime_field(rational(1) / rational(static_cast<unsigned long>(prime))), std::domain_error);
}

// Which elements have a root is Jacobi's symbol, by CLN.
TEST(PrimeField, RootsAreOfTheSquaresAndOfNothingElse) {
    std::mt19937_64 random(63);
    const cln::cl_I modulus(static_cast<unsigned long>(prime));
    for (int k = 0; k < 500; ++k) {
        const prime_field a(random());
        const std::optional<prime_field> root = a.root();
        EXPECT_EQ(root.has_value(), cln::jacobi(integer(a), modulus) == 1) << a.value();
        EXPECT_TRUE(!root || *root * *root == a) << a.value();
        EXPECT_TRUE((a * a).root().has_value()) << a.value();
    }
    EXPECT_EQ(prime_field().root(), prime_field());
}

TEST(PrimeField, RationalsKeepTheirSumsAndProducts) {
    std::mt19937_64 random(62);
    const auto draw = [&random] {
        return rational(static_cast<long>(random() % 20001) - 10000) / rational(static_cast<long>(random() % 9999) + 1);
    };
    for (int k = 0; k < 500; ++k) {
        const rational a = draw();
        const rational b = draw();
        EXPECT_EQ(prime_field(a) + prime_field(b), prime_field(a + b));
        EXPECT_EQ(prime_field(a) * prime_field(b), prime_field(a * b));
    }
}

TEST(PrimeField, ShortFractionsAreReconstructed) {
    std::mt19937_64 random(63);
    for (int k = 0; k < 2000; ++k) {
        const long numerator = static_cast<long>(random() % (1u << 29));
        const rational value =
            rational(k % 2 == 0 ? numerator : -numerator) / rational(static_cast<long>(random() % (1u << 29)) + 1);
        bool found = false;
        EXPECT_EQ(reconstruct(prime_field(value), found), value);
        EXPECT_TRUE(found);
    }
}

TEST(PrimeField, WhatIsReconstructedHasTheResidueItCameFrom) {
    std::mt19937_64 random(64);
    for (int k = 0; k < 2000; ++k) {
        const prime_field residue(random());
        bool found = false;
        const rational value = reconstruct(residue, found);
        if (found) {
            EXPECT_EQ(prime_field(value), residue);
        }
    }
}

}  // namespace idim::generator
