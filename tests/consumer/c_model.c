/* A C program that uses the C model of a robot as firmware would. Exit state 0 where its torques are those of the
 * closed form. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scara_c/scara.h"

static const double length = 0.5; /* of the first link [m] */

/* Two parallel axes without gravity, motor of the second joint turning with both: by hand from the Lagrangian. */
static void closed_form(const double q[2], const double qd[2], const double qdd[2], const double chi[8],
                        double tau[2]) {
    const double mx = chi[4], my = chi[5];
    const double coupling = length * (mx * cos(q[1]) - my * sin(q[1]));
    const double slope = -length * (mx * sin(q[1]) + my * cos(q[1]));
    tau[0] = (chi[0] + chi[3] + 2.0 * coupling) * qdd[0] + (chi[3] + coupling) * qdd[1] +
             slope * qd[1] * (2.0 * qd[0] + qd[1]) + chi[1] * qd[0] + chi[2] * (qd[0] > 0.0 ? 1.0 : -1.0);
    tau[1] = (chi[3] + coupling) * qdd[0] + chi[3] * qdd[1] - slope * qd[0] * qd[0] + chi[6] * qd[1] +
             chi[7] * (qd[1] > 0.0 ? 1.0 : -1.0);
}

int main(void) {
    const double chi[SCARA_BASE_PARAMETERS] = {3.44, 0.03, 0.82, 0.062, 0.242, 0.014, 0.013, 0.137};
    float chi_f[SCARA_BASE_PARAMETERS];
    int wrong = strcmp(scara_base_parameter_names[0], "ZZ1R") != 0;
    int k, j;
    for (j = 0; j < SCARA_BASE_PARAMETERS; ++j) {
        chi_f[j] = (float)chi[j];
    }
    for (k = 0; k < 100; ++k) {
        const double q[2] = {0.1 * k, 1.0 - 0.07 * k}, qd[2] = {0.4 - 0.03 * k, 0.2 + 0.02 * k},
                     qdd[2] = {1.5, 0.1 * k - 3.0};
        const float q_f[2] = {(float)q[0], (float)q[1]}, qd_f[2] = {(float)qd[0], (float)qd[1]};
        const float qdd_f[2] = {(float)qdd[0], (float)qdd[1]};
        double expected[2], tau[2], sc[SCARA_SINES], tau_sc[2];
        float tau_f[2];
        closed_form(q, qd, qdd, chi, expected);
        scara_inverse_dynamics(q, qd, qdd, chi, tau);
        scara_sines(q, sc);
        scara_inverse_dynamics_sc(q, sc, qd, qdd, chi, tau_sc);
        scara_inverse_dynamics_f(q_f, qd_f, qdd_f, chi_f, tau_f);
        for (j = 0; j < 2; ++j) {
            /* some ten roundings of numbers up to 20: 1e-16 of them each, and 6e-8 in single precision (qd is never
             * near zero) */
            if (fabs(tau[j] - expected[j]) > 1e-13 || tau_sc[j] != tau[j] ||
                fabs((double)tau_f[j] - expected[j]) > 1e-4) {
                printf("sample %d, joint %d: %.17g %.17g %.9g, expected %.17g\n", k, j + 1, tau[j], tau_sc[j],
                       (double)tau_f[j], expected[j]);
                wrong = 1;
            }
        }
    }
    return wrong;
}
