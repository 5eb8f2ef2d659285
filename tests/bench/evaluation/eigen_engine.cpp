#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "evaluation/engine.hpp"

namespace idim::bench {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using columns = Eigen::Matrix<double, 3, 10>;

Matrix3d skew(const Vector3d& v) {
    Matrix3d S;
    S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return S;
}

/// L(v) with J v = L(v) (XX XY XZ YY YZ ZZ).
Eigen::Matrix<double, 3, 6> inertia_times(const Vector3d& v) {
    Eigen::Matrix<double, 3, 6> L;
    L << v.x(), v.y(), v.z(), 0, 0, 0, 0, v.x(), 0, v.y(), v.z(), 0, 0, 0, v.x(), 0, v.y(), v.z();
    return L;
}

/// One link with its joint: constants and what the recursion fills in.
struct body {
    test::mdh_row row;
    double mass = 0.0;
    Vector3d MS = Vector3d::Zero();
    Matrix3d J = Matrix3d::Zero();           ///< at the origin of the link's frame
    Matrix3d before = Matrix3d::Identity();  ///< Rot(z,gamma) Rot(x,alpha)
    Matrix3d R = Matrix3d::Identity();
    Vector3d p = Vector3d::Zero(), w = p, wd = p, vd = p;
};

class recursive : public engine {
  public:
    explicit recursive(const rigid_robot& robot)
        : gravity_(robot.table.gravity[0], robot.table.gravity[1], robot.table.gravity[2]) {
        for (std::size_t j = 0; j < robot.links.size(); ++j) {
            body b;
            b.row = robot.table.rows[j];
            const test::rigid_link& link = robot.links[j];
            b.mass = link.mass;
            b.MS = link.mass * link.centre;
            b.J = link.central_inertia - link.mass * skew(link.centre) * skew(link.centre);
            b.before =
                (Eigen::AngleAxisd(b.row.gamma, Vector3d::UnitZ()) * Eigen::AngleAxisd(b.row.alpha, Vector3d::UnitX()))
                    .toRotationMatrix();
            bodies_.push_back(b);
        }
        scratch_.resize(static_cast<Eigen::Index>(bodies_.size()));
    }

    std::string name() const override { return "Eigen, by hand"; }

    void inverse_dynamics(const test::joint_state& s, Eigen::VectorXd& tau) override {
        place(s.q);
        newton_euler(s.qd, s.qdd, -gravity_, tau);
    }

    /// Column j is the torque of a unit acceleration of joint j.
    void mass_matrix(const Eigen::VectorXd& q, row_major& M) override {
        place(q);
        inertia(M);
    }

    void forward_dynamics(const test::joint_state& s, const Eigen::VectorXd& tau, Eigen::VectorXd& qdd) override {
        place(s.q);
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(s.q.size());
        row_major M(s.q.size(), s.q.size());
        inertia(M);
        Eigen::VectorXd bias(s.q.size());
        newton_euler(s.qd, zero, -gravity_, bias);
        qdd = M.llt().solve(tau - bias);
    }

    /// Standard regressor: the wrench of every parameter carried inward.
    bool regressor(const test::joint_state& s, row_major& W) override {
        const auto n = static_cast<Eigen::Index>(bodies_.size());
        W.setZero(n, 10 * n);
        place(s.q);
        outward(s.qd, s.qdd, -gravity_);
        for (Eigen::Index j = 0; j < n; ++j) {
            const body& b = bodies_[static_cast<std::size_t>(j)];
            columns f, m;
            f << Eigen::Matrix<double, 3, 6>::Zero(), skew(b.wd) + skew(b.w) * skew(b.w), b.vd;
            m << inertia_times(b.wd) + skew(b.w) * inertia_times(b.w), -skew(b.vd), Vector3d::Zero();
            for (Eigen::Index i = j; i >= 0; --i) {
                const body& at = bodies_[static_cast<std::size_t>(i)];
                W.block(i, 10 * j, 1, 10) = at.row.prismatic ? f.row(2) : m.row(2);
                f = at.R * f;
                m = at.R * m + skew(at.p) * f;
            }
        }
        return true;
    }

