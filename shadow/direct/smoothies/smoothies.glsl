// SPDX-License-Identifier: MIT
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
//
// It compiles as GLSL and as C++.
#ifndef GN_SHADOW_DIRECT_SMOOTHIES_GLSL
#define GN_SHADOW_DIRECT_SMOOTHIES_GLSL

#include "shadow/direct/smoothies/smoothies.h"

// Light behind a fin: `off` is the place on it, from 0 at the edge, as shadow/casters/fins.h says; depths are metres along the
// view, from the lamp (`lamp`) or from any plane across a sun's rays. The fin is a light's half width wide, on which
// the penumbra takes 1 - b / r, with b the blocker's and r the receiver's depth [CD03] section 3.2, [PSS98]; of a sun r - b.
GN_FN float gn_smoothies_light(float off, float blocker, float receiver, bool lamp, GnSmoothiesParams params) {
    if (receiver <= blocker) {
        return 1.0f;
    }
    float wide = params.width * (lamp ? 1.0f - blocker / receiver : receiver - blocker);
    return off >= wide ? 1.0f : off / wide;
}

#endif
