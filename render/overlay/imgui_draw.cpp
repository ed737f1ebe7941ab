#include "render/overlay/imgui_draw.h"

#include <imgui_internal.h>

#include <cstddef>
#include <new>

#include "render/gl/embedded.h"

namespace neve::render::overlay {
namespace {

std::set<ImWchar> basic_characters() {
  std::set<ImWchar> characters = {0x2026, IM_UNICODE_CODEPOINT_INVALID};  // ellipsis, replacement
  for (ImWchar c = 0x20; c < 0x7f; ++c) characters.insert(c);
  for (ImWchar c = 0xa0; c < 0x180; ++c) characters.insert(c);
  return characters;
}

/// @return whether there was a new one
bool add_characters(const std::string& text, std::set<ImWchar>& characters) {
  bool is_new = false;
  const char* at = text.c_str();
  const char* end = at + text.size();
  while (at < end) {
    unsigned c = 0;
    at += ImTextCharFromUtf8(&c, at, end);
    if (c >= 0x20 && c <= 0xffff) is_new |= characters.insert(static_cast<ImWchar>(c)).second;
  }
  return is_new;
}

ImVector<ImWchar> ranges_of(const std::set<ImWchar>& characters) {
  ImVector<ImWchar> ranges;
  for (const ImWchar c : characters) {
    ranges.push_back(c);
    ranges.push_back(c);
  }
  ranges.push_back(0);
  return ranges;
}

/// ImGui writes to what it is given without a look; the error of new goes through it.
void allocate_as_new_does() {
  ImGui::SetAllocatorFunctions([](std::size_t size, void*) { return ::operator new(size); },
                               [](void* memory, void*) { ::operator delete(memory); });
}

}  // namespace

ImGuiDraw::ImGuiDraw(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "overlay.vert", "overlay.frag"),
      vertex_array_(gl),
      vertex_buffer_(gl),
      index_buffer_(gl),
      characters_(basic_characters()) {
  allocate_as_new_does();
  ImGuiContext* previous = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // leaves no files behind
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  ImGui::SetCurrentContext(previous);

  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.id());
  constexpr GLsizei stride = sizeof(ImDrawVert);
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride,
                         reinterpret_cast<const void*>(offsetof(ImDrawVert, uv)));
  gl.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                         reinterpret_cast<const void*>(offsetof(ImDrawVert, col)));
  for (const GLuint attribute : {0u, 1u, 2u}) gl.EnableVertexAttribArray(attribute);
}

ImGuiDraw::~ImGuiDraw() {
  ImGui::DestroyContext(context_);
}

void ImGuiDraw::make_fonts(int font_size) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  const std::string_view bytes = gl::find_embedded_font("DejaVuSans.ttf");
  ImVector<ImWchar> ranges = ranges_of(characters_);
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.PixelSnapH = true;
  config.GlyphRanges = ranges.Data;
  // ImGui takes a pointer to non-const and only reads while it does not own the bytes.
  void* data = const_cast<char*>(bytes.data());
  const auto add = [&](int size) {
    return atlas.AddFontFromMemoryTTF(data, static_cast<int>(bytes.size()),
                                      static_cast<float>(size), &config);
  };
  text_font_ = add(font_size);
  title_font_ = add((font_size * 5 + 2) / 4);
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  font_texture_ = gl::make_texture_2d(gl_, width, height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE,
                                      pixels, GL_LINEAR);
  font_size_ = font_size;
}

void ImGuiDraw::begin(int width, int height, int font_size, const std::vector<std::string>& texts,
                      float seconds) {
  select();
  bool is_new = font_size != font_size_;
  for (const std::string& text : texts) is_new |= add_characters(text, characters_);
  if (is_new) make_fonts(font_size);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = seconds;
  ImGui::NewFrame();
}

void ImGuiDraw::end() {
  ImGui::Render();
  draw(*ImGui::GetDrawData());
}

void ImGuiDraw::draw(const ImDrawData& data) {
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  program_.use();
  program_.set("picture_size", data.DisplaySize.x, data.DisplaySize.y);
  program_.set("font", 0);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, font_texture_.id());
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
                   GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                   GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4 clip = command.ClipRect;
      const int x = static_cast<int>(clip.x), y = static_cast<int>(data.DisplaySize.y - clip.w);
      const int w = static_cast<int>(clip.z - clip.x), h = static_cast<int>(clip.w - clip.y);
      if (w <= 0 || h <= 0 || command.UserCallback) continue;
      gl_.Scissor(x, y, w, h);
      gl_.DrawElementsBaseVertex(
          GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
          sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
          reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)),
          static_cast<GLint>(command.VtxOffset));
    }
  }
}

}  // namespace neve::render::overlay
