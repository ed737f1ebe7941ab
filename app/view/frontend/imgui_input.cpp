#include "app/view/frontend/imgui_input.h"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace neve::app::view::frontend {

namespace {

using Kind = InputEvent::Kind;

constexpr int button_count = 5;

struct KeyPair {
  int ours;
  ImGuiKey theirs;
};

/// The keys that Dear ImGui's own widgets know in every version.
constexpr KeyPair common_keys[] = {
    {key::tab, ImGuiKey_Tab},
    {key::left, ImGuiKey_LeftArrow},
    {key::right, ImGuiKey_RightArrow},
    {key::up, ImGuiKey_UpArrow},
    {key::down, ImGuiKey_DownArrow},
    {key::page_up, ImGuiKey_PageUp},
    {key::page_down, ImGuiKey_PageDown},
    {key::home, ImGuiKey_Home},
    {key::end, ImGuiKey_End},
    {key::insert, ImGuiKey_Insert},
    {key::del, ImGuiKey_Delete},
    {key::backspace, ImGuiKey_Backspace},
    {' ', ImGuiKey_Space},
    {key::enter, ImGuiKey_Enter},
    {key::escape, ImGuiKey_Escape},
    {'A', ImGuiKey_A},
    {'C', ImGuiKey_C},
    {'V', ImGuiKey_V},
    {'X', ImGuiKey_X},
    {'Y', ImGuiKey_Y},
    {'Z', ImGuiKey_Z},
};

#if IMGUI_VERSION_NUM >= 18700
constexpr KeyPair sign_keys[] = {
    {'\'', ImGuiKey_Apostrophe},    {',', ImGuiKey_Comma},        {'-', ImGuiKey_Minus},
    {'.', ImGuiKey_Period},         {'/', ImGuiKey_Slash},        {';', ImGuiKey_Semicolon},
    {'=', ImGuiKey_Equal},          {'[', ImGuiKey_LeftBracket},  {'\\', ImGuiKey_Backslash},
    {']', ImGuiKey_RightBracket},   {'`', ImGuiKey_GraveAccent},  {key::shift, ImGuiKey_LeftShift},
    {key::ctrl, ImGuiKey_LeftCtrl}, {key::alt, ImGuiKey_LeftAlt}, {key::super, ImGuiKey_LeftSuper},
};

ImGuiKey imgui_key(int key) {
  if (key >= 'A' && key <= 'Z') return static_cast<ImGuiKey>(ImGuiKey_A + (key - 'A'));
  if (key >= '0' && key <= '9') return static_cast<ImGuiKey>(ImGuiKey_0 + (key - '0'));
  if (key >= key::f1 && key < key::f1 + 12)
    return static_cast<ImGuiKey>(ImGuiKey_F1 + (key - key::f1));
  for (const KeyPair& pair : common_keys)
    if (pair.ours == key) return pair.theirs;
  for (const KeyPair& pair : sign_keys)
    if (pair.ours == key) return pair.theirs;
  return ImGuiKey_None;
}
#endif

/// A modifier is held from the moment it goes down; the state reported with events is ignored.
Modifiers held_after(const InputEvent& event) {
  Modifiers held = event.held;
  if (event.kind != Kind::key) return held;
  if (event.key == key::shift) held.shift = event.is_down;
  if (event.key == key::ctrl) held.ctrl = event.is_down;
  if (event.key == key::alt) held.alt = event.is_down;
  if (event.key == key::super) held.super = event.is_down;
  return held;
}

bool is_possible(const InputEvent& event) {
  switch (event.kind) {
    case Kind::move:
    case Kind::wheel:
      return std::isfinite(event.x) && std::isfinite(event.y);
    case Kind::button:
      return event.button >= 0 && event.button < button_count;
    case Kind::key:
      return event.key > 0 && event.key <= key::last;
    case Kind::text:
    case Kind::paste:
      return !event.text.empty();
    default:
      return false;
  }
}

/// Text fields take such keys as text only.
bool is_plain_letter(const InputEvent& event) {
  return event.key >= ' ' && event.key < 127 && !event.held.ctrl && !event.held.alt &&
         !event.held.super;
}

}  // namespace

/// Events given to one frame so far.
struct ImGuiInput::Portion {
  bool is_empty = true;
  bool has_wheel = false, has_buttons = false, has_text = false, has_command_key = false;
  std::vector<int> keys, buttons;  ///< that changed
  Modifiers held{};
  ImVec2 place;  ///< of the mouse, when the wheel was turned first

