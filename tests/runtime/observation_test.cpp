#include "idim/observation.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "../support/shared_data.hpp"
#include "idim/input_error.hpp"
#include "idim/zero_phase_filter.hpp"

namespace idim {
namespace {

using test_support::shared_data;

const char* const slide_and_wrist[] = {"slide", "wrist"};

/// One mass with friction: tau = M qdd + Fv qd + Fc sign(qd) + off.
idim_model_interface mass_model() {
    static const char* const parameters[] = {"M", "Fv", "Fc", "off"};
    idim_model_interface model{};
    model.robot = "mass";
    model.dof = 1;
    model.n_base = 4;
    model.joint_names = slide_and_wrist;
    model.parameter_names = parameters;
    model.regressor = [](const double*, const double* qd, const double* qdd, double, const double*, double* W) {
        W[0] = qdd[0];
        W[1] = qd[0];
        W[2] = static_cast<double>((qd[0] > 0.0) - (qd[0] < 0.0));
        W[3] = 1.0;
    };
    return model;
}

/// Two joints that share the second parameter; time and temperature enter. The first column is zero at the second
/// joint.
idim_model_interface two_joint_model() {
    static const char* const parameters[] = {"a", "b", "c"};
    idim_model_interface model{};
    model.robot = "pair";
    model.dof = 2;
    model.n_base = 3;
    model.needs_time = 1;
    model.needs_temperature = 1;
    model.joint_names = slide_and_wrist;
    model.parameter_names = parameters;
    model.regressor = [](const double* q, const double* qd, const double* qdd, double t, const double* temp,
                         double* W) {
        W[0] = qdd[0];
        W[1] = qd[1] * qd[1];
        W[2] = q[0] * t;
        W[3] = 0.0;
        W[4] = qdd[1];
        W[5] = temp[1];
    };
    return model;
}

filtered_samples two_joint_samples(Eigen::Index n, double rate) {
    filtered_samples samples;
    samples.file = "a.csv";
    samples.rate = rate;
    samples.t = Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) / rate;
    std::mt19937 random(23);
    std::normal_distribution<double> normal;
    for (const auto signal : {&filtered_samples::q, &filtered_samples::qd, &filtered_samples::qdd,
                              &filtered_samples::tau, &filtered_samples::temp}) {
        samples.*signal = Eigen::MatrixXd::NullaryExpr(n, 2, [&]() { return normal(random); });
    }
    return samples;
}

TEST(Observation, WithoutDecimationRowsAreTheRegressor) {
    const filtered_samples samples = two_joint_samples(40, 100.0);
    const observation rows = observe(two_joint_model(), {samples}, {10.0, 4, 1, ""});
    const observation_block& block = rows.blocks.at(0);
    EXPECT_EQ(rows.dof, 2);
    EXPECT_EQ(rows.n_base, 3);
    EXPECT_EQ(block.t, samples.t);
    EXPECT_EQ(block.rate, 100.0);
    EXPECT_EQ(block.W[0].col(0), samples.qdd.col(0));
    EXPECT_EQ(block.W[0].col(1), samples.qd.col(1).cwiseAbs2());
    EXPECT_EQ(block.W[0].col(2), samples.q.col(0).cwiseProduct(samples.t));
    EXPECT_EQ(block.W[1].col(1), samples.qdd.col(1));
    EXPECT_EQ(block.W[1].col(2), samples.temp.col(1));
    EXPECT_EQ(block.Y[1], samples.tau.col(1));
}

TEST(Observation, EveryColumnAndTheTorquePassTheSameDecimation) {
    const filtered_samples samples = two_joint_samples(500, 100.0);
    const observation_block block = observe(two_joint_model(), {samples}, {10.0, 4, 7, ""}).blocks.at(0);
    EXPECT_DOUBLE_EQ(block.rate, 100.0 / 7.0);
    ASSERT_EQ(block.t.size(), 72);
    EXPECT_EQ(block.t[71], samples.t[497]);
    EXPECT_EQ(block.W[0].col(1), decimate(samples.qd.col(1).cwiseAbs2(), 7));
    EXPECT_EQ(block.W[1].col(2), decimate(samples.temp.col(1), 7));
    EXPECT_EQ(block.Y[0], decimate(samples.tau.col(0), 7));
    EXPECT_TRUE((block.W[1].col(0).array() == 0.0).all()) << "a column that is zero stays exactly zero";
}

TEST(Observation, DecimationKeepsTheModelExactUpToTheEnds) {
    filtered_samples samples = two_joint_samples(1000, 100.0);
    const Eigen::Vector3d chi(2.0, -0.5, 3.0);
    const observation_block full = observe(two_joint_model(), {samples}, {10.0, 4, 1, ""}).blocks.at(0);
    samples.tau.col(0) = full.W[0] * chi;
    samples.tau.col(1) = full.W[1] * chi;
    for (const int decimation : {2, 10, 30}) {
        const observation_block block = observe(two_joint_model(), {samples}, {10.0, 4, decimation, ""}).blocks.at(0);
        for (int joint = 0; joint < 2; ++joint) {
            // The filter is linear in the signal; torques reach 100, rounding grows with the narrow band.
            EXPECT_LT((block.Y[joint] - block.W[joint] * chi).cwiseAbs().maxCoeff(), 1e-9) << decimation;
        }
    }
}

TEST(Observation, RowsAreCountedOverLogsAndJoints) {
    const std::vector<filtered_samples> logs = {two_joint_samples(100, 100.0), two_joint_samples(205, 101.0)};
    const observation rows = observe(two_joint_model(), logs, {10.0, 4, 10, ""});
    EXPECT_EQ(rows.blocks.size(), 2u);
    EXPECT_EQ(rows.rows(0), 10 + 21);
    EXPECT_EQ(rows.rows(), 2 * 31);
}

TEST(Observation, LogWithoutTorqueLeavesYEmpty) {
    filtered_samples samples = two_joint_samples(100, 100.0);
    samples.tau.resize(0, 0);
    const observation_block block = observe(two_joint_model(), {samples}, {10.0, 4, 10, ""}).blocks.at(0);
    EXPECT_EQ(block.W[1].rows(), 10);
    EXPECT_EQ(block.Y[1].size(), 0);
}

TEST(Observation, RegressorLargerThanTheMemoryKeptIsTheSame) {
    // 1200 samples x 15000 columns x 2 joints are 288 MB at the full rate, more than is held at once.
    static constexpr int columns = 15000;
    idim_model_interface model{};
    model.robot = "wide";
    model.dof = 2;
    model.n_base = columns;
    model.joint_names = slide_and_wrist;
    model.regressor = [](const double* q, const double* qd, const double*, double, const double*, double* W) {
        W[7] = q[0];
        W[columns + 9] = qd[1];
    };
    const filtered_samples samples = two_joint_samples(1200, 100.0);
    const observation_block block = observe(model, {samples}, {10.0, 4, 10, ""}).blocks.at(0);
    EXPECT_EQ(block.W[0].col(7), decimate(samples.q.col(0), 10));
    EXPECT_EQ(block.W[1].col(9), decimate(samples.qd.col(1), 10));
}

TEST(Observation, RowsOfTheBatchFormAreThoseOfOneSampleAtATime) {
    const filtered_samples samples = two_joint_samples(333, 100.0);  // no multiple of what is evaluated at once
    const observation_block expected = observe(two_joint_model(), {samples}, {10.0, 4, 10, ""}).blocks.at(0);
    idim_model_interface model = two_joint_model();
    model.regressor_batch = [](const idim_samples* all, double* W, size_t W_stride) {
        const size_t n = all->stride;
        for (size_t k = 0; k < all->count; ++k) {
            const double q[] = {all->q[k], all->q[n + k]}, qd[] = {all->qd[k], all->qd[n + k]};
            const double qdd[] = {all->qdd[k], all->qdd[n + k]}, temp[] = {all->temp[k], all->temp[n + k]};
            double row[6];
            two_joint_model().regressor(q, qd, qdd, all->t[k], temp, row);
            for (size_t i = 0; i < 6; ++i) {
                W[i * W_stride + k] = row[i];
            }
        }
    };
    model.regressor = nullptr;
    const observation_block block = observe(model, {samples}, {10.0, 4, 10, ""}).blocks.at(0);
    EXPECT_EQ(block.W[0], expected.W[0]);
    EXPECT_EQ(block.W[1], expected.W[1]);
}

template <class Exception>
std::string error_of_observing(const idim_model_interface& model, const std::vector<filtered_samples>& logs,
                               int decimation) {
    try {
        observe(model, logs, {10.0, 4, decimation, ""});
    } catch (const Exception& caught) {
        return caught.what();
    }
    return "no such error";
}

TEST(Observation, LogsThatDoNotFitAreInputErrors) {
    const filtered_samples samples = two_joint_samples(100, 100.0);
    filtered_samples other = two_joint_samples(100, 200.0);
    other.file = "b.csv";
    EXPECT_EQ(error_of_observing<input_error>(two_joint_model(), {samples, other}, 1),
              "b.csv: t: sampled at 200 Hz, but a.csv at 100 Hz; logs used together need one rate");
    EXPECT_EQ(error_of_observing<input_error>(mass_model(), {samples}, 1),
              "a.csv: has 2 joints, the model of mass has 1");
    filtered_samples cold = samples;
    cold.temp.resize(0, 0);
    EXPECT_EQ(error_of_observing<input_error>(two_joint_model(), {cold}, 1),
              "a.csv: temp1: this column is missing, the model of pair depends on the temperature");
    EXPECT_EQ(error_of_observing<input_error>(two_joint_model(), {two_joint_samples(27, 100.0)}, 2),
              "a.csv: 27 samples are left by the filter, the decimation needs at least 28");
}

TEST(Observation, RegressorThatIsNotFiniteIsADataError) {
    filtered_samples samples = two_joint_samples(100, 100.0);
    samples.temp(50, 1) = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error_of_observing<data_error>(two_joint_model(), {samples}, 10),
              "a.csv: the regressor of parameter c at joint wrist is inf at t = 0.5 s");
}

