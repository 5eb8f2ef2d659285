#include "idim/excitation_search.hpp"

#include <nlopt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "excitation/excitation_problem.hpp"
#include "uniform_numbers.hpp"

namespace idim {

namespace {

/// Between the samples of the search a motion may go further by as much.
constexpr double kept_distance = -0.002;
constexpr double largest_coefficient = 1.3;  // 4 / pi: no bounded motion has a larger one

using clock = std::chrono::steady_clock;

/// A motion within the limits, and how good it is: smaller is better.
struct candidate {
    double badness = 0.0;
    Eigen::VectorXd u;
};

class search {
  public:
    search(const limited_robot& robot, const excitation_plan& form, const search_options& options)
        : robot_(robot), form_(form), options_(options), problem_(robot, form.series.period, options) {}

    search_result run();

    static double objective(unsigned size, const double* u, double* gradient, void* self);
    static void constraints(unsigned rows, double* values, unsigned size, const double* u, double* gradient,
                            void* self);

  private:
    struct optimiser_deleter {
        void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
    };
    using optimiser_handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, optimiser_deleter>;

    const problem_value& at(unsigned size, const double* u);
    void consider(const Eigen::VectorXd& u, const problem_value& value);
    void consider_reduced(const Eigen::VectorXd& u, double breach);
    void finish_start();
    bool proceeds();
    double seconds() const { return std::chrono::duration<double>(clock::now() - begin_).count(); }
    Eigen::VectorXd improve(Eigen::VectorXd u, const smoothing& form, int evaluations);
    std::optional<excitation_plan> plan_of(const Eigen::VectorXd& u);

