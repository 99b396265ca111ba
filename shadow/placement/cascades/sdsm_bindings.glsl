// SPDX-License-Identifier: MIT
// What every pass of sample distribution shadow maps binds, and numbers that atomics can order.
#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/placement/cascades/sdsm.h"
layout(binding = 0, scalar) uniform Constants { GnSdsmConstants u; };
layout(binding = 1, scalar) buffer Reduction { GnSdsmReduction r; };

// Bits that order as floats do; 0 is below every number.
uint ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7FFFFFFFu : ~bits);
}
