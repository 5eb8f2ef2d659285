// Logs read in parts against the same logs in memory: block boundaries fall between any two samples, and the longest
// logs here hold several blocks of every stage.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "idim/fitted_rows.hpp"
#include "idim/input_error.hpp"
#include "idim/periodic.hpp"
#include "idim/streamed_identification.hpp"
#include "lag_moments.hpp"
#include "streaming/streamed_rows.hpp"
#include "support/scara_rows.hpp"
#include "support/sign.hpp"
#include "support/temporary_folder.hpp"
#include "weighted_fit.hpp"

namespace idim {
namespace {

using test::scara_truth;

const char* const arm_joints[] = {"shoulder", "elbow"};

/// The regressor of scara_rows.hpp as a model.
idim_model_interface scara_model() {
    static const char* const parameters[] = {"ZZ1R", "Fv1", "Fc1", "ZZ2R", "LMX2", "LMY2", "Fv2", "Fc2"};
    idim_model_interface model{};
    model.robot = "scara";
    model.dof = 2;
    model.n_base = 8;
    model.joint_names = arm_joints;
    model.parameter_names = parameters;
    model.regressor = [](const double* q, const double* qd, const double* qdd, double, const double*, double* W) {
        const double c = std::cos(q[1]);
        const double s = std::sin(q[1]);
        const double both = 2.0 * qdd[0] + qdd[1];
        const double centrifugal = qd[1] * (2.0 * qd[0] + qd[1]);
        const double rows[] = {qdd[0],
                               qd[0],
                               test::sign(qd[0]),
                               qdd[0] + qdd[1],
                               both * c - centrifugal * s,
                               -both * s - centrifugal * c,
                               0.0,
                               0.0,
                               0.0,
                               0.0,
                               0.0,
                               qdd[0] + qdd[1],
                               qdd[0] * c + qd[0] * qd[0] * s,
                               qd[0] * qd[0] * c - qdd[0] * s,
                               qd[1],
                               test::sign(qd[1])};
        std::copy(std::begin(rows), std::end(rows), W);
    };
    return model;
}

/// How a log of the arm is recorded.
struct recording {
    Eigen::Index samples = 0;
    double rate = 1000.0;  ///< [Hz]
    double jitter = 0.0;   ///< of the times, as a part of a period
    bool rests = false;    ///< joint 2 stands still for a second out of every seven
    double torque_noise = 0.1;
    std::uint64_t seed = 1;
};

/// Joint 2 goes to and fro, without a jump of its acceleration, and rests for one second of every seven.
test::motion motion_with_rests(double t, int joint) {
    if (joint == 0) {
        return test::multi_sine(t, joint);
    }
    const double phase = std::fmod(t, 7.0);
    if (phase < 1.0) {
        return {0.4, 0.0, 0.0};
    }
    // (1 - cos)^2 and its derivatives.
    const double w = 2.0 * std::numbers::pi / 2.0;
    const double c = std::cos(w * phase - w);
    const double s = std::sin(w * phase - w);
    return {0.4 + 0.3 * (1.0 - c) * (1.0 - c), 0.6 * w * (1.0 - c) * s, 0.6 * w * w * (s * s + (1.0 - c) * c)};
}

log recorded(const recording& how) {
    std::mt19937_64 random(how.seed);
    std::uniform_real_distribution<double> jitter(-how.jitter, how.jitter);
    log data;
    data.t = Eigen::ArrayXd::LinSpaced(how.samples, 0.0, static_cast<double>(how.samples - 1)) / how.rate;
    for (Eigen::Index k = 1; k + 1 < how.samples; ++k) {
        data.t[k] += jitter(random) / how.rate;
    }
    data.q.resize(how.samples, 2);
    data.tau.resize(how.samples, 2);
    const Eigen::VectorXd noise1 = test::ar1_noise(how.samples, 0.9, random);
    const Eigen::VectorXd noise2 = test::white_noise(how.samples, random);
    const Eigen::VectorXd q_noise = 1e-5 * test::white_noise(2 * how.samples, random);
    const idim_model_interface model = scara_model();
    for (Eigen::Index k = 0; k < how.samples; ++k) {
        Eigen::Matrix<double, 2, 8, Eigen::RowMajor> W;
        Eigen::Vector2d q;
        Eigen::Vector2d qd;
        Eigen::Vector2d qdd;
        for (int j = 0; j < 2; ++j) {
            const test::motion m = how.rests ? motion_with_rests(data.t[k], j) : test::multi_sine(data.t[k], j);
            q[j] = m.q;
            qd[j] = m.qd;
            qdd[j] = m.qdd;
        }
        model.regressor(q.data(), qd.data(), qdd.data(), 0.0, nullptr, W.data());
        data.q.row(k) = q.transpose() + q_noise.segment<2>(2 * k).transpose();
        data.tau.row(k) = (W * scara_truth()).transpose();
        data.tau(k, 0) += how.torque_noise * noise1[k];
        data.tau(k, 1) += 0.3 * how.torque_noise * (0.8 * noise2[k] + 0.6 * noise1[k]);
    }
    return data;
}

/// A log written to a file, as both ways read it.
class written_log {
  public:
    explicit written_log(const recording& how) {
        const std::string file = (folder_.path() / "log.csv").string();
        write_log(file, recorded(how));
        resident_ = read_log(file, {{"shoulder", "elbow"}, {}});
        stored_.emplace_back(file, log_columns{{"shoulder", "elbow"}, {}});
    }

