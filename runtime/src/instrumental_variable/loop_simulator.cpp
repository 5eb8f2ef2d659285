#include "instrumental_variable/loop_simulator.hpp"

#include <algorithm>

#include "idim/input_error.hpp"
#include "idim/zero_phase_filter.hpp"
#include "parallel.hpp"

namespace idim {

namespace {

/// Time after which the simulated motion has forgotten its start [IV 3.4].
double transient_of(const closed_loop& loop) {
    return 5.0 / loop.natural_frequency.minCoeff();
}

std::vector<filtered_samples> filter_all(const std::vector<log>& logs, const filter_choice& filter) {
    std::vector<filtered_samples> samples;
    samples.reserve(logs.size());
    for (const log& data : logs) {
        samples.push_back(filter_log(data, filter));
    }
    return samples;
}

/// The references as if they were measured; nothing where a log has none.
std::vector<log> references_of(const std::vector<log>& logs) {
    std::vector<log> references;
    for (const log& data : logs) {
        if (data.qr.size() == 0) {
            return {};
        }
        log reference;
        reference.file = data.file;
        reference.t = data.t;
        reference.q = data.qr;
        references.push_back(std::move(reference));
    }
    return references;
}

}  // namespace

observation observe_steady(const loop_experiment& experiment, const closed_loop& loop) {
    const std::vector<filtered_samples> samples = filter_all(experiment.logs, experiment.filter);
    std::vector<row_selection> kept;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double steady = experiment.logs[i].t[0] + transient_of(loop);
        row_selection rows = select_rows(samples[i], experiment.filter);
        for (std::vector<Eigen::Index>& places : rows) {
            const auto starts = [&](Eigen::Index k) { return samples[i].t[k * experiment.filter.decimation] < steady; };
            places.erase(std::remove_if(places.begin(), places.end(), starts), places.end());
        }
        kept.push_back(std::move(rows));
    }
    return observe(experiment.model, samples, experiment.filter, kept);
}

loop_simulator::loop_simulator(const loop_experiment& experiment, const closed_loop& loop, const observation& rows)
    : experiment_(experiment),
      loop_(loop),
      rows_(rows),
      measured_(filter_all(experiment.logs, experiment.filter)),
      reference_(filter_all(references_of(experiment.logs), experiment.filter)),
      transient_(transient_of(loop)) {
    for (const observation_block& block : rows.blocks) {
        kept_.push_back(block.kept);
    }
}

std::vector<simulated_motions> loop_simulator::simulate(const std::vector<Eigen::VectorXd>& points) const {
    const std::size_t logs = experiment_.logs.size();
    std::vector<simulated_motions> result(points.size());
    for (simulated_motions& motions : result) {
        motions.logs.resize(logs);
    }
    std::vector<std::string> failures(points.size() * logs);
    for_each_on_all_cores(failures.size(), [&](std::size_t i) {
        const log& recorded = experiment_.logs[i % logs];
        try {
            log motion = loop_.motion(points[i / logs], recorded);
            motion.file = recorded.file;
            result[i / logs].logs[i % logs] = filter_log(motion, experiment_.filter);
        } catch (const data_error& error) {
            failures[i] = recorded.file + ": " + error.what();
        }
    });
    for (std::size_t i = 0; i < failures.size(); ++i) {
        std::string& failure = result[i / logs].failure;
        failure = failure.empty() ? failures[i] : failure;
    }
    return result;
}

observation loop_simulator::regressor_along(const std::vector<filtered_samples>& motions) const {
    observation along = observe(experiment_.model, motions, experiment_.filter, kept_);
    for (std::size_t i = 0; i < along.blocks.size(); ++i) {
        along.blocks[i].Y = rows_.blocks[i].Y;
    }
    return along;
}

observation loop_simulator::corrected(const observation& regressor, const std::vector<filtered_samples>& motions,
                                      const observation& along, const Eigen::VectorXd& chi) const {
    observation rows = regressor;
    for (std::size_t i = 0; i < rows.blocks.size(); ++i) {
        if (motions[i].tau.size() == 0) {
            continue;
        }
        const Eigen::MatrixXd tau = decimate(motions[i].tau, experiment_.filter.decimation);
        for (std::size_t j = 0; j < kept_[i].size(); ++j) {
            const Eigen::VectorXd simulated = tau(kept_[i][j], static_cast<Eigen::Index>(j));
            rows.blocks[i].Y[j] -= simulated - along.blocks[i].W[j] * chi;
        }
    }
    return rows;
}

iteration loop_simulator::judge(const Eigen::VectorXd& chi, const std::vector<filtered_samples>& motions,
                                const observation& along) const {
    const error_summary measured_errors = errors(rows_, chi);
    iteration step;
    step.chi = chi;
    step.relative_error = measured_errors.relative_error;
    step.joint_errors = measured_errors.joints;
    step.simulated_error = errors(along, chi).relative_error;
    step.to_measured = distances(motions, measured_, transient_);
    if (!reference_.empty()) {
        step.to_reference = distances(motions, reference_, transient_);
    }
    return step;
}

}  // namespace idim
