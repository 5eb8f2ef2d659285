#include "idim/excitation_plan.hpp"

#include <cmath>

namespace idim {

namespace {

Eigen::Index samples_in(double seconds, double rate) {
    return static_cast<Eigen::Index>(std::llround(seconds * rate));
}

struct joint_instant {
    Eigen::RowVectorXd q, qd, qdd;
};

joint_instant instant(const motion_samples& motion, Eigen::Index k) {
    return {motion.q.row(k), motion.qd.row(k), motion.qdd.row(k)};
}

/// Degree five from rest at `from` to `to` in `seconds`, at count + 1 instants, the last one that of `to`.
motion_samples connection(const Eigen::VectorXd& from, const joint_instant& to, double seconds, Eigen::Index count) {
    const Eigen::RowVectorXd far = to.q - from.transpose();
    const Eigen::RowVectorXd v = to.qd * seconds;
    const Eigen::RowVectorXd a = to.qdd * (seconds * seconds);
    const Eigen::RowVectorXd c3 = 10.0 * far - 4.0 * v + 0.5 * a;
    const Eigen::RowVectorXd c4 = -15.0 * far + 7.0 * v - a;
    const Eigen::RowVectorXd c5 = 6.0 * far - 3.0 * v + 0.5 * a;
    const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(count + 1, 0.0, 1.0);
    const Eigen::VectorXd s2 = s.cwiseAbs2();
    const Eigen::VectorXd s3 = s2.cwiseProduct(s);
    const Eigen::VectorXd s4 = s3.cwiseProduct(s);
    const Eigen::VectorXd s5 = s4.cwiseProduct(s);
    motion_samples motion;
    motion.t = seconds * s;
    motion.q = (s3 * c3 + s4 * c4 + s5 * c5).rowwise() + from.transpose();
    motion.qd = (3.0 * s2 * c3 + 4.0 * s3 * c4 + 5.0 * s4 * c5) / seconds;
    motion.qdd = (6.0 * s * c3 + 12.0 * s2 * c4 + 20.0 * s3 * c5) / (seconds * seconds);
    return motion;
}

/// The way out is the way in of the motion run backwards, run backwards.
motion_samples connection_out(const Eigen::VectorXd& rest, joint_instant from, double seconds, Eigen::Index count) {
    from.qd = -from.qd;
    const motion_samples back = connection(rest, from, seconds, count);
    return {back.t, back.q.colwise().reverse(), -back.qd.colwise().reverse(), back.qdd.colwise().reverse()};
}

limit_breach worse(const limit_breach& a, const limit_breach& b) {
    return a.share >= b.share ? a : b;
}

limit_breach breach_of_connections(const limited_robot& robot, const excitation_plan& plan, const joint_instant& at) {
    constexpr Eigen::Index instants = 200;
    if (plan.connection_time == 0.0) {
        return {-1.0, ""};
    }
    return worse(largest_breach(robot, connection(plan.rest, at, plan.connection_time, instants)),
                 largest_breach(robot, connection_out(plan.rest, at, plan.connection_time, instants)));
}

/// Puts the samples of a part, but for its last one where it is followed by another, behind what is there.
class reference_writer {
  public:
    reference_writer(log& reference, bool with_derivatives) : reference_(reference), all_(with_derivatives) {}

    void add(const motion_samples& motion, Eigen::Index first, Eigen::Index count) {
        reference_.qr.middleRows(at_, count) = motion.q.middleRows(first, count);
        if (all_) {
            reference_.qd.middleRows(at_, count) = motion.qd.middleRows(first, count);
            reference_.qdd.middleRows(at_, count) = motion.qdd.middleRows(first, count);
        }
        at_ += count;
    }
    void rest(const Eigen::VectorXd& q, Eigen::Index count) {
        reference_.qr.middleRows(at_, count).rowwise() = q.transpose();
        at_ += count;
    }

  private:
    log& reference_;
    bool all_;
    Eigen::Index at_ = 0;
};

}  // namespace

double excitation_plan::duration() const {
    return 2.0 * rest_time + 2.0 * connection_time + periods * series.period;
}

limit_breach choose_start(const limited_robot& robot, excitation_plan& plan) {
    constexpr Eigen::Index tried = 400;
    const Eigen::Index in_period = samples_in(plan.series.period, plan.rate);
    const motion_samples motion = sample_period(plan.series, in_period);
    plan.start = 0.0;
    limit_breach best = breach_of_connections(robot, plan, instant(motion, 0));
    for (Eigen::Index k = 1; k < tried && best.share > 0.0; ++k) {
        const Eigen::Index at = k * in_period / tried;
        const limit_breach breach = breach_of_connections(robot, plan, instant(motion, at));
        if (breach.share < best.share) {
            best = breach;
            plan.start = motion.t[at];
        }
    }
    return best;
}

limit_breach largest_breach(const limited_robot& robot, const excitation_plan& plan) {
    constexpr Eigen::Index least_samples = 4000;
    const Eigen::Index in_period = samples_in(plan.series.period, plan.rate);
    const motion_samples whole = sample_period(plan.series, samples_of_period(plan.series, least_samples));
    const motion_samples written = sample_period(plan.series, in_period);
    const Eigen::Index start = samples_in(plan.start, plan.rate) % in_period;
    return worse(largest_breach(robot, whole), breach_of_connections(robot, plan, instant(written, start)));
}

log reference_of(const excitation_plan& plan, bool with_derivatives) {
    const Eigen::Index in_rest = samples_in(plan.rest_time, plan.rate);
    const Eigen::Index in_connection = samples_in(plan.connection_time, plan.rate);
    const Eigen::Index in_period = samples_in(plan.series.period, plan.rate);
    const motion_samples period = sample_period(plan.series, in_period);
    const Eigen::Index start = samples_in(plan.start, plan.rate) % in_period;
    const Eigen::Index samples = 2 * (in_rest + in_connection) + plan.periods * in_period + 1;
    log reference;
    reference.t = Eigen::VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)) / plan.rate;
    for (Eigen::MatrixXd* signal : {&reference.qr, &reference.qd, &reference.qdd}) {
        if (signal == &reference.qr || with_derivatives) {
            signal->setZero(samples, plan.rest.size());
        }
    }
    reference_writer writer(reference, with_derivatives);
    writer.rest(plan.rest, in_rest);
    const joint_instant at = instant(period, start);
    if (in_connection > 0) {
        writer.add(connection(plan.rest, at, plan.connection_time, in_connection), 0, in_connection);
    }
    for (int k = 0; k < plan.periods; ++k) {
        writer.add(period, start, in_period - start);
        writer.add(period, 0, start);
    }
    if (in_connection > 0) {
        writer.add(connection_out(plan.rest, at, plan.connection_time, in_connection), 0, in_connection);
        writer.rest(plan.rest, in_rest + 1);
    } else {
        writer.add(period, start, 1);
        writer.rest(plan.rest, in_rest);
    }
    return reference;
}

}  // namespace idim
