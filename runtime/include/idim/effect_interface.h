/* Effects as columns of a regressor: plain C, so that a library of them can be loaded at run time. One function for each effect file, the same for
 * every joint. SI units, joint side. */
#ifndef IDIM_EFFECT_INTERFACE_H
#define IDIM_EFFECT_INTERFACE_H

#define IDIM_EFFECT_ABI 1

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Signals along samples, [count] each; null where an effect does not read them. */
struct idim_effect_signals {
    size_t count;
    const double* q;         /* of the joint [rad or m] */
    const double* qd;
    const double* qdd;
    const double* tau_rigid; /* torque of the rigid links at the joint [N*m or N] */
    const double* t;         /* [s] */
    const double* temp;      /* of the joint [degC] */
    const double* q_from;    /* of the joint that drives it, in a pair */
    const double* qd_from;
    const double* qdd_from;
    const double* state;     /* state s of sample k at [s * state_stride + k] */
    size_t state_stride;
};

enum idim_effect_scope { IDIM_EFFECT_JOINT, IDIM_EFFECT_PAIR, IDIM_EFFECT_ROBOT };

/* What an effect is to the model: an expression, with the functions below, or something derived from the model itself. */
enum idim_effect_kind {
    IDIM_EFFECT_EXPRESSION,
    IDIM_EFFECT_DELAY,
    IDIM_EFFECT_GAIN,
    IDIM_EFFECT_ELASTICITY,
    IDIM_EFFECT_TILT,
    IDIM_EFFECT_PAYLOAD
};

enum { IDIM_NEEDS_RIGID_TORQUE = 1, IDIM_NEEDS_TEMPERATURE = 2, IDIM_NEEDS_TIME = 4 };

struct idim_effect {
    const char* name;
    int scope;        /* idim_effect_scope */
    int acts_on_both; /* pairs: the same torque, roles exchanged, at the other joint with the same coefficients */
    int kind;         /* idim_effect_kind */
    int per_log;      /* linear coefficients are each log's own */
    int n_linear;
    const char* const* linear_names;
    const char* const* linear_units;
    const double* linear_min; /* NaN: free */
    int n_shape;
    const char* const* shape_names;
    const char* const* shape_units;
    const double* shape_low;
    const double* shape_high;
    int n_state;
    unsigned needs;
    const char* about;
    /* Torque per unit of linear coefficient c at sample k: X[c * stride + k] */
    void (*columns)(const struct idim_effect_signals* signals, const double* shape, double* X, size_t stride);
    /* States along the samples, dt apart: state s at sample k in state[s * stride + k]; null without states */
    void (*advance)(const struct idim_effect_signals* signals, const double* shape, double dt, double* state, size_t stride);
};

struct idim_effect_table {
    int abi;
    int count;
    const struct idim_effect* effects;
};

/* The one symbol a library of effects exports. */
const struct idim_effect_table* idim_effects(void);

#ifdef __cplusplus
}
#endif

#endif
