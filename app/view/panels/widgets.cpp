#include "app/view/panels/widgets.h"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "app/support/text.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/slider_scale.h"

namespace neve::app::view::panels {

namespace {

const ImVec4 changed_color{1.0f, 0.72f, 0.35f, 1.0f};
/// Share of a row that the widget takes; its name takes the rest.
constexpr float widget_share = 0.48f;

/// A pixel of dragging changes a value by this much.
float speed_of(double value) {
  return static_cast<float>(std::max(1e-5, 0.005 * std::abs(value)));
}

std::string format_of(const char* unit) {
  return std::string("%.6g") + (unit[0] ? std::string(" ") + unit : "");
}

/// Text typed so far into a field with a value of this type.
template <class T>
struct Typing {
  T value{};
  bool has_strange_letters = false;  ///< that are no part of a number; ImGui leaves them out
};

/// Typed text of the active field, by its address, and of a field left in this frame.
template <class T>
std::map<std::string, Typing<T>>& typings() {
  static std::map<std::string, Typing<T>> typings;
  return typings;
}

/// True if a character that no number has was typed in this frame: "30 kPa" would become 30.
bool has_strange_letters(bool is_whole) {
  const std::string_view allowed = is_whole ? "0123456789+-*/ " : "0123456789+-*/.eE ";
  const ImVector<ImWchar>& typed = ImGui::GetIO().InputQueueCharacters;
  return std::any_of(typed.begin(), typed.end(), [&](ImWchar c) {
    return c >= 32 && (c > 126 || allowed.find(static_cast<char>(c)) == std::string_view::npos);
  });
}

/// Call before the widget: it continues with the text typed so far.
/// @return the value that counts meanwhile
template <class T>
T resume_typing(const Knob& knob, T& value, bool is_whole = false) {
  const T before = value;
  const auto typing = typings<T>().find(knob.address);
  if (typing == typings<T>().end()) return before;
  value = typing->second.value;
  typing->second.has_strange_letters |= has_strange_letters(is_whole);
  return before;
}

std::string refusal_text(const Knob& knob) {
  const std::string bounds = knob.valid.text_of_bounds();
  return "not accepted; expected " + (bounds == "value" ? std::string("a plain number") : bounds) +
         (knob.unit[0] ? std::string(" ") + knob.unit : "");
}

/// Largest whole number that a parameter may have.
template <class T>
T greatest_whole(const scene::Valid& valid) {
  constexpr T most = std::numeric_limits<T>::max();
  return valid.max < static_cast<double>(most) ? static_cast<T>(valid.max) : most;
}

/// Called after the widget. Digits that are being typed into it count when they are complete: 30000
/// is never 3. A complete but invalid value is refused; a drag stops at the ends.
/// @param bound moves a value between the ends
/// @return whether the value is a new one now
template <class T, class IsValid, class Bound>
bool settle(const Knob& knob, const T& before, T& value, IsValid is_valid, Bound bound) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  if (context.TempInputId != 0 && context.ActiveId == context.TempInputId &&
      ImGui::IsItemActive()) {
    typings<T>()[knob.address].value = value;
    value = before;
    return false;
  }
  const auto found = typings<T>().find(knob.address);
  if (found == typings<T>().end()) {
    // A value that nobody moved stays, even where a drag would not get to.
    if (value == before) return false;
    value = bound(value);
    return !(value == before);
  }
  const Typing<T> typed = found->second;
  typings<T>().erase(found);
  value = before;
  if (frontend::is_key_pressed(frontend::key::escape)) return false;
  if (typed.has_strange_letters || (!(typed.value == before) && !is_valid(typed.value))) {
    knob.refusal = refusal_text(knob);
    return false;
  }
  value = typed.value;
  return !(value == before);
}

/// A turning arrow: the parameter beside it waits for Reset.
void draw_reset_mark() {
  const float size = ImGui::GetFontSize(), r = 0.30f * size;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 middle(at.x + 0.4f * size, at.y + 0.5f * ImGui::GetFrameHeight());
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PathArcTo(middle, r, -0.6f, 4.2f, 16);
  list.PathStroke(color, 0, 0.1f * size);
  const ImVec2 tip_at(middle.x + r * std::cos(-0.6f), middle.y + r * std::sin(-0.6f));
  const float a = 0.26f * size;
  list.AddTriangleFilled(ImVec2(tip_at.x - a, tip_at.y), ImVec2(tip_at.x + 0.6f * a, tip_at.y),
                         ImVec2(tip_at.x, tip_at.y - 1.1f * a), color);
  ImGui::Dummy(ImVec2(0.8f * size, ImGui::GetFrameHeight()));
}

/// A line below the number of the last slider, as long as its value: a grab would cover the number.
void draw_level(double share) {
  const ImGuiCol color = ImGui::IsItemActive() ? ImGuiCol_SliderGrabActive : ImGuiCol_SliderGrab;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float thick = std::max(2.0f, 0.16f * (high.y - low.y));
  const float x = low.x + static_cast<float>(share) * (high.x - low.x);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(ImVec2(low.x, high.y - thick), ImVec2(x, high.y), ImGui::GetColorU32(color));
  list.AddRectFilled(ImVec2(x - 1, high.y - 2 * thick), ImVec2(x + 1, high.y),
                     ImGui::GetColorU32(ImGuiCol_SliderGrabActive));
}

double clamped(double value, const scene::Valid& valid) {
  if (!std::isfinite(value)) return std::isfinite(valid.min) ? least(valid) : 0.0;
  return std::clamp(value, least(valid), greatest(valid));
}

}  // namespace

