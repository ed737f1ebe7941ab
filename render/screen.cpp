#include "render/screen.h"

#include <algorithm>

#include "render/gl/gl_objects.h"
#include "render/gl/read_back.h"
#include "render/overlay/imgui_draw.h"

namespace neve::render {

struct Screen::Impl {
  gl::Context& context;
  gl::Gl gl;
  gl::ShaderLibrary library;
  overlay::ImGuiDraw imgui;
  gl::ReadBack read_back;
  gl::Framebuffer framebuffer, source_framebuffer;
  gl::Texture color, source;
  int source_width = 0, source_height = 0;
  int width = 0, height = 0;

  Impl(gl::Context& c, const std::string& shader_dir)
      : context(c),
        gl(gl::load_gl(c)),
        library(shader_dir),
        imgui(gl, library),
        read_back(gl, false),
        framebuffer(gl),
        source_framebuffer(gl) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { context.make_current(); }

  void resize(int new_width, int new_height) {
    if (new_width == width && new_height == height) return;
    width = new_width;
    height = new_height;
    color = gl::make_texture_2d(gl, width, height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, nullptr,
                                GL_NEAREST);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
  }

  /// Copies a picture to its place, scaled.
  void put(const Image& picture, const PicturePlace& place) {
    if (picture.pixels.empty()) return;
    if (picture.width != source_width || picture.height != source_height) {
      source = gl::make_texture_2d(gl, picture.width, picture.height, GL_RGBA8, GL_RGB,
                                   GL_UNSIGNED_BYTE, nullptr, GL_LINEAR);
      source_width = picture.width;
      source_height = picture.height;
    }
    gl.BindTexture(GL_TEXTURE_2D, source.id());
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width, picture.height, GL_RGB,
                     GL_UNSIGNED_BYTE, picture.pixels.data());
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, source_framebuffer.id());
    gl.FramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, source.id(),
                            0);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer.id());
    const bool is_same = picture.width == place.width && picture.height == place.height;
    // The first row of the picture is the upper one.
    const int bottom = height - place.y - place.height;
    gl.BlitFramebuffer(0, 0, picture.width, picture.height, place.x, bottom + place.height,
                       place.x + place.width, bottom, GL_COLOR_BUFFER_BIT,
                       is_same ? GL_NEAREST : GL_LINEAR);
  }

  void draw_panels() {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.Viewport(0, 0, width, height);
    imgui.select();
    imgui.end();
    gl.Disable(GL_SCISSOR_TEST);
  }

  void clear() const {
    const GLfloat nothing[4] = {0.03f, 0.035f, 0.045f, 1};
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.Viewport(0, 0, width, height);
    gl.Disable(GL_SCISSOR_TEST);
    gl.ClearBufferfv(GL_COLOR, 0, nothing);
  }
};

Screen::Screen(gl::Context& context, const std::string& shader_dir) {
  context.make_current();
  impl_ = std::make_unique<Impl>(context, shader_dir);
}

Screen::~Screen() = default;

void Screen::select_panels() {
  impl_->imgui.select();
}

void Screen::begin(int width, int height, int font_size, float seconds) {
  Impl& s = *impl_;
  s.context.make_current();
  s.resize(std::max(width, 1), std::max(height, 1));
  s.imgui.begin(s.width, s.height, font_size, {}, seconds);
}

void Screen::end(Renderer& renderer, const PicturePlace& place) {
  Impl& s = *impl_;
  s.context.make_current();
  s.clear();
  renderer.copy_picture(s.framebuffer.id(), place.x, s.height - place.y - place.height, place.width,
                        place.height);
  s.draw_panels();
}

void Screen::end(const Image& picture, const PicturePlace& place) {
  Impl& s = *impl_;
  s.context.make_current();
  s.clear();
  s.put(picture, place);
  s.draw_panels();
}

Image Screen::pixels() {
  Impl& s = *impl_;
  s.context.make_current();
  s.gl.BindFramebuffer(GL_FRAMEBUFFER, s.framebuffer.id());
  s.read_back.begin(s.width, s.height, false);
  return s.read_back.finish_newest();
}

void Screen::present() {
  Impl& s = *impl_;
  s.context.make_current();
  s.gl.BindFramebuffer(GL_READ_FRAMEBUFFER, s.framebuffer.id());
  s.gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
  s.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  s.gl.BlitFramebuffer(0, 0, s.width, s.height, 0, 0, s.width, s.height, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
}

}  // namespace neve::render
