#include "app/view/frontend/window_frontend.h"

#include <imgui.h>

#include <utility>

#include "app/view/frontend/imgui_input.h"
#include "render/screen.h"

namespace neve::app::view::frontend {

namespace {

using From = render::WindowEvent::Kind;
using To = InputEvent::Kind;

static_assert(key::escape == 256 && key::f1 == 290 && key::last == 348,
              "the window's codes of keys that print nothing are those of namespace key");

To kind_of(From kind) {
  switch (kind) {
    case From::move:
    case From::leave:
      return To::move;
    case From::button:
      return To::button;
    case From::wheel:
      return To::wheel;
    case From::key:
      return To::key;
    case From::text:
      return To::text;
    case From::resize:
      return To::resize;
    case From::drop:
      return To::drop;
    case From::close:
      return To::close;
  }
  return To::move;
}

InputEvent translated(render::WindowEvent from) {
  InputEvent to;
  to.kind = kind_of(from.kind);
  const bool is_outside = from.kind == From::leave;
  to.x = is_outside ? off_picture : from.x;
  to.y = is_outside ? off_picture : from.y;
  to.button = from.button;
  to.key = from.key;
  to.is_down = from.is_down;
  to.held = {from.ctrl, from.shift, from.alt, from.super};
  to.text = std::move(from.text);
  return to;
}

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

WindowFrontend::WindowFrontend(const std::string& title, const ScreenSize& size)
    : window_({title, size.width, size.height}) {}

ScreenSize WindowFrontend::size() const {
  return {window_.width(), window_.height(), window_.scale()};
}

std::vector<InputEvent> WindowFrontend::wait(double seconds) {
  std::vector<InputEvent> events;
  for (render::WindowEvent& event : window_.wait(seconds))
    events.push_back(translated(std::move(event)));
  return events;
}

void WindowFrontend::show(render::Screen& screen) {
  screen.select_panels();
  window_.set_cursor(cursor_of_panels());
  screen.present();
  window_.swap();
}

}  // namespace neve::app::view::frontend