bool edit_value(const Knob&, bool& value) {
  return ImGui::Checkbox("##value", &value);
}

bool edit_value(const Knob& knob, double& value) {
  const std::string format = format_of(knob.unit);
  const SliderScale scale = slider_scale(knob.valid, usual_number(knob.address), value);
  const double before = resume_typing(knob, value);
  if (scale.kind == SliderScale::Kind::drag) {
    const double low = least(knob.valid), high = greatest(knob.valid);
    ImGui::DragScalar("##value", ImGuiDataType_Double, &value, speed_of(value), &low, &high,
                      format.c_str());
  } else {
    const bool is_log = scale.kind == SliderScale::Kind::logarithmic;
    for (const ImGuiCol grab : {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive})
      ImGui::PushStyleColor(grab, IM_COL32_BLACK_TRANS);
    ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &scale.low, &scale.high,
                        format.c_str(), is_log ? ImGuiSliderFlags_Logarithmic : 0);
    ImGui::PopStyleColor(2);
    draw_level(share_of(scale, value));
  }
  return settle(
      knob, before, value, [&](double x) { return knob.valid.contains(x); },
      [&](double x) {
        if (scale.is_zero_at_low && x == scale.low && x != before) return 0.0;
        return clamped(x, knob.valid);
      });
}

bool edit_value(const Knob& knob, int& value) {
  const auto bound = [](double x, int otherwise) {
    return std::abs(x) < 2e9 ? static_cast<int>(x) : otherwise;
  };
  const int low = bound(knob.valid.min, -2000000000), high = bound(knob.valid.max, 2000000000);
  const int before = resume_typing(knob, value, true);
  ImGui::DragInt("##value", &value, std::max(0.1f, 0.005f * static_cast<float>(value)), low, high,
                 knob.unit[0] ? (std::string("%d ") + knob.unit).c_str() : "%d");
  return settle(
      knob, before, value, [&](int x) { return low <= x && x <= high; },
      [&](int x) { return std::clamp(x, low, high); });
}

bool edit_value(const Knob& knob, std::uint64_t& value) {
  const auto low = static_cast<std::uint64_t>(std::max(0.0, knob.valid.min));
  const auto high = greatest_whole<std::uint64_t>(knob.valid);
  const std::uint64_t before = resume_typing(knob, value, true);
  ImGui::DragScalar("##value", ImGuiDataType_U64, &value,
                    std::max(0.1f, 0.005f * static_cast<float>(value)), &low, &high);
  return settle(
      knob, before, value, [&](std::uint64_t x) { return low <= x && x <= high; },
      [&](std::uint64_t x) { return std::clamp(x, low, high); });
}

bool edit_value(const Knob&, std::string& value) {
  std::string text = value;
  if (!ImGui::InputText("##value", &text, ImGuiInputTextFlags_EnterReturnsTrue)) return false;
  if (value == text) return false;
  value = std::move(text);
  return true;
}

