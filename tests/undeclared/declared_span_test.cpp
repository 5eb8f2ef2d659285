// rho: what it says of effects whose place to the declared model is known.
#include "undeclared/declared_span.hpp"

#include <gtest/gtest.h>

#include "undeclared/bench_case.hpp"

namespace idim::undeclared {

namespace {

effect_strength own_strength(const bench_case& made) {
    const recording& log = made.identification.front();
    return declared_span(made.robot, made.declared, log).strength_of(log);
}

TEST(UndeclaredStrength, EffectsInsideTheSpanHaveNoPartOutside) {
    for (std::uint64_t seed = 1; seed <= span_forms().size(); ++seed) {
        const bench_case made = make_case("span", seed);
        const effect_strength found = own_strength(made);
        const double whole = found.whole.cwiseQuotient(found.residual).maxCoeff();
        EXPECT_GT(whole, 1.0) << made.effects.front().form;  // it would show if it could
        // What is left comes from positions that are measured with noise, and from friction's jumps.
        EXPECT_LT(found.largest_rho(), 0.05 * whole) << made.effects.front().form;
    }
}

TEST(UndeclaredStrength, WhatNoModelExplainsIsOutsideAltogether) {
    bench_case made = make_case("nothing", 4);
    recording& log = made.identification.front();
    sampler random("white", 1);
    for (double& value : log.effect.reshaped()) {
        value = random.normal();
    }
    log.tau += log.effect;
    const effect_strength found = own_strength(made);
    const double outside = found.outside.cwiseQuotient(found.residual).norm();
    const double whole = found.whole.cwiseQuotient(found.residual).norm();
    EXPECT_LE(outside, whole * (1.0 + 1e-9));
    EXPECT_GT(outside, 0.8 * whole);  // of 52 directions among some 2000 rows a random signal has few
}

TEST(UndeclaredStrength, CasesHaveTheStrengthThatTheyWereAskedFor) {
    const bench_case made = make_case("spring", 3);
    const effect_strength found = own_strength(made);
    EXPECT_NEAR(found.largest_rho(), made.rho, 0.1 * made.rho);
}

}  // namespace

}  // namespace idim::undeclared
