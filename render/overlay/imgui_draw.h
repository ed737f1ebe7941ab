#pragma once
/// Dear ImGui on our own function table: fonts, and drawing of its draw lists. Its packaged
/// OpenGL backend loads its functions through libGL and fails under OSMesa.

#include <imgui.h>

#include <set>
#include <string>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/gl/gl_program.h"

namespace neve::render::overlay {

class ImGuiDraw {
 public:
  ImGuiDraw(const gl::Gl& gl, const gl::ShaderLibrary& library);
  ImGuiDraw(const ImGuiDraw&) = delete;
  ImGuiDraw& operator=(const ImGuiDraw&) = delete;
  ~ImGuiDraw();

  /// Starts an ImGui frame. Fonts are rasterised at their exact size, with the characters of texts
  /// and those of Western Europe; they are made again if size or characters change.
  /// @param font_size height of a line of text, pixels
  /// @param seconds since the frame before, for what blinks and repeats
  void begin(int width, int height, int font_size, const std::vector<std::string>& texts,
             float seconds = 1.0f / 60);
  /// Ends the frame and draws it over the bound framebuffer.
  void end();

  /// Makes its ImGui context the current one.
  void select() { ImGui::SetCurrentContext(context_); }

  ImFont* text_font() const { return text_font_; }
  ImFont* title_font() const { return title_font_; }

 private:
  void make_fonts(int font_size);
  void draw(const ImDrawData& data);

  const gl::Gl& gl_;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertex_buffer_, index_buffer_;
  gl::Texture font_texture_;
  ImGuiContext* context_ = nullptr;
  ImFont* text_font_ = nullptr;
  ImFont* title_font_ = nullptr;
  int font_size_ = 0;
  std::set<ImWchar> characters_;
};

}  // namespace neve::render::overlay