  /// Fingers that pinch turn the wheel and hardly move: a frame for each would take seconds on a
  /// slow machine, long after the fingers have left.
  bool is_beside(const InputEvent& event) const {
    constexpr float near = 8;  // px
    return std::hypot(event.x - place.x, event.y - place.y) <= near;
  }

  void note(const InputEvent& event) {
    is_empty = false;
    held = held_after(event);
    if (event.kind == Kind::move && !has_wheel) place = ImVec2(event.x, event.y);
    if (event.kind == Kind::wheel) has_wheel = true;
    if (event.kind == Kind::text) has_text = true;
    if (event.kind == Kind::button) buttons.push_back(event.button);
    if (event.kind != Kind::key) return;
    keys.push_back(event.key);
    has_command_key |= !is_plain_letter(event);
  }
};

ImGuiInput::ImGuiInput(Frontend& front)
    : front_(front), is_key_down_(key::last + 1), is_button_down_(button_count) {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = this;
  io.SetClipboardTextFn = [](void* self, const char* text) {
    static_cast<ImGuiInput*>(self)->front_.set_clipboard(text);
  };
  io.GetClipboardTextFn = [](void* self) {
    return static_cast<ImGuiInput*>(self)->clipboard_text();
  };
#if IMGUI_VERSION_NUM < 18700
  for (const KeyPair& pair : common_keys) io.KeyMap[pair.theirs] = pair.ours;
  io.KeyMap[ImGuiKey_KeyPadEnter] = key::enter;
#endif
}

const char* ImGuiInput::clipboard_text() {
  clipboard_ = pasted_.empty() ? front_.clipboard() : pasted_.front();
  return clipboard_.c_str();
}

void ImGuiInput::push(std::vector<InputEvent> events) {
  for (InputEvent& event : events) {
    if (event.kind == Kind::gone) {
      waiting_.clear();
      pasted_.clear();
      release_all();
    }
    if (!is_possible(event)) continue;
    if (event.kind == Kind::paste) {
      push_paste(event);
    } else {
      waiting_.push_back({std::move(event)});
    }
  }
}

void ImGuiInput::push_paste(const InputEvent& event) {
  pasted_.push_back(event.text);
  InputEvent press;
  press.kind = Kind::key;
  press.key = 'V';
  press.is_down = true;
  press.held.ctrl = true;
  InputEvent release = press;
  release.is_down = false;
  release.held = event.held;
  waiting_.push_back({press});
  waiting_.push_back({release, true});
}

void ImGuiInput::release_all() {
  for (int k = 0; k < button_count; ++k)
    if (is_button_down_[static_cast<std::size_t>(k)])
      waiting_.push_back({{.kind = Kind::button, .button = k}});
  for (int k = 0; k <= key::last; ++k)
    if (is_key_down_[static_cast<std::size_t>(k)])
      waiting_.push_back({{.kind = Kind::key, .key = k}});
  // No modifier outlives its key, not even one that was only seen with another event.
  waiting_.push_back({{.kind = Kind::move, .x = off_picture, .y = off_picture}});
}

bool ImGuiInput::is_news(const Waiting& waiting) const {
  const InputEvent& event = waiting.event;
  if (event.kind == Kind::key)
    return is_key_down_[static_cast<std::size_t>(event.key)] != event.is_down || waiting.ends_paste;
  if (event.kind == Kind::button)
    return is_button_down_[static_cast<std::size_t>(event.button)] != event.is_down;
  return true;
}

bool ImGuiInput::fits(const InputEvent& event, const Portion& portion) {
  if (portion.is_empty) return true;
  const bool is_pointed = portion.has_wheel || !portion.buttons.empty();
  const bool is_typed = portion.has_text || !portion.keys.empty();
  const bool has_same_modifiers = held_after(event) == portion.held;
  if ((is_pointed || is_typed) && !has_same_modifiers) return false;
  switch (event.kind) {
    case Kind::move:
      return !is_typed && portion.buttons.empty() &&
             (!portion.has_wheel || portion.is_beside(event));
    case Kind::wheel:
      return portion.buttons.empty() && !is_typed;
    case Kind::button:
      return !portion.has_wheel && !is_typed &&
             std::find(portion.buttons.begin(), portion.buttons.end(), event.button) ==
                 portion.buttons.end();
    // Text fields take the text of a frame first, then its keys.
    case Kind::text:
      return !is_pointed && !portion.has_command_key;
    case Kind::key:
      return !is_pointed &&
             std::find(portion.keys.begin(), portion.keys.end(), event.key) == portion.keys.end();
    default:
      return true;
  }
}

