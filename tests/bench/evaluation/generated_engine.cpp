#include <stdexcept>

#include "evaluation/engine.hpp"
#include "kuka_lwr/batch.hpp"
#include "kuka_lwr/forward_dynamics.hpp"
#include "kuka_lwr/inverse_dynamics.hpp"
#include "kuka_lwr/mass_matrix.hpp"
#include "kuka_lwr/model.hpp"
#include "kuka_lwr/regressor.hpp"
#include "kuka_lwr/regroup.hpp"
#include "rx90/batch.hpp"
#include "rx90/forward_dynamics.hpp"
#include "rx90/inverse_dynamics.hpp"
#include "rx90/mass_matrix.hpp"
#include "rx90/model.hpp"
#include "rx90/regressor.hpp"
#include "rx90/regroup.hpp"
#include "scara/batch.hpp"
#include "scara/forward_dynamics.hpp"
#include "scara/inverse_dynamics.hpp"
#include "scara/mass_matrix.hpp"
#include "scara/model.hpp"
#include "scara/regressor.hpp"
#include "scara/regroup.hpp"

namespace idim::bench {

namespace {

/// Base parameters of the rigid links; effects are zero, but their operations are there.
template <std::size_t s>
Eigen::VectorXd regrouped(const rigid_robot& robot, const std::array<const char*, s>& names, std::size_t n_base,
                          void (*regroup)(const double*, double*)) {
    const test::value_table known = test::standard_parameters_of(robot.links);
    std::array<double, s> standard{};
    for (std::size_t p = 0; p < s; ++p) {
        const auto value = known.find(names[p]);
        standard[p] = value == known.end() ? 0.0 : value->second;
    }
    Eigen::VectorXd chi(static_cast<Eigen::Index>(n_base));
    regroup(standard.data(), chi.data());
    return chi;
}

std::size_t stride(const Eigen::MatrixXd& array) {
    return static_cast<std::size_t>(array.rows());
}

template <typename Samples>
Samples packed(const motion_samples& all) {
    Samples samples;
    samples.count = stride(all.q);
    samples.stride = stride(all.q);
    samples.q = all.q.data();
    samples.qd = all.qd.data();
    samples.qdd = all.qdd.data();
    return samples;
}

}  // namespace

// One class for each robot: the functions differ by namespace only.
#define IDIM_GENERATED_ENGINE(robot_name)                                                                              \
    namespace {                                                                                                        \
    class robot_name##_engine : public engine {                                                                        \
      public:                                                                                                          \
        explicit robot_name##_engine(const rigid_robot& robot)                                                         \
            : chi_(regrouped(robot, idim_models::robot_name::standard_parameter_names,                                 \
                             idim_models::robot_name::base_parameters, idim_models::robot_name::regroup<double>)) {}   \
        std::string name() const override { return "generated"; }                                                      \
        void inverse_dynamics(const test::joint_state& s, Eigen::VectorXd& tau) override {                             \
            idim_models::robot_name::inverse_dynamics(s.q.data(), s.qd.data(), s.qdd.data(), chi_.data(), tau.data()); \
        }                                                                                                              \
        void mass_matrix(const Eigen::VectorXd& q, row_major& M) override {                                            \
            idim_models::robot_name::mass_matrix(q.data(), chi_.data(), M.data());                                     \
        }                                                                                                              \
        void forward_dynamics(const test::joint_state& s, const Eigen::VectorXd& tau, Eigen::VectorXd& qdd) override { \
            idim_models::robot_name::forward_dynamics(s.q.data(), s.qd.data(), tau.data(), chi_.data(), qdd.data(),    \
                                                      D_);                                                             \
        }                                                                                                              \
        bool regressor(const test::joint_state& s, row_major& W) override {                                            \
            W.resize(s.q.size(), chi_.size());                                                                         \
            idim_models::robot_name::regressor(s.q.data(), s.qd.data(), s.qdd.data(), W.data());                       \
            return true;                                                                                               \
        }                                                                                                              \
        bool inverse_dynamics(const motion_samples& all, Eigen::MatrixXd& tau) override {                              \
            tau.resize(all.q.rows(), all.q.cols());                                                                    \
            idim_models::robot_name::inverse_dynamics_batch(packed<idim_models::robot_name::batch_samples>(all),       \
                                                            chi_.data(), tau.data(), stride(tau));                     \
            return true;                                                                                               \
        }                                                                                                              \
        bool regressor(const motion_samples& all, Eigen::MatrixXd& W) override {                                       \
            W.resize(all.q.rows(), all.q.cols() * chi_.size());                                                        \
            idim_models::robot_name::regressor_batch(packed<idim_models::robot_name::batch_samples>(all), W.data(),    \
                                                     stride(W));                                                       \
            return true;                                                                                               \
        }                                                                                                              \
        Eigen::VectorXd parameters() const override { return chi_; }                                                   \
                                                                                                                       \
      private:                                                                                                         \
        Eigen::VectorXd chi_;                                                                                          \
        double D_[idim_models::robot_name::dof] = {};                                                                  \
    };                                                                                                                 \
    }

IDIM_GENERATED_ENGINE(scara)
IDIM_GENERATED_ENGINE(rx90)
IDIM_GENERATED_ENGINE(kuka_lwr)

std::unique_ptr<engine> generated_engine(const rigid_robot& robot) {
    if (robot.name == "scara") {
        return std::make_unique<scara_engine>(robot);
    }
    if (robot.name == "rx90") {
        return std::make_unique<rx90_engine>(robot);
    }
    if (robot.name == "kuka_lwr") {
        return std::make_unique<kuka_lwr_engine>(robot);
    }
    throw std::invalid_argument("no generated code of " + robot.name + " in this program");
}

}  // namespace idim::bench
