/* A control law of one's own: a header beside the robot description, named there as `law: my_law.hpp`, that defines
 * `struct control_law` and is compiled in. It needs nothing but this file:
 *
 *     struct control_law {
 *         static constexpr const char* values[] = {"kp", "kd"};  // one number per joint each, from the description
 *
 *         void command(const idim_law_sample& s, double* v) {    // members are the law's memory
 *             for (int j = 0; j < s.n; ++j) {
 *                 v[j] = s.values[0][j] * (s.qr[j] - s.q[j]) + s.values[1][j] * (s.qdr[j] - s.qd[j]);
 *             }
 *         }
 *     };
 *
 * It is made by its default constructor before each motion and copied for loops that run side by side. Saturation and
 * delay are applied to what it commands; with `void limited(const double* wanted, const double* given)` it is told what
 * saturation left of that. Plain C, so that it can be loaded at run time. SI units, joint side. */
#ifndef IDIM_LAW_INTERFACE_H
#define IDIM_LAW_INTERFACE_H

#define IDIM_LAW_ABI 1

#ifdef __cplusplus
extern "C" {
#endif

/* What the controller knows at one of its samples; arrays of n joints. */
struct idim_law_sample {
    int n;
    double t;                    /* [s] */
    double period;               /* [s] of the sampling */
    const double* qr;            /* reference position [rad or m] */
    const double* qdr;           /* its velocity */
    const double* qddr;          /* its acceleration */
    const double* q;             /* measured position */
    const double* qd;            /* and velocity */
    const double* const* values; /* those named by the law, in its order, n numbers each */
};

struct idim_law_table {
    int abi;
    int n_values;
    const char* const* value_names;
    void* (*create)(void);
    void* (*copy)(const void* law);
    void (*destroy)(void* law);
    /* Drive command before saturation and delay, of each of the n joints. */
    void (*command)(void* law, const struct idim_law_sample* sample, double* v);
    void (*limited)(void* law, const double* wanted, const double* given);
};

/* The one symbol a library with a law exports. */
const struct idim_law_table* idim_law(void);

#ifdef __cplusplus
}
#endif

#endif
