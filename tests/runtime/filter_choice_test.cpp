#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <string>

#include "../support/shared_data.hpp"
#include "idim/filtered_samples.hpp"
#include "idim/input_error.hpp"

namespace idim {
namespace {

using test_support::shared_data;

/// Two joints moving with sinusoids up to 1.5 Hz, sampled at 200 Hz, white noise on the position; a torque like an
/// inertia's.
log sinusoids(double noise, double samples = 4000) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    log data;
    data.file = "sinusoids.csv";
    data.t = Eigen::ArrayXd::LinSpaced(static_cast<Eigen::Index>(samples), 0, samples - 1) / 200.0;
    data.q.resize(data.t.size(), 2);
    data.tau.resize(data.t.size(), 2);
    for (int joint = 0; joint < 2; ++joint) {
        Eigen::ArrayXd q = Eigen::ArrayXd::Zero(data.t.size());
        Eigen::ArrayXd qdd = q;
        for (const double f : {0.3, 0.7, 1.5}) {
            const double w = 2.0 * std::numbers::pi * (f - 0.1 * joint);
            q += (w * data.t.array() + f).sin();
            qdd -= w * w * (w * data.t.array() + f).sin();
        }
        data.q.col(joint) = q.unaryExpr([&](double x) { return x + noise * normal(random); });
        data.tau.col(joint) = 2.0 * qdd;
    }
    return data;
}

TEST(FilterChoice, BandHoldsTheMotionAndTheCutoffLiesAboveIt) {
    for (const double noise : {1e-6, 1e-5, 1e-4, 1e-3}) {
        const filter_choice choice = choose_filter({sinusoids(noise)}, {});
        EXPECT_EQ(choice.order, 4);
        EXPECT_GE(choice.band(200.0), 1.5) << noise;
        EXPECT_LE(choice.band(200.0), 6.0) << noise;
        EXPECT_NEAR(choice.cutoff / choice.band(200.0), 4.22, 0.25)
            << "two digits of the cut-off, floor of the decimation";
        EXPECT_NE(choice.reason.find("sinks into its noise"), std::string::npos) << choice.reason;
    }
}

TEST(FilterChoice, MoreNoiseNeverWidensTheBand) {
    double before = 200.0;
    for (const double noise : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
        const double cutoff = choose_filter({sinusoids(noise)}, {}).cutoff;
        EXPECT_LE(cutoff, before) << noise;
        before = cutoff;
    }
}

TEST(FilterChoice, ScalesWithTime) {
    const log slow = sinusoids(1e-4);
    log fast = slow;
    fast.t /= 10.0;
    const filter_choice slow_choice = choose_filter({slow}, {});
    const filter_choice fast_choice = choose_filter({fast}, {});
    EXPECT_NEAR(fast_choice.cutoff, 10.0 * slow_choice.cutoff, 1e-9 * fast_choice.cutoff);
    EXPECT_EQ(fast_choice.decimation, slow_choice.decimation);
}

TEST(FilterChoice, DoesNotDependOnTheUnits) {
    const log data = sinusoids(1e-4);
    log scaled = data;
    scaled.q.col(0) *= 8.0;
    scaled.q.col(1) *= 0.125;
    scaled.tau *= 1024.0;
    EXPECT_EQ(choose_filter({scaled}, {}).cutoff, choose_filter({data}, {}).cutoff);
}

TEST(FilterChoice, JointAtRestHasNoSay) {
    const log data = sinusoids(1e-4);
    log with_rest = data;
    with_rest.q.conservativeResize(Eigen::NoChange, 4);
    with_rest.tau.conservativeResize(Eigen::NoChange, 4);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (Eigen::Index k = 0; k < data.samples(); ++k) {
        with_rest.q(k, 2) = 1e-3 * normal(random);  // held, noise alone
    }
    with_rest.q.col(3).setConstant(0.5);
    with_rest.tau.rightCols(2).setZero();
    EXPECT_EQ(choose_filter({with_rest}, {}).cutoff, choose_filter({data}, {}).cutoff);
}

TEST(FilterChoice, WithoutNoiseFloorItSaysSoAndStaysADecadeAboveTheMotion) {
    // Acceleration: white noise through one pole at 1.6 Hz of 1000 Hz. Its spectrum falls up to the Nyquist frequency.
    std::mt19937 random(13);
    std::normal_distribution<double> normal;
    log data;
    data.file = "a.csv";
    const Eigen::Index n = 20000;
    data.t = Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) / 1000.0;
    data.q.resize(n, 1);
    double q = 0.0;
    double qd = 0.0;
    double qdd = 0.0;
    for (Eigen::Index k = 0; k < n; ++k) {
        qdd += -0.01 * qdd + normal(random);
        qd += 1e-3 * qdd;
        q += 1e-3 * qd;
        data.q(k, 0) = q;
    }
    const filter_choice choice = choose_filter({data}, {});
    EXPECT_NE(choice.reason.find("no noise floor is seen"), std::string::npos) << choice.reason;
    EXPECT_GT(choice.cutoff, 16.0);
    EXPECT_LE(choice.cutoff, 400.0);
}

TEST(FilterChoice, WhatIsGivenIsKeptAndNamed) {
    const std::vector<log> logs = {sinusoids(1e-4)};
    const filter_choice all = choose_filter(logs, {20.0, 2, 20, 0.025});
    EXPECT_EQ(all.cutoff, 20.0);
    EXPECT_EQ(all.order, 2);
    EXPECT_EQ(all.decimation, 20);
    EXPECT_EQ(all.reason,
              "Butterworth order 2 given; cut-off 20 Hz given; decimation 20 given: the rows keep 0 to 4 Hz; rests "
              "(below 2.5 % of a joint's top speed) left out");
    EXPECT_EQ(all.minimum_speed, 0.025);

    const filter_choice decimation = choose_filter(logs, {{}, {}, 7});
    EXPECT_EQ(decimation.decimation, 7);
    EXPECT_EQ(decimation.cutoff, choose_filter(logs, {}).cutoff);
}

