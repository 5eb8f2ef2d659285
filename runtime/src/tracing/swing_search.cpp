#include "swing_search.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <type_traits>

#include "idim/recorded_states.hpp"
#include "idim/zero_phase_filter.hpp"
#include "swing_start.hpp"

namespace idim {

namespace {

constexpr double slowest_swing = 3.0;      // Hz: a robot whose links swing slower is none that one would identify
constexpr double share_of_sampling = 0.4;  // what swings faster follows at rest
constexpr double frequency_ratio = 1.1;    // of neighbours of the grid
constexpr double usual_damping_ratio = 0.05;
constexpr double least_damping_ratio_tried = 0.01;
constexpr double most_damping_ratio = 1.0;
constexpr double most_rotor_share = 0.95;  // of the least inertia of rotor and link
constexpr double worth_refining = 10.0;    // of the loss, in variances of a row

double rotor_of(const Eigen::VectorXd& shape) {
    return shape.size() > 2 ? shape[2] : 0.0;
}

twist_motion twist_of(const traced_log& log, int joint, const Eigen::VectorXd& shape) {
    const Eigen::Index diagonal = joint * log.tau_rigid.cols() + joint;
    const double rotor = rotor_of(shape);
    const swing_dynamics link{log.tau_rigid.col(joint) - rotor * log.samples.qdd.col(joint),
                              log.inertia.col(diagonal).array() - rotor};
    const std::vector<soft_transmission> soft = {{joint, shape[0], shape[1]}};
    const double rate = log.samples.rate;
    const twist_state slow = slow_start(link, soft, rate);
    const Eigen::Index count = free_samples(link, soft, rate);
    const swing_dynamics head{link.forcing.topRows(count), link.inertia.topRows(count)};
    const Eigen::MatrixXd acceleration = swing(head, soft, rate, slow).acceleration;
    const Eigen::MatrixXd lacking =
        (log.samples.tau.col(joint) - log.tau_model.col(joint)).head(count) + head.inertia.cwiseProduct(acceleration);
    return swing(link, soft, rate, slow + free_start(head, soft, rate, lacking));
}

/// Rows of the largest part of a twist's torque, that of the inertia, from the acceleration filtered once: inertias
/// change slowly.
class quick_twist {
  public:
    quick_twist(const traced_log& log, int twisted, const Eigen::VectorXd& shape)
        : log_(log),
          twisted_(twisted),
          rotor_(rotor_of(shape)),
          filtered_(decimate(twist_of(log, twisted, shape).acceleration, log.decimation)) {}

    Eigen::VectorXd operator()(int joint) const {
        const Eigen::Index column = twisted_ * log_.tau_rigid.cols() + joint;
        const double rotor = joint == twisted_ ? rotor_ : 0.0;
        const std::vector<Eigen::Index>& kept = log_.rows.kept[static_cast<std::size_t>(joint)];
        Eigen::VectorXd rows(static_cast<Eigen::Index>(kept.size()));
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const Eigen::Index sample = std::min(kept[k] * log_.decimation, log_.inertia.rows() - 1);
            rows[static_cast<Eigen::Index>(k)] = (rotor - log_.inertia(sample, column)) * filtered_(kept[k]);
        }
        return rows;
    }

  private:
    const traced_log& log_;
    int twisted_;
    double rotor_;
    Eigen::VectorXd filtered_;
};

using objective = std::function<double(const double*)>;

struct optimiser_deleter {
    void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
};
using optimiser_handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, optimiser_deleter>;

double call(unsigned /*size*/, const double* x, double* /*gradient*/, void* function) {
    return (*static_cast<const objective*>(function))(x);
}

/// A variable of a search: how far it may go, how far it goes at first, and how well it has to be known.
struct search_range {
    double low;
    double high;
    double step;
    double precision;
};

/// The largest value of `gain` near x by quadratic interpolation (Powell 2009, BOBYQA).
void climb(objective gain, const std::vector<search_range>& ranges, Eigen::VectorXd& x) {
    constexpr int most_evaluations = 80;
    const optimiser_handle optimiser(nlopt_create(NLOPT_LN_BOBYQA, static_cast<unsigned>(ranges.size())));
    const auto all = [&](double search_range::*which) {
        std::vector<double> values;
        for (const search_range& range : ranges) {
            values.push_back(range.*which);
        }
        return values;
    };
    nlopt_set_max_objective(optimiser.get(), call, &gain);
    nlopt_set_lower_bounds(optimiser.get(), all(&search_range::low).data());
    nlopt_set_upper_bounds(optimiser.get(), all(&search_range::high).data());
    nlopt_set_initial_step(optimiser.get(), all(&search_range::step).data());
    nlopt_set_xtol_abs(optimiser.get(), all(&search_range::precision).data());
    nlopt_set_maxeval(optimiser.get(), most_evaluations);
    double reached = 0.0;
    nlopt_optimize(optimiser.get(), x.data(), &reached);  // the best point so far, however it ends
}

}  // namespace

Eigen::MatrixXd twist_torques(const idim_model_interface& model, const traced_log& log, int joint,
                              const Eigen::VectorXd& shape) {
    const twist_motion twist = twist_of(log, joint, shape);
    filtered_samples link = log.samples;
    link.q.col(joint) -= twist.angle;
    link.qd.col(joint) -= twist.rate;
    link.qdd.col(joint) -= twist.acceleration;
    Eigen::MatrixXd changed = model_torques(model, link, log.chi_rigid) - log.tau_rigid;
    changed.col(joint) += rotor_of(shape) * twist.acceleration;  // the rotor has not moved with the link
    return changed;
}

/// A swing as it is searched: frequency and damping ratio of the mean link, and the rotor's share of the least inertia.
struct swing_search::search_point {
    double frequency;  ///< [Hz]
    double damping_ratio;
    double rotor_share;
};

