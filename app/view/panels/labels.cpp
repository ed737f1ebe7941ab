#include "app/view/panels/labels.h"

#include <imgui.h>

#include <algorithm>
#include <limits>

namespace neve::app::view::panels {

namespace {

std::string shown_part(const char* name) {
  const std::string text = name;
  return text.substr(0, text.find("##"));
}

/// Half of a line of text out of sight is hard to hit and hard to read.
bool is_enough(float visible, float whole) {
  return visible > 0 && (visible >= 0.5f * whole || visible >= ImGui::GetTextLineHeight());
}

}  // namespace

Labels& Labels::of_panels() {
  static Labels labels;
  return labels;
}

bool Labels::note(const std::string& name, const LabelPlace& place, int frame) {
  if (frame != frame_) {
    places_.clear();
    names_.clear();
    frame_ = frame;
  }
  std::string unique = name;
  for (int k = 2; places_.contains(unique); ++k) unique = name + "#" + std::to_string(k);
  places_[unique] = place;
  names_.push_back(unique);
  if (unique != wanted_) return false;
  wanted_.clear();
  return !place.is_visible;
}

std::optional<LabelPlace> Labels::find(const std::string& name) const {
  const auto found = places_.find(name);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

std::string Labels::name_at(float x, float y) const {
  std::string smallest;
  float area = std::numeric_limits<float>::max();
  for (const auto& [name, place] : places_) {
    const bool is_inside = place.is_visible && x >= place.x && x < place.x + place.width &&
                           y >= place.y && y < place.y + place.height;
    if (!is_inside || place.width * place.height >= area) continue;
    area = place.width * place.height;
    smallest = name;
  }
  return smallest;
}

void Labels::clear() {
  *this = Labels{};
}

void note_label(const char* name) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 clip_low = ImGui::GetWindowDrawList()->GetClipRectMin();
  const ImVec2 clip_high = ImGui::GetWindowDrawList()->GetClipRectMax();
  const ImVec2 from(std::max(low.x, clip_low.x), std::max(low.y, clip_low.y));
  const ImVec2 to(std::min(high.x, clip_high.x), std::min(high.y, clip_high.y));
  LabelPlace place{from.x, from.y, to.x - from.x, to.y - from.y};
  if (!is_enough(place.width, high.x - low.x) || !is_enough(place.height, high.y - low.y))
    place = {low.x, low.y, high.x - low.x, high.y - low.y, false};
  if (Labels::of_panels().note(shown_part(name), place, ImGui::GetFrameCount()))
    ImGui::SetScrollHereY(0.5f);
}

void note_label(const char* name, const LabelPlace& place) {
  Labels::of_panels().note(shown_part(name), place, ImGui::GetFrameCount());
}

bool labelled_button(const char* words, const char* name) {
  const bool is_pressed = ImGui::Button(words);
  note_label(name ? name : words);
  return is_pressed;
}

}  // namespace neve::app::view::panels
