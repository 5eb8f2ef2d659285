// The generated headers over scalar types of several libraries: nothing but argument-dependent lookup finds their
// functions.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <experimental/simd>
#include <limits>
#include <random>
#include <unsupported/Eigen/AutoDiff>
#include <vector>
#include <xsimd/xsimd.hpp>

#include "effects_arm/inverse_dynamics.hpp"
#include "effects_arm/inverse_dynamics_derivatives.hpp"
#include "effects_arm/model.hpp"
#include "rx90/inverse_dynamics.hpp"
#include "rx90/inverse_dynamics_derivatives.hpp"
#include "rx90/mass_matrix.hpp"
#include "rx90/model.hpp"
#include "rx90/regressor.hpp"
#include "rx90/sines.hpp"
#include "scara/inverse_dynamics.hpp"  // its function is no candidate for rx90's over its packs
#include "scara/pack.hpp"

namespace {

namespace rx90 = idim_models::rx90;
namespace effects_arm = idim_models::effects_arm;

// Sines of vector libraries are within three units in the last place; some hundred operations carry that on.
constexpr double rounding = 1e-12;

template <class Pack>
struct lanes_of;

template <>
struct lanes_of<std::experimental::native_simd<double>> {
    using pack = std::experimental::native_simd<double>;
    static constexpr std::size_t count = pack::size();
    static pack load(const double* from) { return pack(from, std::experimental::element_aligned); }
    static void store(const pack& value, double* to) { value.copy_to(to, std::experimental::element_aligned); }
};

template <>
struct lanes_of<xsimd::batch<double>> {
    using pack = xsimd::batch<double>;
    static constexpr std::size_t count = pack::size;
    static pack load(const double* from) { return pack::load_unaligned(from); }
    static void store(const pack& value, double* to) { value.store_unaligned(to); }
};

template <>
struct lanes_of<idim_models::scara::pack> {
    using pack = idim_models::scara::pack;
    static constexpr std::size_t count = pack::lanes;
    static pack load(const double* from) { return pack::load(from); }
    static void store(const pack& value, double* to) { value.store(to); }
};

template <class Pack>
class PackScalar : public testing::Test {
  protected:
    using lanes = lanes_of<Pack>;

    /// Random numbers to +-bound, one a lane for each of `size` packs; the first is zero.
    std::vector<Pack> draw(std::size_t size, double bound) {
        std::vector<Pack> packs;
        for (std::size_t i = 0; i < size; ++i) {
            std::array<double, lanes::count> values{};
            for (double& value : values) {
                value = std::uniform_real_distribution<double>(-bound, bound)(random_);
            }
            values[0] = i == 0 ? 0.0 : values[0];
            packs.push_back(lanes::load(values.data()));
        }
        return packs;
    }
    static std::vector<double> lane(const std::vector<Pack>& packs, std::size_t number) {
        std::vector<double> result;
        for (const Pack& pack : packs) {
            std::array<double, lanes::count> values{};
            lanes::store(pack, values.data());
            result.push_back(values[number]);
        }
        return result;
    }