Eigen::VectorXd ordinary_least_squares(const observation& rows) {
    return rows.blocks.at(0).W[0].colPivHouseholderQr().solve(rows.blocks.at(0).Y[0]);
}

TEST(Observation, KnownMassIsFoundThroughTheChosenFilter) {
    // 200 Hz like the robot of [IV 4], position noise 1e-4 rad, torque noise 5 % of the torque.
    const Eigen::Vector4d truth(3.44, 0.5, 0.82, -0.3);
    std::mt19937 random(29);
    std::normal_distribution<double> normal;
    log data;
    data.file = "mass.csv";
    data.t = Eigen::ArrayXd::LinSpaced(8001, 0.0, 40.0);
    Eigen::ArrayXXd motion = Eigen::ArrayXXd::Zero(data.t.size(), 3);  // q qd qdd
    for (const double f : {0.1, 0.25, 0.6, 1.1}) {
        const double w = 2.0 * std::numbers::pi * f;
        const Eigen::ArrayXd phase = w * data.t.array() + 3.0 * f;
        motion.col(0) += phase.sin() / w;
        motion.col(1) += phase.cos();
        motion.col(2) -= w * phase.sin();
    }
    data.q = motion.col(0).unaryExpr([&](double x) { return x + 1e-4 * normal(random); }).matrix();
    const Eigen::VectorXd tau =
        truth[0] * motion.col(2) + truth[1] * motion.col(1) + truth[2] * motion.col(1).sign() + truth[3];
    const double noise = 0.05 * std::sqrt(tau.squaredNorm() / static_cast<double>(tau.size()));
    data.tau = tau.unaryExpr([&](double x) { return x + noise * normal(random); });

    const filter_choice choice = choose_filter({data}, {});
    const observation rows = observe(mass_model(), {filter_log(data, choice)}, choice);
    const Eigen::MatrixXd& W = rows.blocks[0].W[0];
    const Eigen::Vector4d chi = ordinary_least_squares(rows);
    // The decimation leaves band / (rate / 2) of the white torque noise; four deviations [IV 17-18], and 0.5 % for the
    // sign of the velocity near its reversals.
    const double kept = noise * std::sqrt(choice.band(200.0) / 100.0);
    const Eigen::Vector4d deviation = kept * (W.transpose() * W).inverse().diagonal().cwiseSqrt();
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(chi[k], truth[k], 4.0 * deviation[k] + 0.005 * std::abs(truth[k]))
            << "parameter " << k << ", " << choice.reason;
    }
}