TEST(FilterChoice, RestsAreLeftOutUnlessTheUserSaysOtherwise) {
    const filter_choice usual = choose_filter({sinusoids(1e-4)}, {});
    EXPECT_EQ(usual.minimum_speed, 0.01);
    EXPECT_NE(usual.reason.find("rests (below 1 % of a joint's top speed) left out"), std::string::npos);
    const filter_choice all = choose_filter({sinusoids(1e-4)}, {{}, {}, {}, 0.0});
    EXPECT_EQ(all.minimum_speed, 0.0);
    EXPECT_NE(all.reason.find("rows kept at any speed"), std::string::npos);
}

TEST(FilterChoice, DecimationFollowsFromAGivenCutoff) {
    // |H|^2 = 1 / (1 + (f / 20)^8) loses 1e-5 at f = 20 / 4.217 Hz, and 0.8 * 200 / 2 / 4.743 = 16.9.
    EXPECT_EQ(choose_filter({sinusoids(1e-4)}, {20.0, {}, {}}).decimation, 16);
    EXPECT_EQ(choose_filter({sinusoids(1e-4)}, {90.0, 12, {}}).decimation, 1);
}

TEST(FilterChoice, BandIsFourFifthsOfTheNewNyquistFrequency) {
    EXPECT_DOUBLE_EQ((filter_choice{100.0, 4, 10, ""}.band(1000.0)), 40.0);  // METHODS.md, IDIM-LS 3
    EXPECT_DOUBLE_EQ((filter_choice{20.0, 4, 20, ""}.band(200.0)), 4.0);     // [IV 4.2]
}

std::string error_of_choosing(const std::vector<log>& logs, const filter_request& request) {
    try {
        choose_filter(logs, request);
    } catch (const input_error& caught) {
        return caught.what();
    }
    return "no error";
}

TEST(FilterChoice, WrongRequestsAreInputErrors) {
    const std::vector<log> logs = {sinusoids(1e-4)};
    EXPECT_EQ(error_of_choosing(logs, {100.0, {}, {}}),
              "cutoff: 100 Hz is neither 0 (no filter) nor between 0 and half the sampling rate, 100 Hz");
    EXPECT_EQ(error_of_choosing(logs, {-1.0, {}, {}}),
              "cutoff: -1 Hz is neither 0 (no filter) nor between 0 and half the sampling rate, 100 Hz");
    EXPECT_EQ(error_of_choosing(logs, {{}, 13, {}}), "order: 13 is not in 1..12");
    EXPECT_EQ(error_of_choosing(logs, {{}, {}, 0}), "decimation: 0 is not a positive number");
    EXPECT_EQ(error_of_choosing(logs, {{}, {}, {}, 1.0}),
              "minimum_speed: 1 is not a part of the top speed from 0 to below 1");
    EXPECT_EQ(error_of_choosing(logs, {{}, {}, {}, -0.1}),
              "minimum_speed: -0.1 is not a part of the top speed from 0 to below 1");
    EXPECT_EQ(error_of_choosing({}, {}), "no log was given");
}

TEST(FilterChoice, LogsThatCannotDecideAreInputErrors) {
    EXPECT_EQ(error_of_choosing({sinusoids(1e-4, 50)}, {}),
              "sinusoids.csv: 50 samples, choosing the filter from the data needs at least 64; give "
              "the cut-off and the decimation");
    log rest = sinusoids(1e-4);
    rest.q.setConstant(1.0);
    EXPECT_EQ(error_of_choosing({rest}, {}),
              "sinusoids.csv: q1: no joint moves, nothing can be identified from this log");
    log faster = sinusoids(1e-4);
    faster.file = "faster.csv";
    faster.t *= 0.5;
    EXPECT_EQ(error_of_choosing({sinusoids(1e-4), faster}, {}),
              "faster.csv: t: sampled at 400 Hz, but sinusoids.csv at 200 Hz; logs used together need one rate");
}

/// A measured record and where its published or checked cut-off (its README, METHODS.md) puts the choice, within a
/// factor of two.
struct measured_case {
    const char* file;
    double cutoff;
};

void PrintTo(const measured_case& record, std::ostream* out) {
    *out << record.file;
}

class MeasuredFilterChoice : public testing::TestWithParam<measured_case> {};

TEST_P(MeasuredFilterChoice, IsWithinAFactorOfTwoOfThePublishedCutoff) {
    const auto file = shared_data(GetParam().file);
    if (!file) {
        GTEST_SKIP() << GetParam().file << " is not there; set IDIM_DATA";
    }
    const filter_choice choice = choose_filter({read_log(file->string(), {})}, {});
    EXPECT_GT(choice.cutoff, 0.5 * GetParam().cutoff) << choice.reason;
    EXPECT_LT(choice.cutoff, 2.0 * GetParam().cutoff) << choice.reason;
}

INSTANTIATE_TEST_SUITE_P(
    Records, MeasuredFilterChoice,
    testing::Values(measured_case{"emps/ident.csv.gz", 100.0}, measured_case{"panda/ident.csv.gz", 10.0},
                    measured_case{"panda/valid.csv.gz", 10.0}, measured_case{"tx40/ident.csv.gz", 100.0},
                    measured_case{"xmate7p/ident_t1.csv.gz", 4.0}, measured_case{"tiago/full.csv.gz", 4.0}));

}  // namespace
}  // namespace idim
