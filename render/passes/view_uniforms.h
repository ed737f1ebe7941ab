#pragma once
/// The camera for shaders.

#include "render/frame/view.h"
#include "render/gl/gl_program.h"

namespace neve::render::passes {

/// Sets the uniforms of shaders/view.glsl.
void set_view(const gl::Program& program, const View& view);

}  // namespace neve::render::passes
