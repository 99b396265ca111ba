// SPDX-License-Identifier: MIT
// What a header or a formula needs to compile as both C++ and GLSL.
//
// Shared structs hold 32-bit scalars, vec2, vec4, uvec2, uvec4 and mat4 only; with the scalar block layout they then
// have the same bytes on both sides. A field's default is written once: `float radius GN_DEFAULT(1.5);`.
#ifndef GN_BASE_SHARED_H
#define GN_BASE_SHARED_H

#ifdef __cplusplus

#include <glm/glm.hpp>

#define GN_DEFAULT(value) = value
#define GN_FN inline
#define GN_OUT(type) type&
#define GN_INOUT(type) type&

// The GLSL vocabulary, for formulas that compile as both languages.
using glm::bvec2;
using glm::bvec3;
using glm::bvec4;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = unsigned int;

namespace gn::glsl {
using namespace glm;  // NOLINT: abs, clamp, mix, dot ... as GLSL has them; formulas say `using namespace gn::glsl`
}

#else

#define GN_DEFAULT(value)
#define GN_FN
#define GN_OUT(type) out type
#define GN_INOUT(type) inout type

#endif

// What a formula's clamp would hide. Nothing, but where a host defines it before: see shadow/receiver/expect.h.
//   #define GN_EXPECT(condition) { if (!(condition)) { return; } }
#ifndef GN_EXPECT
#define GN_EXPECT(condition)
#endif
#endif