    const limited_robot& robot_;
    const excitation_plan& form_;
    const search_options& options_;
    excitation_problem problem_;
    const clock::time_point begin_ = clock::now();
    nlopt_opt optimiser_ = nullptr;
    smoothing smoothing_;
    Eigen::VectorXd u_;
    problem_value value_;
    std::optional<candidate> of_start_;
    double best_ = std::numeric_limits<double>::infinity();
    search_progress progress_;
    search_result result_;
};

double search::objective(unsigned size, const double* u, double* gradient, void* self) {
    const problem_value& value = static_cast<search*>(self)->at(size, u);
    if (gradient != nullptr) {
        std::copy(value.gradient.begin(), value.gradient.end(), gradient);
    }
    return value.objective;
}

void search::constraints(unsigned rows, double* values, unsigned size, const double* u, double* gradient, void* self) {
    const problem_value& value = static_cast<search*>(self)->at(size, u);
    std::copy_n(value.constraints.data(), rows, values);
    if (gradient != nullptr) {
        std::copy_n(value.jacobian.data(), static_cast<std::size_t>(rows) * size, gradient);
    }
}

/// The optimiser asks for objective and constraints at the same place one after the other.
const problem_value& search::at(unsigned size, const double* u) {
    const Eigen::Map<const Eigen::VectorXd> asked(u, size);
    if (u_.size() != asked.size() || u_ != asked) {
        u_ = asked;
        value_ = problem_.evaluate(u_, smoothing_);
        ++progress_.evaluations;
        consider(u_, value_);
        if (!proceeds()) {
            nlopt_force_stop(optimiser_);
        }
    }
    return value_;
}

void search::consider(const Eigen::VectorXd& u, const problem_value& value) {
    const double badness = options_.criterion == excitation_criterion::information ? -value.figure : value.figure;
    if (!std::isfinite(badness) || value.breach > kept_distance) {
        consider_reduced(u, value.breach);
        return;
    }
    if (!of_start_ || badness < of_start_->badness) {
        of_start_ = candidate{badness, u};
        if (std::isnan(progress_.best) || badness < best_) {
            progress_.best = value.figure;
        }
    }
}

/// The motion on the way from rest to one beyond the limits that keeps them, where it could be the best.
void search::consider_reduced(const Eigen::VectorXd& u, double breach) {
    constexpr int most_reductions = 3;
    double factor = 1.0;
    for (int k = 0; k < most_reductions && std::isfinite(breach); ++k) {
        factor /= 1.0 + std::max(breach - kept_distance, 0.001) + 0.001;
        const Eigen::VectorXd reduced = problem_.reduced(u, form_.rest, factor);
        const problem_value value = problem_.figure(reduced);
        if (value.breach <= kept_distance) {
            consider(reduced, value);
            return;
        }
        breach = value.breach;
    }
}

bool search::proceeds() {
    progress_.seconds = seconds();
    result_.out_of_time = result_.out_of_time || progress_.seconds > options_.seconds;
    result_.stopped = result_.stopped || (options_.proceed && !options_.proceed(progress_));
    return !result_.out_of_time && !result_.stopped;
}

Eigen::VectorXd search::improve(Eigen::VectorXd u, const smoothing& form, int evaluations) {
    const auto size = static_cast<unsigned>(u.size());
    const optimiser_handle optimiser(nlopt_create(NLOPT_LD_SLSQP, size));
    const std::vector<double> tolerance(static_cast<std::size_t>(problem_.constraints()), 1e-6);
    nlopt_set_min_objective(optimiser.get(), &search::objective, this);
    nlopt_add_inequality_mconstraint(optimiser.get(), static_cast<unsigned>(tolerance.size()), &search::constraints,
                                     this, tolerance.data());
    nlopt_set_lower_bounds1(optimiser.get(), -largest_coefficient);
    nlopt_set_upper_bounds1(optimiser.get(), largest_coefficient);
    nlopt_set_maxeval(optimiser.get(), evaluations);
    nlopt_set_ftol_rel(optimiser.get(), 1e-5);
    optimiser_ = optimiser.get();
    smoothing_ = form;
    u_.resize(0);
    double reached = 0.0;
    // How it ended is of no interest: what it passed by was noted.
    nlopt_optimize(optimiser.get(), u.data(), &reached);
    optimiser_ = nullptr;
    return u;
}

/// The motion with its connections, reduced a little where between samples or in a connection it breaks a limit.
std::optional<excitation_plan> search::plan_of(const Eigen::VectorXd& u) {
    for (const double factor : {1.0, 0.995, 0.99, 0.98, 0.96, 0.93, 0.9}) {
        excitation_plan plan = form_;
        plan.series = problem_.series(problem_.reduced(u, form_.rest, factor));
        choose_start(robot_, plan);
        const limit_breach breach = largest_breach(robot_, plan);
        if (breach.share <= 0.0) {
            return plan;
        }
        if (result_.breach.limit.empty() || breach.share < result_.breach.share) {
            result_.breach = breach;
        }
    }
    return std::nullopt;
}

void search::finish_start() {
    if (!of_start_ || of_start_->badness >= best_) {
        return;
    }
    if (const std::optional<excitation_plan> plan = plan_of(of_start_->u)) {
        result_.found = true;
        result_.plan = *plan;
        best_ = of_start_->badness;
    }
}

search_result search::run() {
    uniform_numbers uniform(options_.seed);
    progress_.starts = options_.starts;
    progress_.best = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < options_.starts && proceeds(); ++k) {
        progress_.start = ++result_.starts;
        progress_.evaluations = 0;
        of_start_.reset();
        Eigen::VectorXd u = problem_.start(form_.rest, uniform.vector(problem_.variables()));
        consider(u, problem_.evaluate(u, smoothing{}));
        u = improve(u, {2.0, 60.0}, options_.evaluations / 3);
        if (of_start_ && proceeds()) {
            u = of_start_->u;
        }
        u = proceeds() ? improve(u, {8.0, 200.0}, options_.evaluations - options_.evaluations / 3) : u;
        if (!of_start_) {
            plan_of(u);  // notes what it breaks
        }
        finish_start();
    }
    return result_;
}

}  // namespace

search_result search_excitation(const limited_robot& robot, const excitation_plan& form,
                                const search_options& options) {
    return search(robot, form, options).run();
}

}  // namespace idim
