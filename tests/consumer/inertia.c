/* A program of a user, in C: inertia Q2 prints M11, M12 and M22 of the SCARA with its second joint at Q2. */
#include <stdio.h>
#include <stdlib.h>

#include "scara/scara.h"

int main(int argc, char** argv) {
    /* Janot, Vandanjon and Gautier (2010): in the order of scara_base_parameter_names. */
    const float chi[SCARA_BASE_PARAMETERS] = {3.44f, 0.03f, 0.82f, 0.062f, 0.242f, 0.014f, 0.013f, 0.137f};
    float q[SCARA_DOF] = {0.0f, 0.0f};
    float M[SCARA_DOF * SCARA_DOF];
    if (argc != 2) {
        fprintf(stderr, "usage: inertia Q2\n");
        return 2;
    }
    q[1] = strtof(argv[1], NULL);
    scara_mass_matrix_f(q, chi, M);
    printf("%.5g %.5g %.5g\n", (double)M[0], (double)M[1], (double)M[3]);
    return 0;
}