bool edit_value(const Knob& knob, sim::Vec3d& value) {
  const double low = least(knob.valid), high = greatest(knob.valid);
  std::array numbers{value.x(), value.y(), value.z()};
  const auto before = resume_typing(knob, numbers);
  ImGui::DragScalarN("##value", ImGuiDataType_Double, numbers.data(), 3,
                     std::max(0.002f, speed_of(value.cwiseAbs().maxCoeff())), &low, &high, "%.4g");
  const auto is_valid = [&](const auto& all) {
    return std::all_of(all.begin(), all.end(), [&](double x) { return knob.valid.contains(x); });
  };
  const auto bound = [&](auto all) {
    for (double& x : all) x = clamped(x, knob.valid);
    return all;
  };
  if (!settle(knob, before, numbers, is_valid, bound)) return false;
  value = {numbers[0], numbers[1], numbers[2]};
  return true;
}

bool edit_value(const Knob&, std::vector<std::string>& value) {
  std::string all;
  for (const std::string& item : value) all += (all.empty() ? "" : ", ") + item;
  ImGui::TextDisabled("%s", all.c_str());
  return false;
}

bool edit_value(const Knob& knob, scene::PictureSize& value) {
  std::array size{value.width, value.height};
  const auto before = resume_typing(knob, size, true);
  const int low = static_cast<int>(knob.valid.min), high = greatest_whole<int>(knob.valid);
  ImGui::DragInt2("##value", size.data(), 1, low, high, "%d");
  const auto is_valid = [&](const auto& all) {
    return std::all_of(all.begin(), all.end(), [&](int x) { return low <= x && x <= high; });
  };
  const auto bound = [&](auto all) {
    for (int& x : all) x = std::clamp(x, low, high);
    return all;
  };
  if (!settle(knob, before, size, is_valid, bound)) return false;
  value = {size[0], size[1]};
  return true;
}

bool edit_value(const Knob& knob, scene::Range& value) {
  std::array numbers{value.min, value.max};
  const double low = knob.valid.min, high = knob.valid.max;
  const float drag = speed_of(std::max(std::abs(value.min), std::abs(value.max)));
  const auto before = resume_typing(knob, numbers);
  ImGui::DragScalarN("##value", ImGuiDataType_Double, numbers.data(), 2, drag, &low, &high, "%.4g");
  const auto is_valid = [&](const auto& ends) {
    return knob.valid.contains(ends[0]) && knob.valid.contains(ends[1]) && ends[0] < ends[1];
  };
  // A drag that would move the ends past each other leaves them as they were.
  const auto bound = [&](const auto& ends) { return ends[0] < ends[1] ? ends : before; };
  if (!settle(knob, before, numbers, is_valid, bound)) {
    if (!knob.refusal.empty()) knob.refusal += ", the first number smaller than the second";
    return false;
  }
  value = {numbers[0], numbers[1]};
  return true;
}

bool edit_choice(const Knob&, const std::vector<std::string>& choices, int& index) {
  const int before = index;
  const char* shown =
      index < 0 ? "(own numbers)" : choices[static_cast<std::size_t>(index)].c_str();
  if (!ImGui::BeginCombo("##value", shown)) return false;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (ImGui::Selectable(choices[k].c_str(), static_cast<int>(k) == index))
      index = static_cast<int>(k);
    note_label(choices[k].c_str());
  }
  ImGui::EndCombo();
  return index != before;
}

bool edit_choices(const Knob&, const std::vector<std::string>& choices, std::vector<bool>& chosen) {
  std::string all;
  for (std::size_t k = 0; k < choices.size(); ++k)
    if (chosen[k]) all += (all.empty() ? "" : ", ") + choices[k];
  if (!ImGui::BeginCombo("##value", all.empty() ? "none" : all.c_str())) return false;
  bool is_set = false;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    bool is_on = chosen[k];
    if (ImGui::Checkbox(choices[k].c_str(), &is_on)) {
      chosen[k] = is_on;
      is_set = true;
    }
    note_label(choices[k].c_str());
  }
  ImGui::EndCombo();
  return is_set;
}