swing_search::swing_search(const idim_model_interface& model, const trace_fit& fit, int joint, bool rotor_is_lumped)
    : model_(model), fit_(fit), joint_(joint), rotor_is_lumped_(rotor_is_lumped) {
    double sum = 0.0;
    double samples = 0.0;
    for (std::size_t l = 0; l < fit.logs().size(); ++l) {
        const traced_log& log = fit.logs()[l];
        if (!log.held_back) {
            const auto inertia = log.inertia.col(joint * log.tau_rigid.cols() + joint);
            logs_.push_back(l);
            sum += inertia.sum();
            samples += static_cast<double>(inertia.size());
            least_inertia_ = std::min(least_inertia_, inertia.minCoeff());
            fastest_ = std::min(fastest_, share_of_sampling * log.samples.rate);
        }
    }
    mean_inertia_ = sum / samples;
}

Eigen::VectorXd swing_search::shape_at(const search_point& at) const {
    const double rotor = at.rotor_share * least_inertia_;
    const double link = mean_inertia_ - rotor;
    const double w = 2.0 * M_PI * at.frequency;
    Eigen::VectorXd shape(rotor_is_lumped_ ? 3 : 2);
    shape.head(2) << link * w * w, 2.0 * at.damping_ratio * link * w;
    shape.tail(shape.size() - 2).setConstant(rotor);
    return shape;
}

swing_search::search_point swing_search::point_of(const Eigen::VectorXd& shape) const {
    const double share = std::clamp(rotor_of(shape) / least_inertia_, 0.0, most_rotor_share);
    const double link = mean_inertia_ - share * least_inertia_;
    return {std::sqrt(shape[0] / link) / (2.0 * M_PI),
            std::clamp(0.5 * shape[1] / std::sqrt(shape[0] * link), least_damping_ratio_tried, most_damping_ratio),
            share};
}

std::vector<double> swing_search::frequencies() const {
    const double steps = std::max(0.0, std::log(fastest_ / slowest_swing)) / std::log(frequency_ratio);
    std::vector<double> values(static_cast<std::size_t>(1.0 + steps), slowest_swing);
    for (std::size_t i = 1; i < values.size(); ++i) {
        values[i] = frequency_ratio * values[i - 1];
    }
    return values;
}

std::vector<double> swing_search::rotor_shares() const {
    return rotor_is_lumped_ ? std::vector<double>{0.0, 0.25, 0.5, 0.75} : std::vector<double>{0.0};
}

int swing_search::shapes() const {
    return static_cast<int>(frequencies().size() * rotor_shares().size());
}

Eigen::VectorXd swing_search::best() const {
    search_point best{slowest_swing, usual_damping_ratio, 0.0};
    double most = -std::numeric_limits<double>::infinity();
    for (const double share : rotor_shares()) {
        for (const double frequency : frequencies()) {
            const search_point here{frequency, usual_damping_ratio, share};
            if (const double found = quick_gain(shape_at(here)); found > most) {
                most = found;
                best = here;
            }
        }
    }
    return most > worth_refining ? refined(shape_at(best)) : shape_at(best);
}

Eigen::VectorXd swing_search::refined(const Eigen::VectorXd& start) const {
    const search_point from = point_of(start);
    const double f = std::log(from.frequency);
    const double reach = 3.0 * std::log(frequency_ratio);
    std::vector<search_range> ranges = {
        {f - reach, f + reach, 0.5 * std::log(frequency_ratio), 1e-4},
        {std::log(least_damping_ratio_tried), std::log(most_damping_ratio), 0.5, 1e-2},
    };
    Eigen::VectorXd x(2);
    x << f, std::log(from.damping_ratio);
    if (rotor_is_lumped_) {
        ranges.push_back({0.0, most_rotor_share, 0.1, 1e-3});
        x.conservativeResize(3);
        x[2] = from.rotor_share;
    }
    const auto shape = [&](const double* at) {
        return shape_at({std::exp(at[0]), std::exp(at[1]), rotor_is_lumped_ ? at[2] : 0.0});
    };
    climb([&](const double* at) { return exact_gain(shape(at)); }, ranges, x);
    return exact_gain(shape(x.data())) > exact_gain(start) ? shape(x.data()) : start;
}

double swing_search::quick_gain(const Eigen::VectorXd& shape) const {
    return gain_by([&](const traced_log& log) { return quick_twist(log, joint_, shape); });
}

double swing_search::exact_gain(const Eigen::VectorXd& shape) const {
    return gain_by([&](const traced_log& log) {
        return [&log, torques = twist_torques(model_, log, joint_, shape)](int joint) {
            return Eigen::VectorXd(rows_of(log, joint, torques.col(joint)));
        };
    });
}

/// Decrease of the loss by rows of coefficient one that a function of the log gives for every joint.
template <class RowsOfLog>
double swing_search::gain_by(const RowsOfLog& rows_of_log) const {
    Eigen::VectorXd on_basis = Eigen::VectorXd::Zero(fit_.parameters());
    double square = 0.0;
    double product = 0.0;
    for (const std::size_t l : logs_) {
        const auto rows = rows_of_log(fit_.logs()[l]);
        for (std::size_t j = 0; j < fit_.weight()[l].size(); ++j) {
            const int joint = static_cast<int>(j);
            const Eigen::VectorXd& weight = fit_.weight()[l][j];
            const Eigen::VectorXd X = weight.cwiseProduct(rows(joint));
            on_basis += fit_.basis(l, joint).transpose() * X;
            square += X.squaredNorm();
            product += X.dot(weight.cwiseProduct(fit_.residual()[l][j]));
        }
    }
    return 2.0 * product - (square - on_basis.squaredNorm());
}

}  // namespace idim