    const log& resident() const { return resident_; }
    const stored_log& stored() const { return stored_.front(); }
    const std::vector<stored_log>& all_stored() const { return stored_; }

  private:
    test::temporary_folder folder_;
    log resident_;
    std::vector<stored_log> stored_;
};

filter_choice choice_of(double cutoff, int decimation, double minimum_speed = 0.01) {
    filter_choice choice;
    choice.cutoff = cutoff;
    choice.decimation = decimation;
    choice.minimum_speed = minimum_speed;
    return choice;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.size() != b.size() ? std::numeric_limits<double>::infinity()
                                : (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(Streaming, AReaderGivesTheRowsOfTheWholeInBlocksOfAnySize) {
    const test::temporary_folder folder;
    const std::string file = (folder.path() / "log.csv.gz").string();
    write_log(file, recorded({101}));
    const log whole = read_log(file, {});
    for (const Eigen::Index size : {1, 7, 101, 1000}) {
        log_reader reader(file, {});
        Eigen::Index place = 0;
        for (log block = reader.next(size); block.samples() > 0; block = reader.next(size)) {
            EXPECT_EQ(block.t, whole.t.segment(place, block.samples()));
            EXPECT_EQ(block.q, whole.q.middleRows(place, block.samples()));
            EXPECT_EQ(block.tau, whole.tau.middleRows(place, block.samples()));
            place += block.samples();
        }
        EXPECT_EQ(place, 101);
    }
}

TEST(Streaming, AReaderNamesTheLineOfAnErrorInALaterBlock) {
    const test::temporary_folder folder;
    const std::string late = folder.write("late.csv", "t,q1,tau1\n0,1,1\n1,1,1\n2,1,1\n2,1,1\n");
    log_reader reader(late, {});
    EXPECT_EQ(reader.next(3).samples(), 3);
    try {
        reader.next(3);
        FAIL() << "time that does not increase was read";
    } catch (const input_error& error) {
        EXPECT_EQ(error.where().line, 5);
        EXPECT_EQ(error.where().field, "t");
    }
}

TEST(Streaming, AStoredLogIsResampledAsInMemory) {
    // Longer than the blocks it is resampled in.
    for (const double jitter : {0.0, 0.2}) {
        const written_log log({40001, 1000.0, jitter});
        const idim::log uniform = resample_uniform(log.resident());
        ASSERT_EQ(log.stored().samples(), uniform.samples());
        for (const auto& [first, count] : {std::pair(0, 40), std::pair(16380, 9), std::pair(39990, 10)}) {
            const idim::log part = log.stored().part(first, count);
            EXPECT_EQ(part.t, uniform.t.segment(first, count));
            EXPECT_EQ(part.q, uniform.q.middleRows(first, count));
            EXPECT_EQ(part.tau, uniform.tau.middleRows(first, count));
        }
        EXPECT_NEAR(log.stored().rate() / 1000.0, 1.0, 1e-3);
    }
}

TEST(Streaming, TheFilterOfALogInMemoryAndOfAStoredOneAreChosenAlike) {
    const written_log log({70000, 1000.0});
    const filter_choice in_memory = choose_filter(std::vector<idim::log>{log.resident()}, {});
    const filter_choice in_parts = choose_filter(log.all_stored(), {});
    EXPECT_EQ(in_parts.cutoff, in_memory.cutoff);
    EXPECT_EQ(in_parts.decimation, in_memory.decimation);
    EXPECT_EQ(in_parts.reason, in_memory.reason);
}

TEST(Streaming, PartsAreFilteredAsTheWholeLog) {
    const written_log log({12000});
    for (const filter_choice& choice : {choice_of(40.0, 1), choice_of(3.0, 1), choice_of(0.0, 1)}) {
        const filtered_samples whole = filter_log(log.resident(), choice);
        const filtered_log parts(log.stored(), choice);
        ASSERT_EQ(parts.samples(), whole.samples());
        const Eigen::Index n = whole.samples();
        for (const auto& [first, count] : {std::pair<Eigen::Index, Eigen::Index>(0, 1),
                                           {0, 700},
                                           {1, 2000},
                                           {n / 2, 1},
                                           {n / 3, 997},
                                           {n - 1, 1},
                                           {n - 800, 800},
                                           {0, n}}) {
            const filtered_samples part = parts.part(first, count);
            EXPECT_EQ(part.t, whole.t.segment(first, count));
            // The filter has forgotten the ends of a part to 1e-16 of the position; its recursion rounds by the more
            // the lower the cut-off, at 3 Hz to some 1e-13; the differences take that times the rate and its square.
            EXPECT_LT((part.q - whole.q.middleRows(first, count)).cwiseAbs().maxCoeff(), 1e-12);
            EXPECT_LT((part.qd - whole.qd.middleRows(first, count)).cwiseAbs().maxCoeff(), 1e-10);
            EXPECT_LT((part.qdd - whole.qdd.middleRows(first, count)).cwiseAbs().maxCoeff(), 1e-8);
        }
    }
}

TEST(Streaming, PartsOfTheRowsAreThoseOfTheWholeLog) {
    const idim_model_interface model = scara_model();
    for (const bool rests : {false, true}) {
        const written_log log({30011, 1000.0, 0.0, rests});
        for (const int decimation : {1, 4, 25}) {
            const filter_choice choice = choice_of(40.0, decimation);
            const observation whole = observe(model, {filter_log(log.resident(), choice)}, choice);
            const observation_block& all = whole.blocks.front();
            const decimated_log parts(log.stored(), choice);
            ASSERT_EQ(parts.rows(), all.t.size());
            Eigen::Index rows = 0;
            for (Eigen::Index first = 0; first < parts.rows(); first += 331) {
                const Eigen::Index count = std::min<Eigen::Index>(331, parts.rows() - first);
                const observation_block part = parts.part(model, first, count);
                EXPECT_EQ(part.t, all.t.segment(first, count));
                for (std::size_t j = 0; j < 2; ++j) {
                    const row_part place{all, first, count};
                    const auto [from, size] = place.rows_of(j);
                    ASSERT_EQ(static_cast<Eigen::Index>(part.kept[j].size()), size);
                    for (Eigen::Index k = 0; k < size; ++k) {
                        EXPECT_EQ(part.kept[j][static_cast<std::size_t>(k)] + first,
                                  all.kept[j][static_cast<std::size_t>(from + k)]);
                    }
                    // Torques are filtered by the decimation alone, the regressor's accelerations have the error above.
                    if (size == 0) {
                        continue;
                    }
                    EXPECT_LT((part.Y[j] - all.Y[j].segment(from, size)).cwiseAbs().maxCoeff(), 1e-11);
                    EXPECT_LT((part.W[j] - all.W[j].middleRows(from, size)).cwiseAbs().maxCoeff(), 1e-8);
                    rows += size;
                }
            }
            EXPECT_EQ(rows, whole.rows());
            EXPECT_EQ(parts.kept_rows(0) + parts.kept_rows(1), whole.rows());
            // Four whole rests of joint 2 and the beginning of a fifth, less where the filter blurs their ends.
            EXPECT_TRUE(!rests || rows < 2 * parts.rows() - 3 * 1000 / decimation)
                << rows << " of " << 2 * parts.rows();
        }
    }
}

/// Burg's recursion as it is published: prediction errors of every order, over runs without a gap.
Eigen::VectorXd lattice_autocovariance(const gapped_series& series, Eigen::Index lags) {
    Eigen::VectorXd f = series.value;
    Eigen::VectorXd b = series.value;
    const Eigen::Index n = f.size();
    Eigen::VectorXi run = Eigen::VectorXi::Zero(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        run[k] = series.present[k] > 0.0 ? (k > 0 ? run[k - 1] : 0) + 1 : 0;
    }
    Eigen::VectorXd gamma = Eigen::VectorXd::Zero(lags + 1);
    gamma[0] = series.value.squaredNorm() / series.present.sum();
    Eigen::VectorXd a = Eigen::VectorXd::Zero(lags + 1);
    double v = gamma[0];
    for (Eigen::Index p = 1; p <= lags; ++p) {
        double product = 0.0;
        double power = 0.0;
        for (Eigen::Index k = p; k < n; ++k) {
            if (run[k] > p) {
                product += f[k] * b[k - 1];
                power += f[k] * f[k] + b[k - 1] * b[k - 1];
            }
        }
        const double reflection = 2.0 * product / power;
        for (Eigen::Index k = n - 1; k >= p; --k) {
            const double forward = f[k];
            f[k] -= reflection * b[k - 1];
            b[k] = b[k - 1] - reflection * forward;
        }
        gamma[p] = reflection * v;
        for (Eigen::Index i = 1; i < p; ++i) {
            gamma[p] += a[i] * gamma[p - i];
        }
        Eigen::VectorXd next = a;
        for (Eigen::Index i = 1; i < p; ++i) {
            next[i] = a[i] - reflection * a[p - i];
        }
        next[p] = reflection;
        a = next;
        v *= 1.0 - reflection * reflection;
    }
    return gamma;
}

TEST(Streaming, LagMomentsOfPiecesGiveBurgsRecursionOverTheWhole) {
    std::mt19937_64 random(7);
    constexpr Eigen::Index lags = 30;
    // The smooth noise of decimated rows, whose spectrum spans eight decades.
    gapped_series series = complete_series(test::decimated_noise(3000, random));
    for (const bool gaps : {false, true}) {
        for (Eigen::Index k = 0; gaps && k < 3000; ++k) {
            if (k % 251 < 13 || k % 97 == 5) {
                series.value[k] = series.present[k] = 0.0;
            }
        }
        const Eigen::VectorXd expected = lattice_autocovariance(series, lags);
        for (const Eigen::Index size : {1, 29, 31, 640, 3000}) {
            lag_moments moments(lags);
            moments.begin_segment();
            for (Eigen::Index first = 0; first < 3000; first += size) {
                const Eigen::Index count = std::min<Eigen::Index>(size, 3000 - first);
                moments.add({series.value.segment(first, count), series.present.segment(first, count)});
            }
            // The oracle's own rounding, doubles over 30 orders.
            EXPECT_LT((moments.autocovariance() - expected).cwiseAbs().maxCoeff(), 1e-11 * expected[0]);
            EXPECT_EQ(moments.samples(), static_cast<Eigen::Index>(series.present.sum()));
            for (Eigen::Index l = 0; l <= lags; ++l) {
                EXPECT_EQ(moments.pairs()[l], series.present.head(3000 - l).dot(series.present.tail(3000 - l)));
            }
        }
    }
}

/// Both ways to the result.
struct both_ways {
    estimate in_memory;
    essential_parameters essential;
    std::vector<residual_test> residual;
    streamed_identification in_parts;
};

both_ways identified(const std::vector<recording>& logs, const filter_choice& choice, least_squares_method method) {
    const test::temporary_folder folder;
    std::vector<filtered_samples> samples;
    std::vector<stored_log> stored;
    for (std::size_t i = 0; i < logs.size(); ++i) {
        const std::string file = (folder.path() / (std::to_string(i) + ".csv")).string();
        write_log(file, recorded(logs[i]));
        samples.push_back(filter_log(read_log(file, {}), choice));
        stored.emplace_back(file, log_columns{});
    }
    const idim_model_interface model = scara_model();
    const observation rows = observe(model, samples, choice);
    both_ways result;
    result.in_memory = least_squares(rows, method);
    result.essential = find_essential(rows, result.in_memory);
    result.residual = test_residual(rows, result.in_memory);
    result.in_parts = identify_streamed(model, stored, choice, method);
    return result;
}

void expect_same_essential(const both_ways& result) {
    EXPECT_EQ(result.in_parts.essential.kept, result.essential.kept);
    EXPECT_LT(difference(result.in_parts.essential.chi, result.essential.chi), 1e-10);
    EXPECT_LT(difference(result.in_parts.essential.std, result.essential.std), 1e-6);
}

void expect_same(const both_ways& result) {
    const estimate& a = result.in_memory;
    const estimate& b = result.in_parts.fit;
    ASSERT_EQ(b.chi.size(), a.chi.size());
    EXPECT_EQ(b.samples, a.samples);
    // Rows agree to 1e-8 of an acceleration (above), by errors of no order that the fit averages.
    EXPECT_LT(difference(b.chi, a.chi), 1e-10);
    // Correlations are cut at 1e-12, and a model of high order takes differences of its autocovariances.
    EXPECT_LT(((b.deviations() - a.deviations()).array() / a.deviations().array()).abs().maxCoeff(), 1e-6);
    EXPECT_LT(difference(b.std_white, a.std_white), 1e-8);
    EXPECT_NEAR(b.residual.relative_error, a.residual.relative_error, 1e-10);
    EXPECT_NEAR(b.condition_number / a.condition_number, 1.0, 1e-7);
    for (std::size_t j = 0; j < 2; ++j) {
        EXPECT_NEAR(b.residual.joints[j].rms, a.residual.joints[j].rms, 1e-10);
        EXPECT_NEAR(b.joint_deviation[j], a.joint_deviation[j], 1e-10);
        EXPECT_NEAR(b.correlation_length[j] / a.correlation_length[j], 1.0, 1e-5);
        const residual_test& in_memory = result.residual[j];
        const residual_test& in_parts = result.in_parts.residual[j];
        EXPECT_NEAR(in_parts.lag_one, in_memory.lag_one, 1e-8);
        EXPECT_EQ(in_parts.thinned_rows, in_memory.thinned_rows);
        EXPECT_NEAR(in_parts.skewness, in_memory.skewness, 1e-6);
        EXPECT_NEAR(in_parts.excess_kurtosis, in_memory.excess_kurtosis, 1e-6);
    }
    expect_same_essential(result);
}

TEST(Streaming, WeightedLeastSquaresOfManyPartsIsThatInMemory) {
    // 40 000 rows of a joint: five parts, boundaries inside the motion.
    expect_same(identified({{40000}}, choice_of(40.0, 1), least_squares_method::wls));
}

TEST(Streaming, OrdinaryLeastSquaresIsThatInMemory) {
    expect_same(identified({{20000}}, choice_of(40.0, 1), least_squares_method::ols));
}

TEST(Streaming, DecimatedRowsGiveTheResultInMemory) {
    expect_same(identified({{120007}}, choice_of(40.0, 7), least_squares_method::wls));
}

TEST(Streaming, RestsGiveTheResultInMemory) {
    expect_same(identified({{40000, 1000.0, 0.0, true}}, choice_of(40.0, 2), least_squares_method::wls));
}

TEST(Streaming, SeveralLogsOfUnevenTimesGiveTheResultInMemory) {
    // One of them ends a row behind a part, one within the reach of its filters.
    expect_same(identified({{8192 + 201, 1000.0, 0.0, false, 0.1, 1},
                            {17001, 1000.0, 0.1, true, 0.1, 2},
                            {900, 1000.0, 0.0, false, 0.1, 3}},
                           choice_of(50.0, 1), least_squares_method::wls));
}

TEST(Streaming, FindsTheTruthWithinItsDeviations) {
    // Torque noise above what filtering the jumps of friction leaves, and a band in which the noise of the position
    // makes no accelerations to speak of: neither error is known to the deviations.
    const both_ways result =
        identified({{100000, 1000.0, 0.0, false, 5.0}}, choice_of(10.0, 20), least_squares_method::wls);
    const Eigen::VectorXd error = result.in_parts.fit.chi - scara_truth();
    // Eight parameters: none beyond four deviations but once in 2000 draws.
    EXPECT_LT((error.array() / result.in_parts.fit.deviations().array()).abs().maxCoeff(), 4.0);
}

TEST(Streaming, PeriodsAreFoundAndAveragedAsInMemory) {
    const test::temporary_folder folder;
    const std::string file = (folder.path() / "log.csv").string();
    log data = recorded({50123});
    // Six periods of 8 s behind a transient, in the arm's positions and torques.
    for (Eigen::Index k = 9000; k < data.samples(); ++k) {
        data.q.row(k) = data.q.row(k - 8000) + 1e-5 * Eigen::RowVector2d(std::sin(0.37 * static_cast<double>(k)),
                                                                         std::cos(0.59 * static_cast<double>(k)));
        data.tau.row(k) = data.tau.row(k - 8000) + 1e-2 * Eigen::RowVector2d(std::sin(0.7 * static_cast<double>(k)),
                                                                             std::cos(0.9 * static_cast<double>(k)));
    }
    write_log(file, data);
    const filter_choice choice = choice_of(40.0, 3);
    const filtered_samples samples = filter_log(data, choice);
    const stored_log stored(file, {});
    const auto motion = filter_log(stored, choice);
    for (const std::optional<double> given : {std::optional<double>(), std::optional<double>(8.0)}) {
        const period_search in_memory = find_period(samples, given);
        const period_search in_parts = find_period(*motion, given);
        ASSERT_TRUE(in_memory.part && in_parts.part) << in_memory.obstacle << in_parts.obstacle;
        EXPECT_EQ(in_parts.part->period, 8000);
        EXPECT_EQ(in_parts.part->period, in_memory.part->period);
        EXPECT_EQ(in_parts.part->periods, in_memory.part->periods);
        EXPECT_EQ(in_parts.part->first, in_memory.part->first);
        EXPECT_EQ(in_parts.part->after, in_memory.part->after);
        EXPECT_NEAR(in_parts.part->mismatch, in_memory.part->mismatch, 1e-12);
        const filtered_samples mean = average_periods(samples, *in_memory.part, choice);
        const filtered_samples mean_of_parts = average_periods(*motion, *in_parts.part, choice);
        EXPECT_LT(difference(mean_of_parts.q, mean.q), 1e-13);
        EXPECT_LT(difference(mean_of_parts.qdd, mean.qdd), 1e-8);
        EXPECT_LT(difference(mean_of_parts.tau, mean.tau), 1e-13);
        // The average by its definition, at a sample in the middle of the second block of a period.
        const Eigen::Index k = 6789;
        double sum = 0.0;
        for (Eigen::Index p = 0; p < in_parts.part->periods; ++p) {
            sum += samples.tau(in_parts.part->first + p * 8000 + k, 1);
        }
        const Eigen::Index margin = (mean.samples() - 8000) / 2;
        EXPECT_NEAR(mean_of_parts.tau(margin + k, 1), sum / static_cast<double>(in_parts.part->periods), 1e-13);
        const torque_scatter scatter = scatter_of(samples, *in_memory.part, choice);
        const torque_scatter scatter_of_parts = scatter_of(*motion, *in_parts.part, choice);
        EXPECT_LT(difference(scatter_of_parts.rms, scatter.rms), 1e-12);
        EXPECT_NEAR(scatter_of_parts.pooled_share, scatter.pooled_share, 1e-10);
    }
}

TEST(Streaming, RefusesAModelThatNeedsTheLogAsAWhole) {
    const written_log log({2000});
    idim_model_interface model = scara_model();
    const double delays[] = {0.0, 0.002};
    model.torque_delay = delays;
    EXPECT_EQ(whole_log_need(model), "delays of the torque");
    try {
        identify_streamed(model, log.all_stored(), choice_of(40.0, 1), least_squares_method::wls);
        FAIL() << "a delay was streamed";
    } catch (const input_error& error) {
        EXPECT_NE(std::string(error.what()).find("delays of the torque"), std::string::npos) << error.what();
    }
}

TEST(Streaming, SaysWhatIsNotExcited) {
    const test::temporary_folder folder;
    const std::string file = (folder.path() / "log.csv").string();
    log data = recorded({20000});
    data.q.col(1).setConstant(0.3);
    write_log(file, data);
    std::vector<stored_log> stored;
    stored.emplace_back(file, log_columns{});
    const streamed_identification found =
        identify_streamed(scara_model(), stored, choice_of(40.0, 1), least_squares_method::wls);
    EXPECT_EQ(found.fit.chi.size(), 0);
    EXPECT_FALSE(found.fit.not_excited.empty());
    EXPECT_TRUE(found.residual.empty());
}

}  // namespace
}  // namespace idim