bool ImGuiInput::feed() {
  ImGuiIO& io = ImGui::GetIO();
  Portion portion;
  portion.place = io.MousePos;
  while (!waiting_.empty()) {
    const auto& [event, ends_paste] = waiting_.front();
    if (is_news(waiting_.front())) {
      if (!fits(event, portion)) return true;
      portion.note(event);
      apply(event, io);
      if (ends_paste) pasted_.erase(pasted_.begin());
    }
    waiting_.pop_front();
  }
  return false;
}

#if IMGUI_VERSION_NUM >= 18700

void ImGuiInput::set_modifiers(const Modifiers& held, ImGuiIO& io) {
#if IMGUI_VERSION_NUM >= 18900
  constexpr ImGuiKey ctrl = ImGuiMod_Ctrl, shift = ImGuiMod_Shift, alt = ImGuiMod_Alt,
                     super = ImGuiMod_Super;
#else
  constexpr ImGuiKey ctrl = ImGuiKey_ModCtrl, shift = ImGuiKey_ModShift, alt = ImGuiKey_ModAlt,
                     super = ImGuiKey_ModSuper;
#endif
  io.AddKeyEvent(ctrl, held.ctrl);
  io.AddKeyEvent(shift, held.shift);
  io.AddKeyEvent(alt, held.alt);
  io.AddKeyEvent(super, held.super);
  held_ = held;
}

#else

void ImGuiInput::set_modifiers(const Modifiers& held, ImGuiIO& io) {
  io.KeyCtrl = held.ctrl;
  io.KeyShift = held.shift;
  io.KeyAlt = held.alt;
  io.KeySuper = held.super;
  held_ = held;
}

#endif

void ImGuiInput::apply(const InputEvent& event, ImGuiIO& io) {
  const Modifiers held = held_after(event);
  if (held != held_) set_modifiers(held, io);
  const bool is_off = event.x <= off_picture || event.y <= off_picture;
  const ImVec2 place = is_off ? ImVec2(-FLT_MAX, -FLT_MAX) : ImVec2(event.x, event.y);
#if IMGUI_VERSION_NUM >= 18700
  if (event.kind == Kind::move) io.AddMousePosEvent(place.x, place.y);
  if (event.kind == Kind::wheel) io.AddMouseWheelEvent(-event.x, event.y);
  if (event.kind == Kind::button) io.AddMouseButtonEvent(event.button, event.is_down);
  if (event.kind == Kind::key && imgui_key(event.key) != ImGuiKey_None)
    io.AddKeyEvent(imgui_key(event.key), event.is_down);
#else
  if (event.kind == Kind::move) io.MousePos = place;
  if (event.kind == Kind::wheel) io.MouseWheelH -= event.x, io.MouseWheel += event.y;
  if (event.kind == Kind::button) io.MouseDown[event.button] = event.is_down;
  if (event.kind == Kind::key) io.KeysDown[event.key] = event.is_down;
#endif
  if (event.kind == Kind::text) io.AddInputCharactersUTF8(event.text.c_str());
  if (event.kind == Kind::button)
    is_button_down_[static_cast<std::size_t>(event.button)] = event.is_down;
  if (event.kind == Kind::key) is_key_down_[static_cast<std::size_t>(event.key)] = event.is_down;
}

#if IMGUI_VERSION_NUM >= 18700
bool is_key_pressed(int key, bool is_repeating) {
  return imgui_key(key) != ImGuiKey_None && ImGui::IsKeyPressed(imgui_key(key), is_repeating);
}
bool is_key_down(int key) {
  return imgui_key(key) != ImGuiKey_None && ImGui::IsKeyDown(imgui_key(key));
}
#else
bool is_key_pressed(int key, bool is_repeating) {
  return ImGui::IsKeyPressed(key, is_repeating);
}
bool is_key_down(int key) {
  return ImGui::IsKeyDown(key);
}
#endif

}  // namespace neve::app::view::frontend
