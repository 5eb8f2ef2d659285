#include "idim/autocorrelation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "lag_moments.hpp"
#include "support/scara_rows.hpp"

namespace idim {
namespace {

autoregression fit(const std::vector<gapped_series>& segments) {
    return fit_autoregression(autocovariance(segments, highest_order(segments)), samples_of(segments));
}

/// A series of which the samples that `missing(k)` names are missing.
template <typename Rule>
gapped_series with_gaps(const Eigen::VectorXd& value, Rule missing) {
    gapped_series series = complete_series(value);
    for (Eigen::Index k = 0; k < value.size(); ++k) {
        if (missing(k)) {
            series.value[k] = 0.0;
            series.present[k] = 0.0;
        }
    }
    return series;
}

/// Autocorrelation of e_k = a1 e_{k-1} + a2 e_{k-2} + eps_k at lags 1, 2 and its variance at innovations of variance 1
/// [Box, Jenkins and Reinsel 2008, section 3.2.4]: the closed form that the model is held against.
struct ar2 {
    double a1, a2;
    double rho1() const { return a1 / (1.0 - a2); }
    double rho2() const { return a1 * rho1() + a2; }
    double variance() const { return 1.0 / (1.0 - a1 * rho1() - a2 * rho2()); }
    Eigen::VectorXd autocovariance(Eigen::Index lags) const {
        Eigen::VectorXd gamma(lags + 1);
        gamma[0] = variance();
        gamma[1] = gamma[0] * rho1();
        for (Eigen::Index l = 2; l <= lags; ++l) {
            gamma[l] = a1 * gamma[l - 1] + a2 * gamma[l - 2];
        }
        return gamma;
    }
};

TEST(Autocovariance, IsThatOfBurgsReflections) {
    // By hand: 2 (2 - 2 - 3) / (1 + 4 + 4 + 1 + 1 + 9) = -0.3; errors forward -0.4 2.7, backward 1.6 1.7, hence
    // 2 (-0.64 + 4.59) / (0.16 + 7.29 + 2.56 + 2.89) = 7.9 / 12.9.
    const Eigen::VectorXd gamma = autocovariance({complete_series(Eigen::Vector4d(1.0, 2.0, -1.0, 3.0))}, 2);
    EXPECT_DOUBLE_EQ(gamma[0], 15.0 / 4.0);
    EXPECT_DOUBLE_EQ(gamma[1], -0.3 * 15.0 / 4.0);
    EXPECT_NEAR(gamma[2], -0.3 * gamma[1] + 7.9 / 12.9 * (1.0 - 0.09) * gamma[0], 1e-14);
}

TEST(Autocovariance, NeverMultipliesAcrossASeam) {
    const gapped_series one = complete_series(Eigen::Vector2d(1.0, -1.0));
    const Eigen::VectorXd gamma = autocovariance({one, complete_series(Eigen::Vector2d(5.0, 5.0))}, 2);
    EXPECT_DOUBLE_EQ(gamma[0], 13.0);
    EXPECT_DOUBLE_EQ(gamma[1], 12.0);  // 2 (25 - 1) / (1 + 1 + 25 + 25) of it
    EXPECT_NEAR(gamma[2], 144.0 / 13.0, 1e-14) << "no three samples in a row: extrapolated";
}

TEST(Autocovariance, NeverMultipliesAcrossAGap) {
    const gapped_series series = with_gaps(Eigen::Vector4d(3.0, 9.0, 1.0, 2.0), [](Eigen::Index k) { return k == 1; });
    const Eigen::VectorXd gamma = autocovariance({series}, 1);
    EXPECT_DOUBLE_EQ(gamma[0], 14.0 / 3.0);
    EXPECT_NEAR(gamma[1], 0.8 * 14.0 / 3.0, 1e-14);  // 2 * 2 / (1 + 4) of it
}

TEST(Autocovariance, OfNoSamplesIsZero) {
    EXPECT_TRUE(autocovariance({}, 2).isZero(0.0));
    EXPECT_TRUE(autocovariance({complete_series(Eigen::VectorXd(0))}, 2).isZero(0.0));
    EXPECT_TRUE(autocovariance({with_gaps(Eigen::Vector3d::Ones(), [](auto) { return true; })}, 2).isZero(0.0));
}

TEST(Autocovariance, StaysThatOfTheNoiseWhenRowsAreMissing) {
    // 40 segments of 500 samples, one in ten missing: sums of products over all samples would give 0.9 of rho(1), and
    // those over pairs may exceed the variance. Deviation of rho(1) sqrt((1 - phi^2) / 20000) = 0.0042; five of them.
    std::mt19937_64 random(17);
    std::bernoulli_distribution missing(0.1);
    std::vector<gapped_series> segments;
    for (int i = 0; i < 40; ++i) {
        segments.push_back(with_gaps(test::ar1_noise(500, 0.8, random), [&](auto) { return missing(random); }));
    }
    const Eigen::VectorXd gamma = autocovariance(segments, 3);
    EXPECT_NEAR(gamma[1] / gamma[0], 0.8, 0.021);
    EXPECT_NEAR(gamma[3] / gamma[0], 0.512, 0.04);
    EXPECT_NEAR(fit(segments).correlation_length(20000), 9.0, 1.2);
}

TEST(LaggedPairs, AreThoseOfPresentSamples) {
    const auto second = [](Eigen::Index k) { return k == 1; };
    lag_moments moments(3);
    for (const gapped_series& segment :
         {with_gaps(Eigen::VectorXd::Ones(5), second), complete_series(Eigen::Vector2d::Ones())}) {
        moments.begin_segment();
        moments.add(segment);
    }
    EXPECT_EQ(moments.pairs(), Eigen::Vector4d(4.0 + 2.0, 2.0 + 1.0, 2.0, 1.0));  // samples 0 2 3 4 and 0 1
}

TEST(Autoregression, RecoversTheCoefficientsOfAnExactAutocovariance) {
    const ar2 truth{1.2, -0.5};
    const autoregression model = fit_autoregression(truth.autocovariance(6), 100000);
    // Orders above 2 have reflections of rounding size; whatever order is kept, the coefficients are those of order 2.
    ASSERT_GE(model.order(), 2);
    EXPECT_NEAR(model.a[0], 1.2, 1e-12);
    EXPECT_NEAR(model.a[1], -0.5, 1e-12);
    EXPECT_NEAR(model.innovation, 1.0, 1e-12);
    EXPECT_NEAR(model.variance, truth.variance(), 1e-12);
    const Eigen::VectorXd gamma = truth.autocovariance(40);
    EXPECT_LT((model.variance * model.autocorrelation(40) - gamma).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Autoregression, CorrelationLengthOfAr1IsItsClosedForm) {
    // 1 + 2 sum phi^l = (1 + phi) / (1 - phi) = 9; for phi < 0 that is below 1, and 1 + 2 sum phi^2l = 5/3 takes over
    // at -0.5.
    const auto length = [](double phi) {
        const Eigen::VectorXd gamma = Eigen::Vector2d(2.0, 2.0 * phi);
        return fit_autoregression(gamma, 100000).correlation_length(1000);
    };
    EXPECT_NEAR(length(0.8), 9.0, 1e-9);
    EXPECT_NEAR(length(-0.5), 5.0 / 3.0, 1e-6);  // the memory is cut at 1e-4 of the response
    EXPECT_DOUBLE_EQ(length(0.0), 1.0);
}

TEST(Autoregression, CorrelationLengthOfAnOscillationIsNotHiddenByItsChangesOfSign) {
    // Poles of modulus 0.98 at a tenth of the rate: rho(l) sum to less than nothing, the noise still lasts about 50
    // rows.
    const ar2 truth{2.0 * 0.98 * std::cos(0.2 * std::numbers::pi), -0.98 * 0.98};
    EXPECT_LT(1.0 / std::pow(1.0 - truth.a1 - truth.a2, 2) / truth.variance(), 1.0);
    EXPECT_GT(fit_autoregression(truth.autocovariance(2), 100000).correlation_length(1000), 20.0);
}

TEST(Autoregression, CorrelationLengthIsAtMostTheLimit) {
    const Eigen::VectorXd gamma = Eigen::Vector2d(1.0, 0.9999);
    EXPECT_DOUBLE_EQ(fit_autoregression(gamma, 500).correlation_length(50), 50.0);
}

TEST(Autoregression, OfWhiteNoiseHasNoCorrelationLength) {
    // Order 0 is right, the criterion takes a higher one now and then: on average the length stays within a tenth of 1.
    double sum = 0.0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937_64 random(seed);
        sum += fit({complete_series(test::white_noise(2000, random))}).correlation_length(2000);
    }
    EXPECT_LT(sum / 50.0, 1.1);
}

TEST(Autoregression, OfManySegmentsFindsTheLengthOfTheirNoise) {
    // 40 segments of 500 rows, phi = 0.8: deviation of phi sqrt((1 - phi^2) / 20000) = 0.004, of the length 2 / (1 -
    // phi)^2 times that, 0.2; the bias of autocovariances over 500 samples at lag 1 is 1/500 of phi. Bound: five
    // deviations.
    std::mt19937_64 random(3);
    std::vector<gapped_series> segments;
    for (int i = 0; i < 40; ++i) {
        segments.push_back(complete_series(test::ar1_noise(500, 0.8, random)));
    }
    EXPECT_NEAR(fit(segments).correlation_length(20000), 9.0, 1.0);
}

TEST(Autoregression, OfZerosHasOrderZeroAndNoVariance) {
    const autoregression model = fit({complete_series(Eigen::VectorXd::Zero(100))});
    EXPECT_EQ(model.order(), 0);
    EXPECT_EQ(model.innovation, 0.0);
    EXPECT_EQ(model.correlation_length(100), 1.0);
}

TEST(Autoregression, EndsBeforeAnAutocovarianceThatIsNotPositiveDefinite) {
    const Eigen::VectorXd gamma = Eigen::Vector3d(1.0, 0.9, -0.9);
    const autoregression model = fit_autoregression(gamma, 1000);
    EXPECT_EQ(model.order(), 1);
    EXPECT_DOUBLE_EQ(model.a[0], 0.9);
}

TEST(Autoregression, OfAPureSinusoidStaysStable) {
    const Eigen::VectorXd e = Eigen::ArrayXd::LinSpaced(400, 0.0, 100.0).sin();
    const autoregression model = fit({complete_series(e)});
    EXPECT_GT(model.innovation, 0.0);
    EXPECT_TRUE(std::isfinite(model.correlation_length(400)));
}

TEST(Autoregression, OfASeriesThatDoesNotChangeIsAsLongAsTheSeries) {
    const autoregression model = fit_autoregression(Eigen::Vector3d(1.0, 1.01, 1.02), 300);
    EXPECT_EQ(model.order(), 1);
    EXPECT_DOUBLE_EQ(model.correlation_length(300), 300.0);
}

TEST(InnovationResponses, GiveTheQuadraticFormOfTheToeplitzAutocovariance) {
    const ar2 truth{1.2, -0.5};
    const autoregression model = fit_autoregression(truth.autocovariance(2), 100000);
    std::mt19937_64 random(11);
    Eigen::MatrixXd X(60, 3);
    for (Eigen::Index c = 0; c < 3; ++c) {
        X.col(c) = test::ar1_noise(60, 0.5, random);
    }
    const Eigen::VectorXd gamma = truth.autocovariance(59);
    Eigen::MatrixXd Gamma(60, 60);
    for (Eigen::Index i = 0; i < 60; ++i) {
        for (Eigen::Index k = 0; k < 60; ++k) {
            Gamma(i, k) = gamma[std::abs(i - k)];
        }
    }
    const Eigen::MatrixXd direct = X.transpose() * Gamma * X;
    const Eigen::MatrixXd Z = innovation_responses(model, X, model.memory(1000));
    // What the tail leaves out has responses under 1e-4, squared, against a sum of order 1.
    EXPECT_LT((model.innovation * Z.transpose() * Z - direct).norm() / direct.norm(), 1e-6);
    EXPECT_LT((covariance_times(model, Z, 60) - Gamma * X).norm() / (Gamma * X).norm(), 1e-4);
    // Lagged products of the responses are the same form with the autocovariance shifted.
    Eigen::MatrixXd shifted(60, 60);
    for (Eigen::Index i = 0; i < 60; ++i) {
        for (Eigen::Index k = 0; k < 60; ++k) {
            shifted(i, k) = truth.autocovariance(70)[std::abs(i - k + 3)];
        }
    }
    EXPECT_NEAR(model.innovation * lagged_products(Z, 3)[3], (X.transpose() * shifted * X).trace(),
                1e-4 * direct.trace());
}

TEST(Innovations, UndoTheModel) {
    const autoregression model = fit_autoregression(ar2{1.2, -0.5}.autocovariance(2), 100000);
    std::mt19937_64 random(5);
    const Eigen::VectorXd eps = test::white_noise(50, random);
    Eigen::VectorXd e = eps;
    for (Eigen::Index k = 2; k < 50; ++k) {
        e[k] += model.a[0] * e[k - 1] + model.a[1] * e[k - 2];
    }
    EXPECT_LT((innovations(model, complete_series(e)) - eps.tail(48)).norm(), 1e-12);
    EXPECT_EQ(innovations(model, complete_series(e.head(2))).size(), 0);
}

TEST(Innovations, OfMissingSamplesAreZeroAndThoseAfterAGapHoldItsError) {
    const autoregression model = fit_autoregression(Eigen::Vector2d(1.0, 0.5), 100000);
    const gapped_series series =
        with_gaps(Eigen::VectorXd{{8.0, 5.0, 7.0, 9.0, 1.0}}, [](Eigen::Index k) { return k == 2 || k == 3; });
    // Prediction 0.5 of the one before: 4; 2.5 and 1.25 in the gap; 0.625.
    EXPECT_LT((innovations(model, series) - Eigen::Vector4d(1.0, 0.0, 0.0, 0.375)).norm(), 1e-14);
}

}  // namespace
}  // namespace idim
