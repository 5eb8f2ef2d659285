#include "kinematics/expression_parser.hpp"

#include <gtest/gtest.h>

#include <string>

namespace idim::generator {

namespace {

const input_location here = {"robot.yaml", 3, "joints[1].d"};

class ExpressionParser : public testing::Test {
  protected:
    GiNaC::ex parse(const std::string& text) const { return parse_expression({text, here}, names); }

    /// Rational value of a text without names.
    std::string exact(const std::string& text) const {
        std::ostringstream printed;
        printed << constant_value(parse(text), here);
        return printed.str();
    }

    /// Message of the one input_error that `text` must give.
    std::string error_of(const std::string& text) const {
        try {
            constant_value(parse(text).subs(GiNaC::lst{q == 1, L == 2}), here);
        } catch (const input_error& error) {
            EXPECT_EQ(error.where().file, here.file);
            EXPECT_EQ(error.where().line, here.line);
            EXPECT_EQ(error.where().field, here.field);
            return error.what();
        } catch (const std::exception& error) {
            ADD_FAILURE() << "\"" << text << "\" gives no input_error: " << error.what();
            return error.what();
        }
        ADD_FAILURE() << "\"" << text << "\" is accepted";
        return "";
    }

    GiNaC::symbol q{"q"}, L{"L"};
    named_values names = {{"q", q}, {"L", L}};
};

TEST_F(ExpressionParser, ReadsDecimalsExactly) {
    EXPECT_EQ(exact("0.1"), "1/10");
    EXPECT_EQ(exact(".5"), "1/2");
    EXPECT_EQ(exact("5."), "5");
    EXPECT_EQ(exact("1e-3"), "1/1000");
    EXPECT_EQ(exact("2.50E+2"), "250");
    EXPECT_EQ(exact("007"), "7");
    EXPECT_EQ(exact("0.1 + 0.2"), "3/10");
    EXPECT_EQ(exact("0.15005"), "3001/20000");
    EXPECT_EQ(exact("1.5707963267948966"), "7853981633974483/5000000000000000");
}

TEST_F(ExpressionParser, KnowsPrecedenceAndAssociativity) {
    EXPECT_EQ(exact("2 + 3*4"), "14");
    EXPECT_EQ(exact("2 - 3 - 4"), "-5");
    EXPECT_EQ(exact("12/2/3"), "2");
    EXPECT_EQ(exact("-2^2"), "-4");
    error_of("2^3^2");  // read one way in mathematics and another in some languages: parentheses decide
    EXPECT_EQ(exact("2^(3^2)"), "512");
    EXPECT_EQ(exact("(2 + 3)*4"), "20");
    EXPECT_EQ(exact("2*-3"), "-6");
}

TEST_F(ExpressionParser, GivesNamesTheirMeaning) {
    EXPECT_TRUE((parse("q + pi/2") - q - GiNaC::Pi / 2).is_zero());
    EXPECT_TRUE((parse("-2*L*q") + 2 * L * q).is_zero());
    EXPECT_TRUE((parse("sin(q)^2") - GiNaC::pow(GiNaC::sin(q), 2)).is_zero());
    EXPECT_TRUE(parse("sign(q)").is_equal(idim::generator::sign(q)));
}

TEST_F(ExpressionParser, NamesOfTheLibraryMeanNothingUnlessDeclared) {
    for (const char* name : {"I", "Pi", "Euler", "Catalan", "Digits", "s_q", "n_0", "zeta", "lgamma", "nan", "inf"}) {
        EXPECT_NE(error_of(name).find("unknown symbol"), std::string::npos) << name;
    }
    names["I"] = 3;
    names["Euler"] = 4;
    EXPECT_EQ(exact("I*Euler"), "12");
}

TEST_F(ExpressionParser, ListsTheKnownNamesBesideAnUnknownOne) {
    EXPECT_EQ(error_of("q + LL"),
              "robot.yaml:3: joints[1].d: expression \"q + LL\": unknown symbol \"LL\", expected one of: L, q, pi");
}

TEST_F(ExpressionParser, RefusesWhatIsMalformed) {
    for (const char* text :
         {"",    " ",  "-",   "q +",   "* q",   "q +* L",    "q q",   "2 q",   "2q",   "(q",     "q)",
          ")q(", "()", "sin", "sin()", "sin q", "sin(q, q)", "sin(q", "pi(2)", "q(2)", "abs( )", "1.2.3",
          ".",   "1e", "1e+", "1.e.2", "1 2",   "0x10",      "2**3",  "q!",    "1,2"}) {
        error_of(text);
    }
}

TEST_F(ExpressionParser, RefusesCharactersThatCouldMeanSomethingElsewhere) {
    for (const char* text :
         {"q;1", "q\n1", "q\t1", "`q`", "$q",  "\"q\"", "'q'",  "q\\",   "#q",    "q{}",      "q[0]", "@q",
          "q=1", "q<1",  "q|1",  "q&1", "q%2", "q?1:2", "q//1", "/*q*/", "{{q}}", "\xcf\x80", "q\x01"}) {
        const std::string message = error_of(text);
        EXPECT_EQ(message.find("unknown symbol"), std::string::npos) << message;
    }
}

TEST_F(ExpressionParser, RefusesPoles) {
    for (const char* text : {"1/0", "1/(2 - 2)", "q/(L - L)", "0^-1", "0^(-2)", "log(0)", "tan(pi/2)", "0/0"}) {
        error_of(text);
    }
}

TEST_F(ExpressionParser, RefusesWhatIsNotReal) {
    for (const char* text : {"sqrt(-1)", "log(-1)", "(-1)^0.5"}) {
        EXPECT_NE(error_of(text).find("expected a real number"), std::string::npos) << text;
    }
}

TEST_F(ExpressionParser, RefusesPowersThatWouldExplode) {
    for (const char* text :
         {"exp(10^15)", "exp(-10^16*10^16)", "2^17", "2^99999999", "10^(10^10)", "9^9^9^9", "2^(3^99)", "q^1000000",
          "2^-100000", "((((2^16)^16)^16)^16)^16", "1e999", "1e-999", "1e99999999999999999999"}) {
        error_of(text);
    }
    error_of(std::string(100, '9'));
}

TEST_F(ExpressionParser, RefusesDeepAndLongTexts) {
    const auto nested = [](std::size_t depth) { return std::string(depth, '(').append("1").append(depth, ')'); };
    EXPECT_EQ(exact(nested(40)), "1");
    error_of(nested(100));
    std::string sum = "1";
    for (int i = 0; i < 1000; ++i) {
        sum += "+1";
    }
    error_of(sum);
    std::string calls = "1";
    for (int i = 0; i < 60; ++i) {
        calls = "sin(" + calls + ")";
    }
    error_of(calls);
    error_of(std::string(900, '-').append("x"));
}

TEST_F(ExpressionParser, EveryMessageIsOneLine) {
    for (const char* text : {"q\nL", "unknown\n", "1\r/0", ""}) {
        const std::string message = error_of(text);
        EXPECT_LT(message.size(), 1300u);
    }
}

TEST_F(ExpressionParser, IrrationalConstantsHaveMoreDigitsThanADouble) {
    const GiNaC::numeric root = constant_value(parse("sqrt(2)"), here);
    EXPECT_TRUE(root.is_rational());
    EXPECT_LT(GiNaC::abs(root * root - 2).to_double(), 1e-50);
    EXPECT_EQ(exact("cos(pi/3)"), "1/2");
}

}  // namespace

}  // namespace idim::generator
