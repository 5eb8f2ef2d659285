#pragma once

#include <Eigen/Core>
#include <vector>

#include "idim/control_law.hpp"
#include "idim/loop_identification.hpp"
#include "idim/simulation.hpp"
#include "oracles/scara_loop.hpp"

namespace idim::test {

/// The library's loop under a cascade PD with these natural frequencies, damping 1 and drive gains 1, its velocity
/// gains rescaled with the inertia of chi [IV 46].
inline closed_loop cascade_loop(const idim_model_interface& model, double rate, const Eigen::VectorXd& wn) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(model.dof);
    return {[&model, rate, wn, ones](const Eigen::VectorXd& chi, const log& recorded) {
                const pd_cascade law = tune_pd_cascade(rate, wn, ones, largest_inertia(model, chi), ones);
                return simulate(model, chi, law, recorded, {0.0 * ones, 0.0 * ones, 1}, 4).measured;
            },
            wn, ""};
}

/// One draw of the experiment of [IV section 4]: 60 s at 200 Hz, white noise of 1e-5 rad and of 0.4 and 0.08 N*m, with
/// which least squares without filters fails as in table 5 and the filtered relative error is as published, 2.4 %; both
/// times `noise`.
class scara_experiment {
  public:
    scara_experiment(const idim_model_interface& model, bool filtered, std::uint64_t seed, double noise = 1.0)
        : logs_{record(seed, noise)},
          filter_(choose_filter(logs_, request(filtered))),
          experiment_{model, logs_, filter_},
          rows_(observe_steady(experiment_, loop())) {}

    /// Parameters of `model`: first moments where the paper has L times them.
    static Eigen::VectorXd truth() {
        const scara_loop robot;
        return robot.chi.cwiseQuotient(scale());
    }
    /// The paper's parameters over the model's.
    static Eigen::VectorXd scale() { return (Eigen::VectorXd(8) << 1, 1, 1, 1, 0.5, 0.5, 1, 1).finished(); }

    const observation& rows() const { return rows_; }
    estimate ls() const { return least_squares(rows_, least_squares_method::wls); }
    loop_estimate iv(const Eigen::VectorXd& start, double bandwidth_scale = 1.0, bool corrected = false) const {
        loop_options options;
        options.corrects_processing = corrected;
        const closed_loop simulated = loop(bandwidth_scale);
        const observation steady = bandwidth_scale == 1.0 ? rows_ : observe_steady(experiment_, simulated);
        return identify_in_loop(experiment_, simulated, steady, loop_method::iv, start, options);
    }
    closed_loop loop(double bandwidth_scale = 1.0) const {
        return cascade_loop(experiment_.model, 200.0, bandwidth_scale * Eigen::Vector2d(1.0, 10.0));
    }
    const loop_experiment& experiment() const { return experiment_; }

    scara_experiment(const scara_experiment&) = delete;
    scara_experiment& operator=(const scara_experiment&) = delete;

  private:
    static log record(std::uint64_t seed, double noise) {
        scara_loop robot;
        robot.position_noise = noise * Eigen::Vector2d(1e-5, 1e-5);
        robot.torque_noise = noise * Eigen::Vector2d(0.4, 0.08);
        return robot.record(scara_reference(60.0), seed);
    }
    /// [IV 4.2]: Butterworth at 20 Hz, one row in 20; or nothing of it [IV 4.4].
    static filter_request request(bool filtered) {
        filter_request asked;
        asked.cutoff = filtered ? 20.0 : 0.0;
        asked.decimation = filtered ? 20 : 1;
        return asked;
    }

    std::vector<log> logs_;
    filter_choice filter_;
    loop_experiment experiment_;
    observation rows_;
};

}  // namespace idim::test