    Eigen::VectorXd parameters() const override {
        Eigen::VectorXd values(static_cast<Eigen::Index>(10 * bodies_.size()));
        Eigen::Index k = 0;
        for (const body& b : bodies_) {
            values.segment(k, 10) << b.J(0, 0), b.J(0, 1), b.J(0, 2), b.J(1, 1), b.J(1, 2), b.J(2, 2), b.MS, b.mass;
            k += 10;
        }
        return values;
    }

  private:
    void place(const Eigen::VectorXd& q) {
        for (std::size_t j = 0; j < bodies_.size(); ++j) {
            body& b = bodies_[j];
            const double theta = b.row.theta + (b.row.prismatic ? 0.0 : q[static_cast<Eigen::Index>(j)]);
            const double r = b.row.r + (b.row.prismatic ? q[static_cast<Eigen::Index>(j)] : 0.0);
            const double c = std::cos(theta);
            const double s = std::sin(theta);
            Matrix3d turn;
            turn << c, -s, 0, s, c, 0, 0, 0, 1;
            b.R = b.before * turn;
            b.p = b.before * Vector3d(b.row.d, 0.0, r);
            b.p.z() += b.row.b;
        }
    }

    void outward(const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd, const Vector3d& vd0) {
        Vector3d w = Vector3d::Zero();
        Vector3d wd = Vector3d::Zero();
        Vector3d vd = vd0;
        for (std::size_t j = 0; j < bodies_.size(); ++j) {
            body& b = bodies_[j];
            const double rate = qd[static_cast<Eigen::Index>(j)];
            const double acceleration = qdd[static_cast<Eigen::Index>(j)];
            b.vd = b.R.transpose() * (vd + wd.cross(b.p) + w.cross(w.cross(b.p)));
            b.w = b.R.transpose() * w;
            b.wd = b.R.transpose() * wd;
            if (b.row.prismatic) {
                b.vd += 2.0 * b.w.cross(rate * Vector3d::UnitZ()) + acceleration * Vector3d::UnitZ();
            } else {
                b.wd += b.w.cross(rate * Vector3d::UnitZ()) + acceleration * Vector3d::UnitZ();
                b.w.z() += rate;
            }
            w = b.w;
            wd = b.wd;
            vd = b.vd;
        }
    }

    void newton_euler(const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd, const Vector3d& vd0,
                      Eigen::VectorXd& tau) {
        outward(qd, qdd, vd0);
        Vector3d f = Vector3d::Zero();
        Vector3d m = Vector3d::Zero();
        for (std::size_t j = bodies_.size(); j-- > 0;) {
            const body& b = bodies_[j];
            f += b.mass * b.vd + b.wd.cross(b.MS) + b.w.cross(b.w.cross(b.MS));
            m += b.J * b.wd + b.w.cross(b.J * b.w) + b.MS.cross(b.vd);
            tau[static_cast<Eigen::Index>(j)] = b.row.prismatic ? f.z() : m.z();
            f = b.R * f;
            m = b.R * m + b.p.cross(f);
        }
    }

    void inertia(row_major& M) {
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(scratch_.size());
        for (Eigen::Index j = 0; j < scratch_.size(); ++j) {
            newton_euler(zero, Eigen::VectorXd::Unit(scratch_.size(), j), Vector3d::Zero(), scratch_);
            M.col(j) = scratch_;
        }
    }

    Vector3d gravity_;
    std::vector<body> bodies_;
    Eigen::VectorXd scratch_;
};

}  // namespace

std::unique_ptr<engine> eigen_engine(const rigid_robot& robot) {
    return std::make_unique<recursive>(robot);
}

}  // namespace idim::bench