    std::mt19937_64 random_{51};
};

using packs = testing::Types<std::experimental::native_simd<double>, xsimd::batch<double>, idim_models::scara::pack>;
TYPED_TEST_SUITE(PackScalar, packs);

TYPED_TEST(PackScalar, EveryLaneHasTheValuesOfDouble) {
    const auto q = this->draw(6, 3.0), qd = this->draw(6, 2.0), qdd = this->draw(6, 5.0);
    const auto chi = this->draw(rx90::base_parameters, 2.0);
    std::vector<TypeParam> tau(6);
    rx90::inverse_dynamics(q.data(), qd.data(), qdd.data(), chi.data(), tau.data());
    for (std::size_t lane = 0; lane < lanes_of<TypeParam>::count; ++lane) {
        const auto in = [&](const std::vector<TypeParam>& all) { return this->lane(all, lane); };
        std::vector<double> expected(6);
        rx90::inverse_dynamics(in(q).data(), in(qd).data(), in(qdd).data(), in(chi).data(), expected.data());
        for (std::size_t j = 0; j < 6; ++j) {
            EXPECT_NEAR(in(tau)[j], expected[j], rounding * (1.0 + std::abs(expected[j])));
        }
    }
}

TYPED_TEST(PackScalar, EveryFunctionAnEffectMayCallIsFound) {
    const auto q = this->draw(2, 3.0), qd = this->draw(2, 2.0), qdd = this->draw(2, 5.0), t = this->draw(1, 9.0);
    const auto temp = this->draw(2, 40.0), chi = this->draw(effects_arm::base_parameters, 2.0);
    std::vector<TypeParam> tau(2);
    effects_arm::inverse_dynamics(q.data(), qd.data(), qdd.data(), t[0], temp.data(), chi.data(), tau.data());
    for (std::size_t lane = 0; lane < lanes_of<TypeParam>::count; ++lane) {
        const auto in = [&](const std::vector<TypeParam>& all) { return this->lane(all, lane); };
        std::array<double, 2> expected{};
        effects_arm::inverse_dynamics(in(q).data(), in(qd).data(), in(qdd).data(), in(t)[0], in(temp).data(),
                                      in(chi).data(), expected.data());
        for (std::size_t j = 0; j < 2; ++j) {
            EXPECT_NEAR(in(tau)[j], expected[j], rounding * (1.0 + std::abs(expected[j])));
        }
    }
}

TEST(Sign, IsMinusOneZeroOrOneInEveryScalar) {
    EXPECT_EQ(rx90::sign(-2.5), -1.0);
    EXPECT_EQ(rx90::sign(0.0), 0.0);
    EXPECT_EQ(rx90::sign(1e-300), 1.0);
    EXPECT_EQ(rx90::sign(3.0F), 1.0F);
    using simd = std::experimental::native_simd<double>;
    const simd signs = rx90::sign(simd([](auto lane) { return static_cast<double>(lane) - 1.0; }));
    for (std::size_t lane = 0; lane < simd::size(); ++lane) {
        EXPECT_EQ(double(signs[lane]), lane == 0 ? -1.0 : lane == 1 ? 0.0 : 1.0);
    }
}

TEST(Pack, SinesAreThoseOfTheMathematicalLibraryToThreeUnitsInTheLastPlace) {
    using pack = idim_models::scara::pack;
    std::mt19937_64 random(52);
    for (const double bound : {1.0, 4.0, 1e2, 1e4, 1e6, 1e9, 1e300}) {
        for (int k = 0; k < 20000; ++k) {
            std::array<double, pack::lanes> x{}, sine{}, cosine{};
            for (double& value : x) {
                value = std::uniform_real_distribution<double>(-bound, bound)(random);
            }
            const pack angle = pack::load(x.data());
            sin(angle).store(sine.data());
            cos(angle).store(cosine.data());
            for (std::size_t lane = 0; lane < pack::lanes; ++lane) {
                const double s = std::sin(x[lane]), c = std::cos(x[lane]);
                EXPECT_LE(std::abs(sine[lane] - s), 3.0 * 2.3e-16 * std::abs(s)) << x[lane];
                EXPECT_LE(std::abs(cosine[lane] - c), 3.0 * 2.3e-16 * std::abs(c)) << x[lane];
            }
        }
    }
}

TEST(Pack, ALaneThatIsNoNumberLeavesTheOthersAlone) {
    using pack = idim_models::scara::pack;
    std::array<double, pack::lanes> x{}, alone{}, beside{};
    x.fill(0.7);
    sin(pack::load(x.data())).store(alone.data());
    x[0] = std::numeric_limits<double>::infinity();
    sin(pack::load(x.data())).store(beside.data());
    EXPECT_TRUE(std::isnan(beside[0]));
    for (std::size_t lane = 1; lane < pack::lanes; ++lane) {
        EXPECT_EQ(beside[lane], alone[lane]);
    }
}

TEST(AutomaticDifferentiation, OfInverseDynamicsGivesTheInertiaMatrixAndTheRegressor) {
    // Of fixed size: with VectorXd, derivatives of constants have no elements, which expressions of them do not
    // survive.
    constexpr int b = rx90::base_parameters;
    using dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 6 + b, 1>>;
    std::mt19937_64 random(53);
    std::uniform_real_distribution<double> uniform(-2.0, 2.0);
    std::vector<double> q(6), qd(6), qdd(6), chi(b), W(std::size_t{6} * b), M(36);
    for (auto* values : {&q, &qd, &qdd, &chi}) {
        for (double& value : *values) {
            value = uniform(random);
        }
    }
    rx90::regressor(q.data(), qd.data(), qdd.data(), W.data());
    rx90::mass_matrix(q.data(), chi.data(), M.data());
    const auto constants = [](const std::vector<double>& values) {
        return std::vector<dual>(values.begin(), values.end());
    };
    std::vector<dual> acceleration, parameters, tau(6);
    for (int j = 0; j < 6; ++j) {
        acceleration.emplace_back(qdd[j], 6 + b, j);
    }
    for (int p = 0; p < b; ++p) {
        parameters.emplace_back(chi[p], 6 + b, 6 + p);
    }
    const std::vector<dual> position = constants(q), velocity = constants(qd);
    rx90::inverse_dynamics(position.data(), velocity.data(), acceleration.data(), parameters.data(), tau.data());
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            EXPECT_NEAR(tau[i].derivatives()[j], M[6 * i + j], rounding * (1.0 + std::abs(M[6 * i + j])));
        }
        for (int p = 0; p < b; ++p) {
            EXPECT_NEAR(tau[i].derivatives()[6 + p], W[i * b + p], rounding * (1.0 + std::abs(W[i * b + p])));
        }
    }
}

