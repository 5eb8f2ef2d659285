/* What a model compiled for the tests offers beside the interface of the identifiers. Part of the compiled model and of
 * the tests alike. */
#ifndef IDIM_TEST_INTERFACE_H
#define IDIM_TEST_INTERFACE_H

#include "idim/model_interface.h"

struct idim_test_interface {
    struct idim_model_interface model; /* first, so that a pointer to it is one to the whole */
    /* the same template over float; null where the model needs time or temperatures */
    void (*inverse_dynamics_float)(const float* q, const float* qd, const float* qdd, const float* chi, float* tau);
};

#endif
