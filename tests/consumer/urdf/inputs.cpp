// Prints what the two models were generated from.
#include <cstdio>

#include "arm/model.hpp"
#include "two-arm/two_arm.h"

int main() {
    std::printf("%s\n%s\n", two_arm_input_hash, idim_models::arm::input_hash);
    return 0;
}
