// Parts of the tracer on rows made here: what a candidate column removes, how sure that is, and which shape it has.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <memory>
#include <random>

#include "support/noise.hpp"
#include "support/traced_rows.hpp"
#include "tracing/effect_tracer.hpp"
#include "tracing/shape_search.hpp"

namespace idim::test {

namespace {

/// A sine of the rows' time, of the frequency that is its shape [Hz], or of a known one.
class sine_candidate final : public effect_candidate {
  public:
    explicit sine_candidate(double phase = 0.0, double known_frequency = 0.0)
        : phase_(phase), known_frequency_(known_frequency) {
        effect = "sine";
        joints = touched = {0};
        linear = {{"A", "N*m"}};
        if (known_frequency == 0.0) {
            shape = {{"f", "Hz", 0.5, 8.0}};
        }
    }
    Eigen::MatrixXd rows(const traced_log& log, int /*joint*/, const Eigen::VectorXd& at) const override {
        const double f = at.size() > 0 ? at[0] : known_frequency_;
        return (2.0 * M_PI * f * log.rows.t.array() + phase_).sin().matrix();
    }

  private:
    double phase_;
    double known_frequency_;
};

/// One joint whose model is a slow sine, a slow cosine and a constant; rows without reversals.
traced_log one_joint_log(const Eigen::VectorXd& added, bool held_back) {
    traced_log log;
    log.held_back = held_back;
    log.rows.file = "rows";
    log.rows.rate = row_rate;
    log.rows.t = Eigen::VectorXd::LinSpaced(rows_in_log, 0.0, (rows_in_log - 1) / row_rate);
    log.rows.kept.resize(1);
    for (Eigen::Index k = 0; k < rows_in_log; ++k) {
        log.rows.kept[0].push_back(k);
    }
    Eigen::MatrixXd W(rows_in_log, 3);
    W << (0.9 * log.rows.t.array()).sin(), (0.9 * log.rows.t.array()).cos(), Eigen::ArrayXd::Ones(rows_in_log);
    log.rows.W.push_back(W);
    log.rows.Y.push_back(W * Eigen::Vector3d(2.0, -1.0, 0.5) + added);
    log.reversal.push_back(row_flags::Constant(rows_in_log, false));
    return log;
}

effect_term term_at(double frequency, double phase = 0.0) {
    return {std::make_shared<sine_candidate>(phase), Eigen::VectorXd::Constant(1, frequency)};
}

TEST(EffectEvidence, GainOfAProjectedColumnIsWhatItRemovesFromTheLoss) {
    std::mt19937_64 random(1);
    const std::vector<traced_log> logs = {one_joint_log(ar1_noise(rows_in_log, 0.5, random) + 0.3 * sine(1.1), false)};
    const trace_fit fit = fit_with_own_noise(logs, {});
    const effect_term term = term_at(1.1);
    Eigen::MatrixXd A(rows_in_log, 4);
    A << logs[0].rows.W[0], sine(1.1);
    const Eigen::VectorXd x = A.colPivHouseholderQr().solve(logs[0].rows.Y[0]);
    const double left = (logs[0].rows.Y[0] - A * x).squaredNorm() * std::pow(fit.weight()[0][0][0], 2);
    const projected_columns columns = fit.project(*term.candidate, term.shape, false);
    EXPECT_NEAR(columns.gain, fit.loss() - left, 1e-9 * fit.loss());  // rounding
    EXPECT_NEAR(columns.coefficient[0], x[3], 1e-9);
}

// A true null at nominal 5 %: of 400 draws at most 8.3 % and at least 1.7 % alarm (three deviations).
// As if all rows were independent, a slow column alarms several times as often: noise of memory 0.8 has nine times its
// mean density at frequency 0.
TEST(EffectEvidence, PartialFOnEffectiveRowsAlarmsAsOftenAsItSaysUnderCorrelatedNoise) {
    constexpr int draws = 400;
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> phase(0.0, 2.0 * M_PI);
    int alarms = 0;
    int naive_alarms = 0;
    for (int i = 0; i < draws; ++i) {
        const std::vector<traced_log> logs = {one_joint_log(ar1_noise(rows_in_log, 0.8, random), false)};
        const trace_fit fit = fit_with_own_noise(logs, {});
        const auto candidate = std::make_shared<sine_candidate>(phase(random), 0.31);
        alarms += test_on_fitted(fit, {candidate, {}}, false).p_value < 0.05 ? 1 : 0;
        row_count all = count_rows(fit, {0}, fit.residual());
        all.effective = all.rows;
        const double gain = fit.project(*candidate, {}, false).gain;
        naive_alarms += partial_f(all, gain, 1.0).p_value < 0.05 ? 1 : 0;
    }
    EXPECT_LE(alarms, 0.083 * draws);
    EXPECT_GE(alarms, 0.017 * draws);
    EXPECT_GE(naive_alarms, 0.2 * draws);
}

TEST(EffectEvidence, ShapeSearchFindsTheFrequencyOfAWeakSine) {
    std::mt19937_64 random(3);
    const std::vector<traced_log> logs = {one_joint_log(ar1_noise(rows_in_log, 0.3, random) + 0.5 * sine(3.37), false)};
    const trace_fit fit = fit_with_own_noise(logs, {});
    const effect_evidence found = search_shape(fit, std::make_shared<sine_candidate>(), 0.2);
    // The bound of Cramer and Rao for a sine of known phase: sqrt(6 / (2 n)) / (pi T A) = 0.0015 Hz here; four of
    // these.
    EXPECT_NEAR(found.term.shape[0], 3.37, 0.006);
    EXPECT_LT(corrected(found.p_value, found.shapes_tried), 1e-4);
}

TEST(EffectEvidence, OnlyLookAlikesAreConfusable) {
    std::mt19937_64 random(4);
    std::vector<traced_log> logs;
    for (const bool held_back : {false, true}) {
        logs.push_back(
            one_joint_log(ar1_noise(rows_in_log, 0.3, random) + 0.6 * sine(2.0) + 0.6 * sine(4.0), held_back));
    }
    const trace_fit fit = fit_with_own_noise(logs, {});
    effect_survey all;
    for (const auto& [frequency, phase] : {std::pair{2.0, 0.0}, {2.0, 0.02}, {4.0, 0.0}}) {
        tried_candidate tried;
        tried.evidence = test_on_fitted(fit, term_at(frequency, phase), false);
        tried.p_value = tried.evidence.p_value;
        test_on_held_back(fit, tried.evidence);
        all.candidates.push_back(std::move(tried));
    }
    EXPECT_LT(all.candidates[2].p_value, 1e-4);
    EXPECT_EQ(confusable_with(fit, all, 0).size(), 1U);  // the one a hundredth of a turn away, not the other sine
}

}  // namespace

}  // namespace idim::test
