// SPDX-License-Identifier: MIT
// Steps of distance, and numbers that atomics can order; every pass reads the constants u and the reduction r.

// Distances of even steps in what a pixel spans: of one ratio where pixels grow with the distance, else of one length.
float distance_at(float near, float far, float t) {
    return u.even != 0 ? gn_cascades_uniform(near, far, t) : gn_cascades_log(near, far, t);
}
float step_of(float near, float far, float distance) {
    return u.even != 0 ? (distance - near) / (far - near) : log(distance / near) / log(far / near);
}

// Bits that order as floats do; 0 is below every number.
uint ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7FFFFFFFu : ~bits);
}
