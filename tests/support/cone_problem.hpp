#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "consistency/cone_program.hpp"
#include "idim/inertial_body.hpp"

namespace idim::test {

/// Independent standard normal numbers.
inline Eigen::MatrixXd normal_matrix(Eigen::Index height, Eigen::Index width, std::mt19937_64& random) {
    std::normal_distribution<double> distribution;
    Eigen::MatrixXd values(height, width);
    for (double& value : values.reshaped()) {
        value = distribution(random);
    }
    return values;
}

/// Six bodies and 24 coefficients seen through 52 combinations; the truth consistent, the noise large enough to lead
/// away from it.
struct random_problem {
    static constexpr int bodies = 6;
    static constexpr int frictions = 24;
    static constexpr int parameter_count = 10 * bodies + frictions;
    static constexpr int equations = 52;

    explicit random_problem(double noise, std::uint64_t seed = 1) {
        std::mt19937_64 random(seed);
        R = normal_matrix(equations, parameter_count, random);
        program.A = 30.0 * normal_matrix(equations, equations, random) * R;
        truth.resize(parameter_count);
        start = Eigen::VectorXd::Zero(parameter_count);
        for (int i = 0; i < bodies; ++i) {
            const Eigen::Matrix4d L = normal_matrix(4, 4, random);
            truth.segment<10>(10 * i) = parameters_of_pseudo_inertia(0.3 * L * L.transpose());
            matrix_constraint body;
            for (int k = 0; k < 10; ++k) {
                body.places.push_back(10 * i + k);
                body.basis.emplace_back(pseudo_inertia(body_parameters::Unit(k)));
            }
            body.floor = 1e-6;
            body.size = 100.0;
            body.reference = Eigen::Vector4d(0.1, 0.1, 0.1, 2.0).asDiagonal();
            start.segment<10>(10 * i) = parameters_of_pseudo_inertia(body.reference);
            program.matrices.push_back(body);
        }
        for (int k = 10 * bodies; k < parameter_count; ++k) {
            truth[k] = std::abs(normal_matrix(1, 1, random)(0, 0));
            start[k] = 1.0;
            program.bounds.push_back({"coefficient", {{k, 1.0}}, 0.0, 1.0});
        }
        program.b = program.A * truth + noise * normal_matrix(equations, 1, random);
        program.constant = 1000.0;
    }

    double objective(const Eigen::VectorXd& x) const {
        return program.constant + 0.5 * (program.A * x - program.b).squaredNorm();
    }
    /// A feasible point, of sizes from a tenth to ten times the usual.
    Eigen::VectorXd feasible(std::mt19937_64& random) const {
        Eigen::VectorXd x(parameter_count);
        for (int i = 0; i < bodies; ++i) {
            const Eigen::Matrix4d L = std::pow(10.0, normal_matrix(1, 1, random)(0, 0)) * normal_matrix(4, 4, random);
            x.segment<10>(10 * i) =
                parameters_of_pseudo_inertia(L * L.transpose() + 1e-6 * Eigen::Matrix4d::Identity());
        }
        x.tail(frictions) = normal_matrix(frictions, 1, random).cwiseAbs();
        return x;
    }

    Eigen::MatrixXd R;
    cone_program program;
    Eigen::VectorXd truth, start;
};

}  // namespace idim::test
