#pragma once
/// Render targets of the passes, for one size of picture.

#include "render/gl/gl_objects.h"

namespace neve::render::gl {

struct Targets {
  /// @param has_samples  shaded samples are not the picture: always with supersampling
  /// @throws std::runtime_error when the driver has no memory for this size
  Targets(const Gl& gl, int width, int height, int supersampling, bool has_samples);

  int width, height, supersampling;
  bool has_samples;
  int sample_width() const { return width * supersampling; }
  int sample_height() const { return height * supersampling; }

  // G-buffer, one texel per sample; see shaders/gbuffer.glsl.
  Texture depth, normal_kind, albedo;
  Texture samples;  ///< shaded samples, if there are
  Texture picture;  ///< sRGB
  const Texture& top() const { return supersampling > 1 ? samples : picture; }
  Framebuffer gbuffer, shaded, finished;
  /// Targets of things that lie over the shaded samples, or over the picture where each pixel has
  /// one; with depth, nearer surfaces hide the things.
  Framebuffer laid_over, laid_over_with_depth;
};

}  // namespace neve::render::gl