TEST(AutomaticDifferentiation, OfInverseDynamicsGivesTheGeneratedDerivatives) {
    constexpr int n = rx90::dof;
    using dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 2 * n, 1>>;
    std::mt19937_64 random(54);
    std::uniform_real_distribution<double> uniform(-2.0, 2.0);
    for (int state = 0; state < 20; ++state) {
        std::vector<double> q(n), qd(n), qdd(n), chi(rx90::base_parameters), by_q(n * n), by_qd(n * n);
        for (auto* values : {&q, &qd, &qdd, &chi}) {
            for (double& value : *values) {
                value = uniform(random);
            }
        }
        rx90::inverse_dynamics_derivatives(q.data(), qd.data(), qdd.data(), chi.data(), by_q.data(), by_qd.data());
        std::vector<dual> position, velocity, tau(n);
        for (int j = 0; j < n; ++j) {
            position.emplace_back(q[j], 2 * n, j);
            velocity.emplace_back(qd[j], 2 * n, n + j);
        }
        const std::vector<dual> acceleration(qdd.begin(), qdd.end()), parameters(chi.begin(), chi.end());
        rx90::inverse_dynamics(position.data(), velocity.data(), acceleration.data(), parameters.data(), tau.data());
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                const auto& expected = tau[i].derivatives();
                EXPECT_NEAR(by_q[n * i + j], expected[j], rounding * (1.0 + std::abs(expected[j])));
                EXPECT_NEAR(by_qd[n * i + j], expected[n + j], rounding * (1.0 + std::abs(expected[n + j])));
            }
        }
    }
}

TEST(Derivatives, OfEffectsAreThoseOfDifferences) {
    constexpr int n = effects_arm::dof;
    std::mt19937_64 random(55);
    std::uniform_real_distribution<double> uniform(0.3, 1.2);  // away from 0, where signs jump
    const auto draw = [&](int size) {
        std::vector<double> values(static_cast<std::size_t>(size));
        for (double& value : values) {
            value = uniform(random);
        }
        return values;
    };
    for (int state = 0; state < 20; ++state) {
        std::vector<double> q = draw(n), qd = draw(n), by_q(n * n), by_qd(n * n);
        const std::vector<double> qdd = draw(n), temp = draw(n), chi = draw(effects_arm::base_parameters);
        const double t = uniform(random);
        effects_arm::inverse_dynamics_derivatives(q.data(), qd.data(), qdd.data(), t, temp.data(), chi.data(),
                                                  by_q.data(), by_qd.data());
        const auto torque = [&](double& moved, double step) {
            const double kept = moved;
            moved += step;
            std::array<double, n> tau{};
            effects_arm::inverse_dynamics(q.data(), qd.data(), qdd.data(), t, temp.data(), chi.data(), tau.data());
            moved = kept;
            return tau;
        };
        for (int j = 0; j < n; ++j) {
            for (const bool of_velocity : {false, true}) {
                double& moved = of_velocity ? qd[j] : q[j];
                constexpr double h = 1e-3;  // of fourth order: error h^4 times the fifth derivative
                const auto p = torque(moved, h), m = torque(moved, -h), pp = torque(moved, 2 * h),
                           mm = torque(moved, -2 * h);
                for (int i = 0; i < n; ++i) {
                    const double expected = (8.0 * (p[i] - m[i]) - (pp[i] - mm[i])) / (12.0 * h);
                    const double found = (of_velocity ? by_qd : by_q)[n * i + j];
                    EXPECT_NEAR(found, expected, 1e-7 * (1.0 + std::abs(expected)));
                }
            }
        }
    }
}

TEST(Sines, OfOneStateServeSeveralModels) {
    const std::array<double, 6> q = {0.3, -1.2, 0.8, 2.1, -0.4, 1.5}, qd = {0.7, 0.2, -0.5, 1.1, 0.6, -0.9}, qdd{};
    std::array<double, rx90::base_parameters> chi{};
    chi.fill(0.8);
    std::array<double, rx90::sine_count> sc{};
    rx90::sines(q.data(), sc.data());
    std::array<double, 6> tau{}, tau_sc{};
    rx90::inverse_dynamics(q.data(), qd.data(), qdd.data(), chi.data(), tau.data());
    rx90::inverse_dynamics_sc(q.data(), sc.data(), qd.data(), qdd.data(), chi.data(), tau_sc.data());
    EXPECT_EQ(tau, tau_sc);
    std::array<double, 36> M{}, M_sc{};
    rx90::mass_matrix(q.data(), chi.data(), M.data());
    rx90::mass_matrix_sc(q.data(), sc.data(), chi.data(), M_sc.data());
    EXPECT_EQ(M, M_sc);
}

}  // namespace
