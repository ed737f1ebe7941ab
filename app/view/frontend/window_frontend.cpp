#include "app/view/frontend/window_frontend.h"

#include <imgui.h>

#include "render/screen.h"

namespace neve::app::view::frontend {

namespace {

render::CursorShape cursor_of_panels() {
  using render::CursorShape;
  if (ImGui::GetIO().MouseDrawCursor) return CursorShape::hidden;
  switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_None:
      return CursorShape::hidden;
    case ImGuiMouseCursor_TextInput:
      return CursorShape::text;
    case ImGuiMouseCursor_Hand:
      return CursorShape::hand;
    case ImGuiMouseCursor_ResizeEW:
      return CursorShape::resize_x;
    case ImGuiMouseCursor_ResizeNS:
      return CursorShape::resize_y;
    case ImGuiMouseCursor_ResizeAll:
    case ImGuiMouseCursor_ResizeNESW:
    case ImGuiMouseCursor_ResizeNWSE:
      return CursorShape::resize_both;
    default:
      return CursorShape::arrow;
  }
}

}  // namespace

void WindowFrontend::show(render::Screen& screen) {
  screen.select_panels();
  window_->set_cursor(cursor_of_panels());
  screen.present();
  window_->swap();
}

}  // namespace neve::app::view::frontend
