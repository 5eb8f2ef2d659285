#include "base_parameters/angle_relations.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "graph/evaluate.hpp"

namespace idim::generator {

namespace {

/// Angles in q1, q2 and the constant k = 0.7.
class angles {
  public:
    int of(const rational& of_q1, const rational& of_q2, const rational& of_k = 0) {
        const auto term = [this](const rational& factor, signed_node symbol) {
            return graph_.multiply(graph_.constant(factor), symbol);
        };
        const signed_node sum = graph_.add(graph_.add(term(of_q1, q1_), term(of_q2, q2_)), term(of_k, k_));
        graph_.output("cos", static_cast<int>(nodes_.size()), graph_.function(function_kind::cos, sum));
        nodes_.push_back(sum.id);
        signs_.push_back(sum.negative ? -1.0 : 1.0);
        coefficients_.push_back({to_double(of_q1), to_double(of_q2), 0.7 * to_double(of_k)});
        return sum.id;
    }

    angle_relations relations() const { return {graph_, {rational(7) / 10}}; }

    /// Every angle against its composition, at random positions.
    void expect_composed() const {
        const angle_relations found = relations();
        std::mt19937_64 random(31);
        for (int k = 0; k < 20; ++k) {
            const double q1 = std::uniform_real_distribution<double>(-3.0, 3.0)(random);
            const double q2 = std::uniform_real_distribution<double>(-3.0, 3.0)(random);
            std::map<int, double> value;
            for (std::size_t i = 0; i < nodes_.size(); ++i) {
                const auto& c = coefficients_[i];
                value[nodes_[i]] = signs_[i] * (c[0] * q1 + c[1] * q2 + c[2]);
            }
            for (const auto& [node, angle] : value) {
                const composed_angle* composed = found.find(node);
                if (composed == nullptr) {
                    continue;
                }
                double sum = 0.0;
                for (const auto& [free, multiple] : composed->terms) {
                    const composed_angle* parts = found.find(free);
                    sum += multiple * value.at(free) / (parts == nullptr ? 1 : parts->terms.at(0).second);
                }
                double cosine = std::cos(sum), sine = std::sin(sum);
                if (composed->constant) {
                    const double c = to_double(composed->constant->first), s = to_double(composed->constant->second);
                    cosine = std::cos(sum) * c - std::sin(sum) * s;
                    sine = std::sin(sum) * c + std::cos(sum) * s;
                }
                EXPECT_NEAR(cosine, std::cos(angle), 1e-13);  // rounding of angles up to about thirty
                EXPECT_NEAR(sine, std::sin(angle), 1e-13);
            }
        }
    }

  private:
    expression_graph graph_;
    signed_node k_ = graph_.symbol({"k", symbol_role::constant, 0});
    signed_node q1_ = graph_.symbol({"q1", symbol_role::position, 0});
    signed_node q2_ = graph_.symbol({"q2", symbol_role::position, 1});
    std::vector<int> nodes_;
    std::vector<double> signs_;
    std::vector<std::array<double, 3>> coefficients_;
};

const rational half = rational(1) / 2;

}  // namespace

TEST(AngleRelations, IndependentAnglesAreFree) {
    angles two;
    const int first = two.of(1, 0), second = two.of(-1, 1);
    EXPECT_EQ(two.relations().find(first), nullptr);
    EXPECT_EQ(two.relations().find(second), nullptr);
}

TEST(AngleRelations, ASumOfAnglesIsComposedOfThem) {
    angles three;
    three.of(1, 0);
    three.of(-1, 1);
    const int sum = three.of(0, -2);
    const angle_relations found = three.relations();
    ASSERT_NE(found.find(sum), nullptr);
    EXPECT_EQ(found.find(sum)->terms.size(), 2u);
    EXPECT_FALSE(found.find(sum)->constant);
    three.expect_composed();
}

TEST(AngleRelations, FractionsOfAnAngleCutItIntoParts) {
    angles fractions;
    const int whole = fractions.of(1, 0), part = fractions.of(half, 0), third = fractions.of(rational(2) / 3, 0);
    fractions.of(half, 1);
    fractions.of(0, 3);
    const angle_relations found = fractions.relations();
    ASSERT_NE(found.find(whole), nullptr);
    EXPECT_EQ(found.find(whole)->terms, (std::vector<std::pair<int, int>>{{whole, 6}}));
    EXPECT_EQ(found.find(part)->terms, (std::vector<std::pair<int, int>>{{whole, 3}}));
    EXPECT_EQ(found.find(third)->terms, (std::vector<std::pair<int, int>>{{whole, 4}}));
    fractions.expect_composed();
}

TEST(AngleRelations, ConstantAnglesBetweenDependentOnesAreKept) {
    angles shifted;
    shifted.of(1, 0, 1);
    const int negative = shifted.of(-2, 0, half);
    ASSERT_NE(shifted.relations().find(negative), nullptr);
    EXPECT_TRUE(shifted.relations().find(negative)->constant);
    shifted.expect_composed();
}

TEST(AngleRelations, LargeAndBrokenMultiplesAreLeftFree) {
    // cos(q) and cos(q/100) are related by a polynomial of degree 100 only.
    angles geared;
    const int first = geared.of(1, 0), hundredth = geared.of(rational(1) / 100, 0),
              odd = geared.of(rational(355) / 113, 0);
    for (const int node : {first, hundredth, odd}) {
        EXPECT_EQ(geared.relations().find(node), nullptr);
    }
}

}  // namespace idim::generator
