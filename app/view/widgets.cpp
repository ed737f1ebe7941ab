#include "app/view/widgets.h"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <cstring>

#include "app/text.h"
#include "app/view/labels.h"
#include "app/view/slider_scale.h"

namespace neve::app {

namespace {

const ImVec4 changed_color{1.0f, 0.72f, 0.35f, 1.0f};
/// Share of a row that the widget takes; its name takes the rest.
constexpr float widget_share = 0.48f;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A pixel of dragging changes a value by this much.
float speed_of(double value) {
  return static_cast<float>(std::max(1e-5, 0.005 * std::abs(value)));
}

std::string format_of(const char* unit) {
  return std::string("%.4g") + (unit[0] ? std::string(" ") + unit : "");
}

/// Digits that are being typed into a slider count when they are complete: 30000 is never 3.
/// Called after the widget. @return whether the value is a new one now
template <class T>
bool settle(const Knob& knob, const T& before, T& value) {
  static std::pair<std::string, T> typed;  // address and value
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const bool is_typing =
      context.TempInputId != 0 && context.ActiveId == context.TempInputId && ImGui::IsItemActive();
  if (is_typing) {
    if (!(value == before)) typed = {knob.address, value};
    value = before;
    return false;
  }
  if (typed.first == knob.address) {
    value = typed.second;
    typed.first.clear();
  }
  return !(value == before);
}

/// A turning arrow: what stands beside it waits for Reset.
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

double clamped(double value, const Valid& valid) {
  if (!std::isfinite(value)) return std::isfinite(valid.min) ? least(valid) : 0.0;
  return std::clamp(value, least(valid), greatest(valid));
}

}  // namespace

bool edit_value(const Knob&, bool& value) {
  return ImGui::Checkbox("##value", &value);
}

bool edit_value(const Knob& knob, double& value) {
  const double before = value;
  const std::string format = format_of(knob.unit);
  const SliderScale scale = slider_scale(knob.valid, usual_number(knob.address), value);
  if (scale.kind == SliderScale::Kind::drag) {
    const double low = least(knob.valid), high = greatest(knob.valid);
    ImGui::DragScalar("##value", ImGuiDataType_Double, &value, speed_of(value), &low, &high,
                      format.c_str());
  } else {
    const bool is_log = scale.kind == SliderScale::Kind::logarithmic;
    ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &scale.low, &scale.high,
                        format.c_str(), is_log ? ImGuiSliderFlags_Logarithmic : 0);
    if (scale.is_zero_at_low && value == scale.low && value != before) value = 0;
  }
  value = clamped(value, knob.valid);
  return settle(knob, before, value);
}

bool edit_value(const Knob& knob, int& value) {
  const int before = value;
  const auto bound = [](double x, int otherwise) {
    return std::abs(x) < 2e9 ? static_cast<int>(x) : otherwise;
  };
  const int low = bound(knob.valid.min, -2000000000), high = bound(knob.valid.max, 2000000000);
  ImGui::DragInt("##value", &value, std::max(0.1f, 0.005f * static_cast<float>(value)), low, high,
                 knob.unit[0] ? (std::string("%d ") + knob.unit).c_str() : "%d");
  value = std::clamp(value, low, high);
  return settle(knob, before, value);
}

bool edit_value(const Knob& knob, std::uint64_t& value) {
  const std::uint64_t before = value;
  const auto low = static_cast<std::uint64_t>(std::max(0.0, knob.valid.min));
  const auto high = static_cast<std::uint64_t>(std::min(9e15, knob.valid.max));
  ImGui::DragScalar("##value", ImGuiDataType_U64, &value,
                    std::max(0.1f, 0.005f * static_cast<float>(value)), &low, &high);
  value = std::clamp(value, low, high);
  return settle(knob, before, value);
}

bool edit_value(const Knob&, std::string& value) {
  char text[512];
  std::snprintf(text, sizeof text, "%s", value.c_str());
  if (!ImGui::InputText("##value", text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue))
    return false;
  if (value == text) return false;
  value = text;
  return true;
}

bool edit_value(const Knob& knob, sim::Vec3d& value) {
  const sim::Vec3d before = value;
  const double low = least(knob.valid), high = greatest(knob.valid);
  double numbers[3] = {value.x(), value.y(), value.z()};
  ImGui::DragScalarN("##value", ImGuiDataType_Double, numbers, 3,
                     std::max(0.002f, speed_of(value.cwiseAbs().maxCoeff())), &low, &high, "%.4g");
  for (int a = 0; a < 3; ++a) value[a] = clamped(numbers[a], knob.valid);
  return settle(knob, before, value);
}

bool edit_value(const Knob&, std::vector<std::string>& value) {
  std::string all;
  for (const std::string& item : value) all += (all.empty() ? "" : ", ") + item;
  ImGui::TextDisabled("%s", all.c_str());
  return false;
}

bool edit_value(const Knob& knob, PictureSize& value) {
  int numbers[2] = {value.width, value.height};
  const int low = static_cast<int>(knob.valid.min), high = 16384;
  ImGui::DragInt2("##value", numbers, 1, low, high, "%d");
  std::array size{std::clamp(numbers[0], low, high), std::clamp(numbers[1], low, high)};
  if (!settle(knob, std::array{value.width, value.height}, size)) return false;
  value = {size[0], size[1]};
  return true;
}

bool edit_value(const Knob& knob, Range& value) {
  std::array numbers{value.min, value.max};
  const double low = knob.valid.min, high = knob.valid.max;
  const float drag = speed_of(std::max(std::abs(value.min), std::abs(value.max)));
  ImGui::DragScalarN("##value", ImGuiDataType_Double, numbers.data(), 2, drag, &low, &high, "%.4g");
  if (!settle(knob, std::array{value.min, value.max}, numbers)) return false;
  if (!(numbers[0] < numbers[1])) return false;  // on its way past each other
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
  if (filter_.empty()) return true;
  const std::string wanted = lower(filter_);
  return lower(address).find(wanted) != std::string::npos ||
         lower(help).find(wanted) != std::string::npos;
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
  const auto menu = [&](const char* label, Edit::Kind kind) {
    if (ImGui::MenuItem(label)) note({kind, knob.address, value, 0});
    note_label(label);
  };
  const auto context = [&](const char* id) {
    if (!ImGui::BeginPopupContextItem(id)) return;
    ImGui::TextDisabled("%s", knob.address.c_str());
    menu("Back to the file's value", Edit::Kind::as_in_file);
    menu("Set to the default", Edit::Kind::to_default);
    menu("Sweep around this value", Edit::Kind::sweep);
    menu("Copy the address", Edit::Kind::copy_address);
    ImGui::EndPopup();
  };
  const auto explain = [&] {
    if (!wants_tip()) return;
    std::vector<TipLine> lines{{knob.address}, {knob.help}};
    const std::string bounds = knob.valid.text_of_bounds();
    if (!bounds.empty()) lines.push_back({bounds + " " + knob.unit, true});
    lines.push_back(
        {knob.is_live ? "live: from the next step on" : "takes effect with Reset", true});
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

std::uint64_t KnobPanel::gesture() const {
  return ImGui::GetActiveID();
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
  // What is turned most is open from the start.
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

}  // namespace neve::app
