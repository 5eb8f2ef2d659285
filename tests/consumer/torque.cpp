// A user's program: torque LOG.csv prints what the SCARA's motors have to give along a motion.
#include <array>
#include <cstdio>
#include <exception>

#include "idim/log.hpp"
#include "scara/inverse_dynamics.hpp"
#include "scara/model.hpp"

namespace {

namespace scara = idim_models::scara;

// Janot, Vandanjon and Gautier (2010): in the order of scara::base_parameter_names, which is checked below.
constexpr std::array<double, 8> chi = {3.44, 0.03, 0.82, 0.062, 0.242, 0.014, 0.013, 0.137};
static_assert(chi.size() == scara::base_parameters);

void print_torques(const idim::log& motion) {
    for (Eigen::Index k = 0; k < motion.samples(); ++k) {
        const Eigen::VectorXd q = motion.q.row(k), qd = motion.qd.row(k), qdd = motion.qdd.row(k);
        std::array<double, scara::dof> tau{};
        scara::inverse_dynamics(q.data(), qd.data(), qdd.data(), chi.data(), tau.data());
        std::printf("%.6g %.6g\n", tau[0], tau[1]);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: torque LOG.csv\n");
        return 2;
    }
    try {
        idim::log_columns columns;
        columns.joint_names.assign(scara::joint_names.begin(), scara::joint_names.end());
        columns.drive_gain.assign(scara::dof, 0.0);
        columns.torque_required = false;
        print_torques(idim::read_log(argv[1], columns));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "torque: %s\n", error.what());
        return 2;
    }
    return 0;
}
