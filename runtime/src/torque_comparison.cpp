#include "idim/torque_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "uniform_numbers.hpp"

namespace idim {

namespace {

struct motion_state {
    Eigen::VectorXd q, qd, qdd, temp;
    double t = 0.0;
};

/// The state as the signals of a model: effects in the states in which a motion begins, motors with
/// their links.
Eigen::VectorXd signals_of(const idim_model_interface& model, const motion_state& s) {
    const Eigen::Index n = model.dof;
    Eigen::VectorXd signals = Eigen::VectorXd::Zero(std::max(model.dof, model.n_signals));
    signals.head(n) = s.temp;
    const Eigen::Index motor = n + model.n_states;
    if (signals.size() >= motor + 3 * n) {
        signals.segment(motor, 3 * n) << s.q, s.qd, s.qdd;
    }
    if (model.n_states > 0) {
        Eigen::VectorXd first(model.n_states);
        model.first_states(s.q.data(), s.qd.data(), s.qdd.data(), s.t, signals.data(), first.data());
        signals.segment(n, model.n_states) = first;
    }
    return signals;
}

motion_state random_state(uniform_numbers& random, const std::vector<joint_range>& ranges) {
    const auto n = static_cast<Eigen::Index>(ranges.size());
    motion_state s{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), 0.0};
    for (Eigen::Index j = 0; j < n; ++j) {
        const joint_range& range = ranges[static_cast<std::size_t>(j)];
        s.q[j] = random.between(range.q_min, range.q_max);
        s.qd[j] = random.between(-range.qd_max, range.qd_max);
        s.qdd[j] = random.between(-range.qdd_max, range.qdd_max);
        s.temp[j] = random.between(0.0, 60.0);
    }
    s.t = random.between(0.0, 100.0);
    return s;
}

using value_table = std::map<std::string, double>;

Eigen::VectorXd regrouped(const idim_model_interface& model, const value_table& values) {
    Eigen::VectorXd standard(model.n_standard);
    for (int s = 0; s < model.n_standard; ++s) {
        const auto found = values.find(model.standard_names[s]);
        standard[s] = found == values.end() ? 0.0 : found->second;
    }
    Eigen::VectorXd chi(model.n_base);
    model.regroup(standard.data(), chi.data());
    return chi;
}

Eigen::VectorXd torque(const idim_model_interface& model, const motion_state& s, const Eigen::VectorXd& chi) {
    Eigen::VectorXd tau(model.dof);
    const Eigen::VectorXd signals = signals_of(model, s);
    model.inverse_dynamics(s.q.data(), s.qd.data(), s.qdd.data(), s.t, signals.data(), chi.data(), tau.data());
    return tau;
}

std::vector<std::string> names_missing(const idim_model_interface& from, const idim_model_interface& in) {
    std::vector<std::string> result;
    for (int s = 0; s < from.n_standard; ++s) {
        const std::string name = from.standard_names[s];
        if (std::find(in.standard_names, in.standard_names + in.n_standard, name) ==
            in.standard_names + in.n_standard) {
            result.push_back(name);
        }
    }
    return result;
}

/// Distance of two torques; none where both fail alike, infinite where one is a number and the other is not.
double distance(double a, double b) {
    if (std::isfinite(a) && std::isfinite(b)) {
        return std::abs(a - b);
    }
    return std::isnan(a) == std::isnan(b) && (std::isnan(a) || a == b) ? 0.0 : std::numeric_limits<double>::infinity();
}

/// The joints that torques of a unit of one parameter, all others zero, are seen at.
std::vector<int> moved_joints(const idim_model_interface& model, const std::string& name,
                              const std::vector<joint_range>& ranges, std::uint64_t seed) {
    constexpr int states = 100;
    uniform_numbers random(seed);
    const Eigen::VectorXd chi = regrouped(model, {{name, 1.0}});
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(model.dof);
    for (int i = 0; i < states; ++i) {
        largest = largest.cwiseMax(torque(model, random_state(random, ranges), chi).cwiseAbs());
    }
    std::vector<int> joints;
    for (int j = 0; j < model.dof; ++j) {
        if (!(largest[j] <= torque_rounding * largest.maxCoeff())) {
            joints.push_back(j);
        }
    }
    return joints;
}

std::vector<one_sided_parameter> one_sided(const idim_model_interface& model, const idim_model_interface& other,
                                           const std::vector<joint_range>& ranges, std::uint64_t seed) {
    std::vector<one_sided_parameter> result;
    for (const std::string& name : names_missing(model, other)) {
        result.push_back({name, moved_joints(model, name, ranges, seed)});
    }
    return result;
}

/// The largest difference of each joint, then of all, absolutely and beside the largest torque of the joint.
class difference_record {
  public:
    explicit difference_record(int dof) : largest_(static_cast<std::size_t>(dof)), scale_(Eigen::VectorXd::Zero(dof)) {}

    void add(const motion_state& s, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
        for (Eigen::Index j = 0; j < before.size(); ++j) {
            torque_difference& largest = largest_[static_cast<std::size_t>(j)];
            const double difference = distance(before[j], after[j]);
            if (largest.q.size() == 0 || difference > largest.value) {
                largest = {difference, static_cast<int>(j), s.q, s.qd, s.qdd, before[j], after[j]};
            }
            for (const double tau : {before[j], after[j]}) {
                scale_[j] = std::isfinite(tau) ? std::max(scale_[j], std::abs(tau)) : scale_[j];
            }
        }
    }

    torque_difference absolute() const { return *std::max_element(largest_.begin(), largest_.end(), smaller); }

    torque_difference relative() const {
        std::vector<torque_difference> parts = largest_;
        for (torque_difference& part : parts) {
            part.value = part.value == 0.0 ? 0.0 : part.value / scale_[part.joint];
        }
        return *std::max_element(parts.begin(), parts.end(), smaller);
    }

  private:
    static bool smaller(const torque_difference& a, const torque_difference& b) { return a.value < b.value; }

    std::vector<torque_difference> largest_;
    Eigen::VectorXd scale_;
};

torque_verdict verdict_of(const torque_comparison& comparison) {
    if (comparison.absolute.value == 0.0) {
        return torque_verdict::same;
    }
    return comparison.relative.value <= torque_rounding ? torque_verdict::same_up_to_rounding
                                                        : torque_verdict::different;
}

}  // namespace

torque_comparison compare_torques(const idim_model_interface& before, const idim_model_interface& after,
                                  const std::vector<joint_range>& ranges, int states, std::uint64_t seed) {
    if (before.dof != after.dof || ranges.size() != static_cast<std::size_t>(before.dof) || states < 1) {
        throw std::logic_error("torques of models with different numbers of joints");
    }
    torque_comparison result;
    result.states = states;
    result.seed = seed;
    result.only_before = one_sided(before, after, ranges, seed);
    result.only_after = one_sided(after, before, ranges, seed);
    value_table values;
    for (int s = 0; s < before.n_standard; ++s) {
        values[before.standard_names[s]] = 0.0;
    }
    for (const one_sided_parameter& parameter : result.only_before) {
        values.erase(parameter.name);
    }
    uniform_numbers random(seed);
    difference_record differences(before.dof);
    for (int i = 0; i < states; ++i) {
        const motion_state s = random_state(random, ranges);
        for (auto& [name, value] : values) {
            value = random.between(-1.0, 1.0);
        }
        differences.add(s, torque(before, s, regrouped(before, values)), torque(after, s, regrouped(after, values)));
    }
    result.absolute = differences.absolute();
    result.relative = differences.relative();
    result.verdict = verdict_of(result);
    return result;
}

}  // namespace idim
