#include "description/decimal.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace idim::generator {

namespace {

int turns_read(const std::string& text) {
    return written_angle(text).quarter_turns;
}

}  // namespace

TEST(Decimal, AnglesRoundedOrCutOffToFourDecimalsOrMoreAreMultiplesOfAQuarterTurn) {
    for (const char* text : {"1.5708", "1.5707", "1.57079", "1.57080", "1.570796", "1.570797", "1.570796326",
                             "1.5707963267948966", "+1.5708", "15.708e-1", "157.08E-2"}) {
        EXPECT_EQ(turns_read(text), text == std::string("1.570797") ? 0 : 1) << text;
    }
    EXPECT_EQ(turns_read("-1.5708"), -1);
    EXPECT_EQ(turns_read("3.14159"), 2);
    EXPECT_EQ(turns_read("-3.1415926"), -2);
    EXPECT_EQ(turns_read("4.7124"), 3);
    EXPECT_EQ(turns_read("4.712388"), 3);
    EXPECT_EQ(turns_read("6.2832"), 4);
}

TEST(Decimal, AnglesWithFewerDecimalsOrOtherDigitsStayAsWritten) {
    for (const char* text : {"1.57", "1.571", "3.14", "3.142", "1.5709", "1.5706", "3.1417", "0.7854", "0", "0.0000",
                             "2", "1.5700", "15.708"}) {
        EXPECT_EQ(turns_read(text), 0) << text;
        EXPECT_EQ(written_angle(text).radians, decimal(text)) << text;
    }
}

TEST(Decimal, EveryDoubleNearestToAMultipleOfAQuarterTurnIsThatMultiple) {
    for (int k = -8; k <= 8; ++k) {
        EXPECT_EQ(angle_of(k * std::numbers::pi / 2.0).quarter_turns, k);
    }
}

TEST(Decimal, QuarterTurnsHaveExactCosineAndSine) {
    constexpr int cosines[] = {1, 0, -1, 0};
    for (int k = -8; k <= 8; ++k) {
        const unit_vector direction = angle_of(k * std::numbers::pi / 2.0).direction();
        EXPECT_EQ(direction.cos, cosines[(k + 8) % 4]);
        EXPECT_EQ(direction.sin, cosines[(k + 11) % 4]);
    }
}

TEST(Decimal, AnglesAreWrittenWithinATurnAndAsMultiplesOfPiWithinATolerance) {
    const decimal pi("3.14159265358979323846264338327950288419716939937511");
    EXPECT_EQ(angle_text(pi / 2), "pi/2");
    EXPECT_EQ(angle_text(-pi), "pi");
    EXPECT_EQ(angle_text(3 * pi / 2), "-pi/2");
    EXPECT_EQ(angle_text(2 * pi + decimal("0.25")), "0.25");
    EXPECT_EQ(angle_text(decimal("1e-10")), "0");
    EXPECT_EQ(angle_text(pi / 2 + decimal("5e-10")), "pi/2");
    EXPECT_EQ(angle_text(decimal("1e-8")), "1e-08");
    EXPECT_EQ(angle_text(decimal("-0.5236")), "-0.5236");
}

TEST(Decimal, LengthsReadBackExactlyAndVanishBelowTheTolerance) {
    EXPECT_EQ(length_text(decimal("0.1") + decimal("0.2")), "0.3");
    EXPECT_EQ(length_text(decimal_of(0.1 + 0.2)), "0.30000000000000004");
    EXPECT_EQ(length_text(decimal(1) / 3), "0.3333333333333333");
    EXPECT_EQ(length_text(decimal("-9e-10")), "0");
    EXPECT_EQ(nearest_double(decimal("1e-31")), 0.0);
    EXPECT_EQ(nearest_double(decimal("1e-20")), 1e-20);
}

}  // namespace idim::generator
