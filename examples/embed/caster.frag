// SPDX-License-Identifier: MIT
#version 460
// Linear depth, where the rasterizer's is not.
layout(location = 0) in float depth;

void main() { gl_FragDepth = clamp(depth, 0.0, 1.0); }
