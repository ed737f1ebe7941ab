#pragma once
/// Render targets of the passes, for one size of picture.

#include "render/gl/gl_objects.h"

namespace neve::render::gl {

struct Targets {
  /// @throws std::runtime_error when the driver has no memory for this size
  Targets(const Gl& gl, int width, int height, int supersampling);

  int width, height, supersampling;
  int sample_width() const { return width * supersampling; }
  int sample_height() const { return height * supersampling; }

  // G-buffer, one texel per sample; see shaders/gbuffer.glsl.
  Texture depth, normal_kind, albedo;
  Texture samples;  ///< shaded samples, only with supersampling
  Texture picture;  ///< sRGB
  Framebuffer gbuffer, shaded, finished;
  Framebuffer
      shaded_with_depth;  ///< to lay things over the shaded picture where nothing hides them
};

}  // namespace neve::render::gl
