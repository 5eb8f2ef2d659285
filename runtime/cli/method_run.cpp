#include "method_run.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "identified_parameters.hpp"
#include "idim/control_law.hpp"
#include "idim/fitted_rows.hpp"
#include "idim/input_error.hpp"
#include "idim/log_parameters.hpp"
#include "idim/recorded_states.hpp"
#include "idim/total_least_squares.hpp"

namespace idim::cli {

namespace {

const std::map<std::string, loop_method>& simulating_methods() {
    static const std::map<std::string, loop_method> names = {
        {"iv", loop_method::iv}, {"didim", loop_method::didim}, {"cloe", loop_method::cloe}};
    return names;
}

estimate without_simulation(const std::string& method, const observation& rows) {
    static const std::map<std::string, least_squares_method> names = {
        {"ols", least_squares_method::ols}, {"wls", least_squares_method::wls}, {"irls", least_squares_method::irls}};
    return method == "tls" ? total_least_squares(rows) : least_squares(rows, names.at(method));
}

/// The parameters where their inertia is positive at every joint, else a regular start.
Eigen::VectorXd physical_or_regular(const idim_model_interface& model, const Eigen::VectorXd& chi) {
    const bool physical = chi.size() > 0 && largest_inertia(model, chi).minCoeff() > 0.0;
    return physical ? chi : regular_start(model);
}

}  // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = {"ols", "wls", "irls", "tls", "cwls", "iv", "didim", "cloe"};
    return names;
}

bool simulates(const std::string& method) {
    return simulating_methods().count(method) != 0;
}

method_runner::method_runner(const loaded_robot& robot, const std::string& robot_file,
                             const std::vector<idim::log>& logs, const filter_choice& filter,
                             const method_request& request)
    : robot_(robot), robot_file_(robot_file), logs_(&logs), filter_(filter), request_(request) {
    if (!request.period.empty()) {
        periods_ = find_periods(logs, filter, request.period);
    }
}

method_runner::method_runner(const loaded_robot& robot, const std::string& robot_file, periodic_logs periods,
                             const filter_choice& filter, const method_request& request)
    : robot_(robot), robot_file_(robot_file), filter_(filter), request_(request), periods_(std::move(periods)) {}

loop_experiment method_runner::experiment() const {
    return {robot_.model(), *logs_, filter_};
}

observation method_runner::all_rows() const {
    if (periods_ && periods_->averages()) {
        return rows_of_period(fitted(periods_->average), periods_->parts, filter_);
    }
    std::vector<filtered_samples> samples;
    for (const idim::log& log : *logs_) {
        samples.push_back(filter_log(log, filter_));
    }
    return fitted(samples);
}

observation method_runner::fitted(const std::vector<filtered_samples>& samples) const {
    if (!depends_on_parameters(robot_.model())) {
        return with_log_columns(robot_.model(), observe(robot_.model(), samples, filter_));
    }
    fitted_rows fit = fit_rows(robot_.model(), samples, filter_, least_squares_method::wls);
    if (fit.result.chi.size() > 0 && !fit.result.converged) {
        throw data_error(fit.result.message);
    }
    return std::move(fit.rows);
}

const simulated_loops& method_runner::loops() {
    if (!loops_) {
        const estimate ls = least_squares(all_rows(), least_squares_method::wls);
        loops_ = simulated_loops_of(robot_, robot_file_, *logs_, filter_, request_.loop,
                                    physical_or_regular(robot_.model(), ls.chi));
    }
    return *loops_;
}

observation method_runner::steady_rows() {
    return observe_steady(experiment(), loops().rescaled);
}

method_runner::start_point method_runner::start_for(const observation& rows) const {
    if (request_.start == "regular") {
        return {regular_start(robot_.model()), "a regular start"};
    }
    if (request_.start == "ls") {
        return {least_squares(rows, least_squares_method::wls).chi, "least squares"};
    }
    return {read_parameters(request_.start, robot_).chi, request_.start};
}

loop_estimate method_runner::simulate(const std::string& method, const observation& rows, const start_point& start) {
    const closed_loop& loop = method == "cloe" ? loops().fixed : loops().rescaled;
    return identify_in_loop(experiment(), loop, rows, simulating_methods().at(method), start.chi, request_.options);
}

bool method_runner::whitens(const std::string& method) const {
    return periods_ && periods_->weights() && (method == "wls" || method == "cwls");
}

estimate method_runner::least_squares_of(const std::string& method, const observation& rows,
                                         method_result& result) const {
    if (!whitens(method)) {
        return without_simulation(method, rows);
    }
    estimate fit = fit_whitened(rows, whiten(rows, periods_->scatter));
    if (fit.chi.size() > 0) {
        result.scatter_deviations = scatter_deviations(rows, periods_->scatter);
    }
    return fit;
}

consistent_estimate method_runner::consistent_of(const observation& rows) const {
    const physical_parameters known = physical_parameters_of(robot_);
    consistency_request request = request_of(request_.consistency, robot_, known);
    if (!whitens("cwls")) {
        return consistent_fit(robot_.model(), rows, known, request);
    }
    request.weights_joints = false;
    consistent_estimate found = consistent_fit(robot_.model(), whiten(rows, periods_->scatter), known, request);
    if (found.fit.chi.size() > 0) {
        restore_units(rows, found.fit);
        restore_units(rows, found.unconstrained);
    }
    return found;
}

method_result method_runner::run(const std::string& method, const observation& rows) {
    method_result result;
    result.method = method;
    if (method == "cwls") {
        result.consistent = consistent_of(rows);
        result.fit = result.consistent->fit;
    } else if (!simulates(method)) {
        result.fit = least_squares_of(method, rows, result);
    } else {
        start_point start = start_for(rows);
        if (start.chi.size() == 0) {
            result.fit = least_squares(rows, least_squares_method::wls);
            return result;
        }
        loop_estimate found = simulate(method, rows, start);
        if (found.fit.chi.size() == 0 && request_.start == "ls" && found.fit.iterations.size() <= 1) {
            start = {regular_start(robot_.model()),
                     "a regular start, since the least squares estimate could not be simulated"};
            found = simulate(method, rows, start);
        }
        result.start = start.name;
        result.assumption = loops().rescaled.assumption;
        result.fit = std::move(found.fit);
        const estimate ls = least_squares(rows, least_squares_method::wls);
        if (method == "iv" && result.fit.chi.size() > 0 && ls.chi.size() > 0) {
            result.instruments = durbin_wu_hausman(rows, found.along, ls, result.fit);
        }
    }
    if (result.fit.chi.size() > 0) {
        result.residual = test_residual(rows, result.fit);
    }
    return result;
}

}  // namespace idim::cli