bool KnobPanel::shows(const std::string& address, const char* help) const {
  return search_.finds(address, help);
}

bool KnobPanel::is_changed(const std::string& address) const {
  return std::find(changed_.begin(), changed_.end(), address) != changed_.end();
}

bool KnobPanel::has_changes_below(const std::string& prefix) const {
  return std::any_of(changed_.begin(), changed_.end(),
                     [&](const std::string& address) { return address.starts_with(prefix + "."); });
}

void KnobPanel::begin(const Knob& knob) {
  for (const std::string& title : titles_) ImGui::TextDisabled("%s", title.c_str());
  titles_.clear();
  has_shown_ = true;
  ImGui::PushID(knob.address.c_str());
  ImGui::SetNextItemWidth(widget_share * ImGui::GetContentRegionAvail().x);
}

void KnobPanel::open_title(const std::string& title) {
  titles_.push_back(title);
}

void KnobPanel::close_title() {
  if (!titles_.empty()) titles_.pop_back();
}

void KnobPanel::end(const Knob& knob, const std::string& value) {
  note_label(knob.address.c_str());
  if (!knob.refusal.empty()) note({session::Edit::Kind::refused, knob.address, knob.refusal, 0});
  const auto menu = [&](const char* label, session::Edit::Kind kind) {
    if (ImGui::MenuItem(label)) note({kind, knob.address, value, 0});
    note_label(label);
  };
  const auto context = [&](const char* id) {
    if (!ImGui::BeginPopupContextItem(id)) return;
    ImGui::TextDisabled("%s", knob.address.c_str());
    menu("Back to the file's value", session::Edit::Kind::as_in_file);
    menu("Set to the default", session::Edit::Kind::to_default);
    menu("Sweep around this value", session::Edit::Kind::sweep);
    menu("Copy the address", session::Edit::Kind::copy_address);
    ImGui::EndPopup();
  };
  const auto explain = [&] {
    if (!wants_tip()) return;
    std::vector<TipLine> lines{{knob.address}, {knob.help}};
    const std::string bounds = knob.valid.text_of_bounds();
    if (!bounds.empty()) lines.push_back({bounds + " " + knob.unit, true});
    lines.push_back(
        {knob.is_live ? "live: takes effect at the next step" : "takes effect at Reset", true});
    show_tip(lines);
  };
  context("menu");
  explain();
  ImGui::SameLine(0, 0.5f * ImGui::GetFontSize());
  if (!knob.is_live) {
    draw_reset_mark();
    explain();
    ImGui::SameLine(0, 0.3f * ImGui::GetFontSize());
  }
  if (is_changed(knob.address))
    ImGui::TextColored(changed_color, "%s", knob.label.c_str());
  else
    ImGui::TextUnformatted(knob.label.c_str());
  context("label menu");
  explain();
  ImGui::PopID();
}

std::uint64_t gesture_of(std::uint64_t held) {
  constexpr std::uint64_t scatter = 0x9e3779b97f4a7c15;
  return held == 0
             ? 0
             : held ^ scatter * std::bit_cast<std::uint64_t>(ImGui::GetIO().MouseClickedTime[0]);
}

std::uint64_t KnobPanel::gesture() const {
  return gesture_of(ImGui::GetActiveID());
}

bool Knobs::open(const std::string& address, const std::string& title, const char* help) {
  ImGui::PushID(address.c_str());
  // With a filter everything is open, and the title waits for something that matches.
  if (panel_.is_filtered()) {
    panel_.open_title(title);
    return true;
  }
  const bool is_changed = panel_.has_changes_below(address);
  if (is_changed) ImGui::PushStyleColor(ImGuiCol_Text, changed_color);
  // Materials start expanded.
  if (address.starts_with("material.")) ImGui::SetNextItemOpen(true, ImGuiCond_Once);
  const bool is_open = ImGui::TreeNode(title.c_str());
  if (is_changed) ImGui::PopStyleColor();
  note_label(address.c_str());
  tip(help);
  if (!is_open) ImGui::PopID();
  return is_open;
}

void Knobs::close() {
  if (panel_.is_filtered())
    panel_.close_title();
  else
    ImGui::TreePop();
  ImGui::PopID();
}

}  // namespace neve::app::view::panels
