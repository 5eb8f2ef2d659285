#include "excitation/sampled_model.hpp"

#include <algorithm>

namespace idim {

namespace {

Eigen::MatrixXd signals_of(const idim_model_interface& model, Eigen::Index count) {
    Eigen::MatrixXd signals = Eigen::MatrixXd::Zero(count, std::max(model.dof, model.n_signals));
    signals.leftCols(model.dof).setConstant(20.0);  // degC
    return signals;
}

/// Calls evaluate(q, qd, qdd, t, temp, row) for every sample and puts the row into `values`.
template <class Evaluate>
void one_by_one(const idim_model_interface& model, const motion_samples& motion, Eigen::MatrixXd& values,
                const Evaluate& evaluate) {
    const Eigen::VectorXd signals = signals_of(model, 1).row(0);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(values.cols());
    for (Eigen::Index k = 0; k < values.rows(); ++k) {
        const Eigen::VectorXd q = motion.q.row(k);
        const Eigen::VectorXd qd = motion.qd.row(k);
        const Eigen::VectorXd qdd = motion.qdd.row(k);
        evaluate(q.data(), qd.data(), qdd.data(), motion.t[k], signals.data(), row.data());
        values.row(k) = row;
    }
}

idim_samples batch_of(const motion_samples& motion, const Eigen::MatrixXd& signals) {
    const auto count = static_cast<size_t>(motion.t.size());
    return {count, count, motion.q.data(), motion.qd.data(), motion.qdd.data(), motion.t.data(), signals.data()};
}

}  // namespace

Eigen::MatrixXd sampled_regressor(const idim_model_interface& model, const motion_samples& motion) {
    Eigen::MatrixXd W(motion.t.size(), model.dof * model.n_base);
    if (model.regressor_batch == nullptr) {
        one_by_one(model, motion, W, model.regressor);
        return W;
    }
    const Eigen::MatrixXd signals = signals_of(model, W.rows());
    const idim_samples batch = batch_of(motion, signals);
    model.regressor_batch(&batch, W.data(), batch.count);
    return W;
}

Eigen::MatrixXd sampled_torque(const idim_model_interface& model, const motion_samples& motion,
                               const Eigen::VectorXd& chi) {
    Eigen::MatrixXd tau(motion.t.size(), model.dof);
    if (model.inverse_dynamics_batch == nullptr) {
        one_by_one(model, motion, tau,
                   [&](const double* q, const double* qd, const double* qdd, double t, const double* temp,
                       double* row) { model.inverse_dynamics(q, qd, qdd, t, temp, chi.data(), row); });
        return tau;
    }
    const Eigen::MatrixXd signals = signals_of(model, tau.rows());
    const idim_samples batch = batch_of(motion, signals);
    model.inverse_dynamics_batch(&batch, chi.data(), tau.data(), batch.count);
    return tau;
}

}  // namespace idim
