#pragma once
/// The numbers of shaders/constants.glsl in C++. Plain data, for kernels.

#include "sim/base/vec.h"

namespace neve::render::light {

/// Lets the shared file write colours as GLSL does. No code of it is left in a program, so that
/// sources for several instruction sets may include it.
struct vec3 : Vec3f {  // NOLINT(readability-identifier-naming)
  consteval vec3(float red, float green, float blue) : Vec3f{red, green, blue} {}
};
using uint = unsigned;

#include "shaders/constants.glsl"

}  // namespace neve::render::light