/// Parameters that the authors of EMPS published for this record, as data/emps/README.md reproduces them.
const Eigen::Vector4d emps_published(95.11, 203.4, 20.41, -3.17);

void expect_emps(const observation& rows, double tolerance) {
    const Eigen::Vector4d chi = ordinary_least_squares(rows);
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(chi[k], emps_published[k], tolerance * std::abs(emps_published[k])) << "parameter " << k;
    }
}

TEST(Observation, PublishedFilterGivesThePublishedEmpsParameters) {
    const auto file = shared_data("emps/ident.csv.gz");
    if (!file) {
        GTEST_SKIP() << "emps/ident.csv.gz is not there; set IDIM_DATA";
    }
    const filter_choice choice{100.0, 4, 10, ""};
    const observation rows = observe(mass_model(), {filter_log(read_log(file->string(), {}), choice)}, choice);
    expect_emps(rows, 0.002);
    const observation_block& block = rows.blocks.at(0);
    const double error = (block.Y[0] - block.W[0] * ordinary_least_squares(rows)).norm() / block.Y[0].norm();
    EXPECT_GT(error, 0.0400);  // 4.04 % in the README
    EXPECT_LT(error, 0.0410);
}

TEST(Observation, ChosenFilterGivesThePublishedEmpsParameters) {
    const auto file = shared_data("emps/ident.csv.gz");
    if (!file) {
        GTEST_SKIP() << "emps/ident.csv.gz is not there; set IDIM_DATA";
    }
    const log data = read_log(file->string(), {});
    const filter_choice choice = choose_filter({data}, {});
    expect_emps(observe(mass_model(), {filter_log(data, choice)}, choice), 0.005);
}

}  // namespace
}  // namespace idim
