// SPDX-License-Identifier: MIT
// The picture that a rectangle shows: each of its points emits the light's intensity times what the picture holds there. Which
// part of it is hidden then tells in the colour of the shadow.
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], eq. 1.3,
// L_c(q).
#ifndef GN_SHADOW_SCENE_EMISSION_H
#define GN_SHADOW_SCENE_EMISSION_H

#include "shadow/scene/light.h"

#ifdef __cplusplus
#include "base/image.h"

using glm::cross;
#endif

/// Which of Scene::textures a light shows, -1 for none: GnLight::texture holds one more.
GN_FN int gn_emission_texture(GnLight light) {
    return int(light.texture) - 1;
}

/// Which lights may show one: those with a surface that has sides.
GN_FN bool gn_takes_emission(GnLight light) {
    return light.kind == uint(GN_LIGHT_RECTANGLE) && light.half_size.x > 0.0f && light.half_size.y > 0.0f;
}

/// Where the light's point x in [-1,1]^2, along its right_ws and up_ws, lies on the picture: texture coordinates from its upper
/// left corner. Who stands where it shines sees the picture upright with up_ws upwards, and not mirrored.
GN_FN vec2 gn_emission_place(GnLight light, vec2 x) {
    float side = dot(cross(vec3(light.right_ws), vec3(light.up_ws)), vec3(light.direction_ws)) < 0.0f ? -1.0f : 1.0f;
    return vec2(0.5f + 0.5f * side * x.x, 0.5f - 0.5f * x.y);
}

#ifdef __cplusplus
namespace gn {

struct Light;
struct Scene;

/// Lets a light show one of Scene::textures; -1: none.
inline void set_emission(GnLight& light, int texture) {
    light.texture = static_cast<float>(texture + 1);
}
/// The picture that a light shows, null where it shows none: one that the scene lacks, or of a light that takes none.
const Image8* shown_picture(const Scene& scene, const GnLight& light);

/// Linear rgb of a picture at texture coordinates in [0,1]^2, between the centres of texels as filters have it, beyond the
/// outermost centres theirs.
vec3 emission_at(const Image8& picture, vec2 place);
/// Its mean over the whole picture.
vec3 mean_emission(const Image8& picture);

/// Notes the light's picture; one that is not there, or of a light that takes none, is left out.
void complete_emission(Scene& scene, Light& light);

}  // namespace gn
#endif

#endif
