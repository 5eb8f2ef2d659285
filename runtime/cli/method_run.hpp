#pragma once

#include <optional>
#include <string>
#include <vector>

#include "consistency_options.hpp"
#include "idim/instrument_test.hpp"
#include "idim/loop_identification.hpp"
#include "idim/residual_test.hpp"
#include "periodic_logs.hpp"
#include "simulated_loop.hpp"

namespace idim::cli {

/// Names of all methods, those that do not simulate first.
const std::vector<std::string>& method_names();

/// Whether the method simulates the closed loop.
bool simulates(const std::string& method);

/// How the methods that simulate are to work.
struct method_request {
    loop_request loop;
    std::string start = "ls";  ///< ls, regular, or a file of parameters
    loop_options options;
    consistency_options consistency;  ///< of cwls
    std::string period;               ///< empty, auto, or seconds; of ols, wls and cwls
};

/// What one method made of the rows.
struct method_result {
    std::string method;
    estimate fit;
    std::vector<residual_test> residual;                 ///< per joint; empty without parameters
    std::optional<instrument_test> instruments;          ///< of iv
    std::optional<consistent_estimate> consistent = {};  ///< of cwls
    Eigen::VectorXd scatter_deviations = {};             ///< of wls on averaged periods whose torque scatters
    std::string start;       ///< where the iterations began, one phrase; empty without simulation
    std::string assumption;  ///< of the control law; empty if the declared one was simulated
};

/// Runs methods on the logs of one robot. What it is given must outlive it.
class method_runner {
  public:
    method_runner(const loaded_robot& robot, const std::string& robot_file, const std::vector<idim::log>& logs,
                  const filter_choice& filter, const method_request& request);
    /// On averaged periods alone, for methods that do not simulate.
    method_runner(const loaded_robot& robot, const std::string& robot_file, periodic_logs periods,
                  const filter_choice& filter, const method_request& request);

    /// Rows of the methods that do not simulate; where they depend on the parameters (fit_rows) those of the weighted
    /// least squares estimate. Throws data_error if they do not settle.
    observation all_rows() const;
    /// Rows without the transient of the simulated loop, which methods are to be compared on. Throws data_error if
    /// least squares, which they start from, finds a parameter that is not excited.
    observation steady_rows();
    /// `rows`: steady_rows() for a method that simulates, either for the others.
    method_result run(const std::string& method, const observation& rows);
    /// The periods of the logs, taken from it, so that it runs no more; nothing if the user did not ask for them.
    std::optional<periodic_logs> release_periods() { return std::move(periods_); }

  private:
    struct start_point {
        Eigen::VectorXd chi;
        std::string name;
    };

    loop_experiment experiment() const;
    const simulated_loops& loops();
    observation fitted(const std::vector<filtered_samples>& samples) const;
    bool whitens(const std::string& method) const;
    estimate least_squares_of(const std::string& method, const observation& rows, method_result& result) const;
    consistent_estimate consistent_of(const observation& rows) const;
    start_point start_for(const observation& rows) const;
    loop_estimate simulate(const std::string& method, const observation& rows, const start_point& start);

    const loaded_robot& robot_;
    const std::string& robot_file_;
    const std::vector<idim::log>* logs_ = nullptr;  ///< none on averaged periods alone
    const filter_choice& filter_;
    const method_request& request_;
    std::optional<simulated_loops> loops_;
    std::optional<periodic_logs> periods_;
};

}  // namespace idim::cli
