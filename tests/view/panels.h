#pragma once
/// A small Dear ImGui user interface without OpenGL, and a frontend that remembers a clipboard.

#include <imgui.h>

#include <functional>
#include <string>
#include <vector>

#include "app/view/frontend/frontend.h"

namespace neve::app {

/// Nobody looks; the clipboard is a string.
class ClipboardFrontend : public app::view::frontend::Frontend {
 public:
  std::string where() const override { return "nowhere"; }
  app::view::frontend::ScreenSize size() const override { return {800, 600, 1}; }
  std::vector<app::view::frontend::InputEvent> wait(double) override { return {}; }
  void wake() override {}
  bool is_ready() const override { return true; }
  bool is_picture_wanted() const override { return false; }
  void show(render::Screen&) override {}
  void set_clipboard(const std::string& text) override { text_ = text; }
  std::string clipboard() const override { return text_; }

 private:
  std::string text_;
};

/// An ImGui context with a font, as long as it lives.
class Panels {
 public:
  Panels() : context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(800, 600);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
  }
  ~Panels() { ImGui::DestroyContext(context_); }
  Panels(const Panels&) = delete;
  Panels& operator=(const Panels&) = delete;

  /// One frame of a window that fills the screen.
  void frame(const std::function<void()>& widgets) {
    ImGui::GetIO().DeltaTime = 1.0f / 60;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(800, 600));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove);
    widgets();
    ImGui::End();
    ImGui::EndFrame();
  }

 private:
  ImGuiContext* context_;
};

// Input of a user.
inline app::view::frontend::InputEvent move_to(float x, float y) {
  return {.kind = app::view::frontend::InputEvent::Kind::move, .x = x, .y = y};
}
inline app::view::frontend::InputEvent button(bool is_down, int which = 0) {
  return {
      .kind = app::view::frontend::InputEvent::Kind::button, .button = which, .is_down = is_down};
}
inline app::view::frontend::InputEvent press(int key, app::view::frontend::Modifiers held = {}) {
  return {.kind = app::view::frontend::InputEvent::Kind::key,
          .key = key,
          .is_down = true,
          .held = held};
}
inline app::view::frontend::InputEvent release(int key, app::view::frontend::Modifiers held = {}) {
  return {.kind = app::view::frontend::InputEvent::Kind::key, .key = key, .held = held};
}
inline app::view::frontend::InputEvent text(const std::string& typed) {
  return {.kind = app::view::frontend::InputEvent::Kind::text, .text = typed};
}
inline app::view::frontend::InputEvent wheel(float x, float y) {
  return {.kind = app::view::frontend::InputEvent::Kind::wheel, .x = x, .y = y};
}

}  // namespace neve::app
