#pragma once
/// Move-only owners of one OpenGL name each. The context must be current when they are destroyed.

#include <utility>

#include "render/gl/gl.h"

namespace neve::render::gl {

/// Traits say how a name is made and deleted.
template <class Traits>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(const Gl& gl) : gl_(&gl) { Traits::create(gl, &id_); }
  GlObject(GlObject&& other) noexcept
      : gl_(std::exchange(other.gl_, nullptr)), id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject() {
    if (id_) Traits::destroy(*gl_, &id_);
  }
  GLuint id() const { return id_; }

 private:
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
};

struct TextureTraits {
  static void create(const Gl& gl, GLuint* id) { gl.GenTextures(1, id); }
  static void destroy(const Gl& gl, const GLuint* id) { gl.DeleteTextures(1, id); }
};
struct BufferTraits {
  static void create(const Gl& gl, GLuint* id) { gl.GenBuffers(1, id); }
  static void destroy(const Gl& gl, const GLuint* id) { gl.DeleteBuffers(1, id); }
};
struct VertexArrayTraits {
  static void create(const Gl& gl, GLuint* id) { gl.GenVertexArrays(1, id); }
  static void destroy(const Gl& gl, const GLuint* id) { gl.DeleteVertexArrays(1, id); }
};
struct FramebufferTraits {
  static void create(const Gl& gl, GLuint* id) { gl.GenFramebuffers(1, id); }
  static void destroy(const Gl& gl, const GLuint* id) { gl.DeleteFramebuffers(1, id); }
};

using Texture = GlObject<TextureTraits>;
using Buffer = GlObject<BufferTraits>;
using VertexArray = GlObject<VertexArrayTraits>;
using Framebuffer = GlObject<FramebufferTraits>;

/// A texture without mipmaps, clamped at its edges.
Texture make_texture_2d(const Gl& gl, int width, int height, GLint internal_format, GLenum format,
                        GLenum type, const void* pixels, GLint filter);

/// Sets the state of full-screen passes: no tests, no blending.
void set_flat_state(const Gl& gl);

/// Sets the state of passes that fill the G-buffer: the nearest surface wins, from both sides.
void set_solid_state(const Gl& gl);

}  // namespace neve::render::gl
