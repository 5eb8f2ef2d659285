#include "traced_log.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "idim/effect_trace.hpp"
#include "idim/recorded_states.hpp"
#include "idim/zero_phase_filter.hpp"
#include "link_parameters.hpp"

namespace idim {

namespace {

/// Part of the top speed below which the sign of a speed is not believed, and the rows around such a sample that the
/// decimation filter smears it over.
constexpr double slow_share = 0.02;
constexpr double noise_multiple = 3.0;
constexpr double smear_rows = 1.5;

/// Deviation of the noise of a speed: what a parabola through five neighbouring samples leaves, per sample.
double speed_noise(const Eigen::Ref<const Eigen::VectorXd>& qd) {
    const Eigen::Index n = qd.size() - 3;
    if (n < 8) {
        return 0.0;
    }
    const Eigen::VectorXd third = qd.tail(n) - 3.0 * qd.segment(2, n) + 3.0 * qd.segment(1, n) - qd.head(n);
    return std::sqrt(third.squaredNorm() / (20.0 * static_cast<double>(n)));
}

row_flags reversals_of(const traced_log& log, Eigen::Index joint) {
    const auto qd = log.samples.qd.col(joint);
    const double slow = std::max(slow_share * qd.cwiseAbs().maxCoeff(), noise_multiple * speed_noise(qd));
    const auto reach = static_cast<Eigen::Index>(std::ceil(smear_rows * log.decimation));
    std::vector<char> slow_sample(static_cast<std::size_t>(qd.size()), 0);
    for (Eigen::Index k = 0; k < qd.size(); ++k) {
        const bool crosses = k > 0 && qd[k] * qd[k - 1] <= 0.0;
        if (std::abs(qd[k]) < slow || crosses) {
            const Eigen::Index first = std::max<Eigen::Index>(0, k - reach);
            const Eigen::Index last = std::min<Eigen::Index>(qd.size() - 1, k + reach);
            std::fill(slow_sample.begin() + first, slow_sample.begin() + last + 1, 1);
        }
    }
    const std::vector<Eigen::Index>& kept = log.rows.kept[static_cast<std::size_t>(joint)];
    row_flags flags(static_cast<Eigen::Index>(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const auto sample = static_cast<std::size_t>(kept[k] * log.decimation);
        flags[static_cast<Eigen::Index>(k)] = slow_sample[std::min(sample, slow_sample.size() - 1)] != 0;
    }
    return flags;
}

bool is_rigid(std::string_view name) {
    return std::any_of(inertial_names.begin(), inertial_names.end(), [&](std::string_view kind) {
        return name.size() > kind.size() && name.substr(0, kind.size()) == kind &&
               (std::isdigit(static_cast<unsigned char>(name[kind.size()])) != 0 || name[kind.size()] == '_');
    });
}

}  // namespace

Eigen::MatrixXd rows_of(const traced_log& log, int joint, const Eigen::MatrixXd& columns) {
    const Eigen::MatrixXd decimated = decimate(columns, log.decimation);
    return decimated(log.rows.kept[static_cast<std::size_t>(joint)], Eigen::all);
}

traced_log make_traced_log(const idim_model_interface& model, filtered_samples samples, const filter_choice& choice,
                           bool held_back) {
    traced_log log;
    observation rows = observe(model, {samples}, choice);
    log.rows = std::move(rows.blocks.front());
    log.samples = std::move(samples);
    log.decimation = choice.decimation;
    log.held_back = held_back;
    for (Eigen::Index joint = 0; joint < model.dof; ++joint) {
        log.reversal.push_back(reversals_of(log, joint));
    }
    return log;
}

void update_torques(const idim_model_interface& model, const Eigen::VectorXd& chi, traced_log& log) {
    log.tau_model = model_torques(model, log.samples, chi);
    log.chi_rigid = rigid_part(model, chi);
    log.tau_rigid = model_torques(model, log.samples, log.chi_rigid);
    if (model.n_signals > model.dof) {
        return;  // what effects read beside the motion does not follow from a link that moves otherwise
    }
    log.inertia.resize(log.samples.samples(), Eigen::Index{model.dof} * model.dof);
    filtered_samples probe = log.samples;
    for (Eigen::Index j = 0; j < model.dof; ++j) {
        probe.qdd.col(j).array() += 1.0;
        log.inertia.middleCols(j * model.dof, model.dof) = model_torques(model, probe, log.chi_rigid) - log.tau_rigid;
        probe.qdd.col(j) = log.samples.qdd.col(j);
    }
}

Eigen::VectorXd rigid_part(const idim_model_interface& model, Eigen::VectorXd chi) {
    for (int k = 0; k < model.n_base; ++k) {
        if (!is_rigid(model.parameter_names[k])) {
            chi[k] = 0.0;
        }
    }
    return chi;
}

std::pair<filtered_samples, filtered_samples> hold_back(const filtered_samples& samples, double share, double gap) {
    const Eigen::Index n = samples.samples();
    const auto held = static_cast<Eigen::Index>(std::floor(share * static_cast<double>(n)));
    const auto between = static_cast<Eigen::Index>(std::ceil(gap * samples.rate));
    const Eigen::Index first = std::max<Eigen::Index>(0, n - held - between);
    return {samples.part(0, first), samples.part(n - held, held)};
}

}  // namespace idim
