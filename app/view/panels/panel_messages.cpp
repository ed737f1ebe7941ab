/// Messages and incidents, the time line of kept frames, help.

#include <fmt/core.h>
#include <imgui_internal.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "app/health/incident.h"
#include "app/support/text.h"
#include "app/view/panels/beside.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

namespace {

ImVec4 message_color(session::Message::Kind kind) {
  if (kind == session::Message::Kind::error) return {1.0f, 0.42f, 0.32f, 1};
  if (kind == session::Message::Kind::warning) return {1.0f, 0.80f, 0.35f, 1};
  return {0.80f, 0.84f, 0.90f, 1};
}

void draw_incident(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  if (!live.divergence || !live.diagnosis) return;
  wrapped_text(health::sentence(*live.divergence, *live.diagnosis),
               message_color(session::Message::Kind::error));
  if (labelled_button("Show me")) show_incident(state);
  ImGui::SameLine();
  if (!live.diagnosis->address.empty()) {
    if (labelled_button("Find the parameter")) {
      state.filter = live.diagnosis->address;
      state.go_to_parameters = state.panels.left = true;
      state.panels.prefers_right = false;
    }
  }
  const bool is_ignored = live.scene->solver.on_divergence == sim::OnDivergence::ignore;
  if (!is_ignored && !sim::is_final_rule(live.divergence->rule)) {
    if (labelled_button("Continue anyway")) {
      state.shows_incident = false;
      state.bench.continue_anyway();
    }
    tip("from the last kept frame, past the broken rule, to watch the snow burst;\n"
        "pictures say so");
  }
  ImGui::Separator();
}

void draw_keys(const char* keys, const char* what) {
  ImGui::TableNextRow();
  for (const char* words : {keys, what}) {
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(words);
    ImGui::PopTextWrapPos();
  }
}

/// A tick for every kept frame, on the bar of the slider that was drawn last.
void draw_ticks(const session::LiveFrame& live, int last) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float margin = 0.5f * ImGui::GetStyle().GrabMinSize + 2;
  for (const int frame : live.kept) {
    const float part = last > 0 ? static_cast<float>(frame) / static_cast<float>(last) : 0;
    const float x = low.x + margin + part * (high.x - low.x - 2 * margin);
    list.AddLine(ImVec2(x, high.y - 3), ImVec2(x, high.y), IM_COL32(120, 190, 255, 200));
  }
}

/// Keyframes of a thing in the scene: its name, and their times.
struct Keys {
  std::string name;
  std::vector<double> times;
};

std::vector<Keys> keys_of(const scene::Scene& scene) {
  std::vector<Keys> all;
  const auto add = [&](const std::string& name, const auto& keyframes) {
    if (keyframes.empty()) return;
    all.push_back({name, {}});
    for (const auto& key : keyframes) all.back().times.push_back(key.time);
  };
  for (const scene::Curve& curve : scene.curves) add(curve.parameter, curve.keyframes);
  for (const scene::Collider& collider : scene.colliders)
    add("collider." + collider.name, collider.keyframes);
  if (scene.camera) add("camera", scene.camera->keyframes);
  return all;
}

/// A diamond for every keyframe, on the upper edge of the bar that was drawn last; the mouse near
/// one names it.
void draw_keyframes(const session::LiveFrame& live, int last) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const bool is_hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float margin = 0.5f * ImGui::GetStyle().GrabMinSize + 2;
  const double end = last / live.scene->fps;
  std::string near;
  for (const Keys& keys : keys_of(*live.scene))
    for (const double time : keys.times) {
      if (!(end > 0) || time > end * (1 + 1e-9)) continue;
      const float x =
          low.x + margin + static_cast<float>(time / end) * (high.x - low.x - 2 * margin);
      const float r = 0.22f * em(), y = low.y + r;
      list.AddQuadFilled(ImVec2(x - r, y), ImVec2(x, y - r), ImVec2(x + r, y), ImVec2(x, y + r),
                         IM_COL32(255, 196, 84, 235));
      if (is_hovered && std::abs(ImGui::GetMousePos().x - x) < 2 * r)
        near += fmt::format("{}{}: keyframe at {} s", near.empty() ? "" : "\n", keys.name,
                            rough_text(time));
    }
  if (!near.empty()) ImGui::SetTooltip("%s", near.c_str());
}

/// Asks before later frames are dropped, above the button: a second press there is no answer.
void draw_question(ViewerState& state, ImVec2 at) {
  const session::LiveFrame& live = *state.live;
  if (!live.is_older) state.asks_to_continue = false;
  if (!state.asks_to_continue) return;
  const int start = scene::number_of(*live.scene, 0), first = start + live.frame + 1;
  ImGui::SetNextWindowPos(ImVec2(at.x, at.y - 0.5f * em()), ImGuiCond_Always, ImVec2(0.5f, 1));
  if (ImGui::Begin("question", nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::TextUnformatted(
        ((first > start + live.head
              ? fmt::format("Continuing here drops the steps after frame {}", first - 1)
          : first == start + live.head ? fmt::format("Continuing here drops frame {}", first)
                                       : fmt::format("Continuing here drops the frames {} to {}",
                                                     first, start + live.head)) +
         ".\nValues that were changed later take effect from here on.")
            .c_str());
    if (labelled_button("Drop them and continue")) {
      state.asks_to_continue = false;
      state.bench.continue_from_here();
    }
    ImGui::SameLine();
    if (labelled_button("Keep them")) state.asks_to_continue = false;
  }
  ImGui::End();
}

/// Returns the width of buttons, with the gap before each.
float width_of_buttons(std::initializer_list<const char*> names) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = 0;
  for (const char* name : names)
    width += style.ItemSpacing.x + ImGui::CalcTextSize(name).x + 2 * style.FramePadding.x;
  return width;
}

}  // namespace

void draw_messages(ViewerState& state) {
  draw_incident(state);
  const std::deque<session::Message>& messages = state.bench.messages();
  if (messages.empty() && !state.live->divergence) ImGui::TextDisabled("Nothing to report.");
  for (auto message = messages.rbegin(); message != messages.rend(); ++message) {
    wrapped_text(message->text, message_color(message->kind));
    ImGui::Spacing();
  }
}

void draw_time_line(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  const int last = std::max(scene::last_frame(*live.scene), live.head),
            start = scene::number_of(*live.scene, 0);
  if (ImGui::Button(state.is_playing ? "Stop" : "Play")) {
    state.is_playing = !state.is_playing;
    state.play_clock = 0;
    if (state.is_playing) {
      state.bench.session().pause();
      if (!live.is_older) show_frame(state, 0);
    }
  }
  note_label(state.is_playing ? "Stop" : "Play");
  tip("play the kept frames, without simulating");
  ImGui::SameLine();
  // Widths are the same for all frames, so that no button comes to lie where another was.
  const float room = ImGui::GetContentRegionAvail().x;
  const std::string largest = std::to_string(start + last);
  const float in_full =
                  width_of_buttons({"Vary from here", "Continue from here", "Back to the run"}),
              in_short = width_of_buttons({"Vary", "Continue", "Back"}),
              word = ImGui::CalcTextSize("frame ").x,
              number = ImGui::CalcTextSize(largest.c_str()).x + 0.6f * em();
  const bool is_short = room - word - number - in_full < 14 * em();
  const float right = is_short ? in_short : in_full;
  const bool has_word = room - word - number - right >= 6 * em();
  // The number is beside the bar, where the grab cannot cover it, and as wide for every frame.
  ImGui::AlignTextToFramePadding();
  ImGui::Text("%s%d", has_word ? "frame " : "", start + live.frame);
  ImGui::SameLine(ImGui::GetItemRectMin().x - ImGui::GetWindowPos().x + (has_word ? word : 0) +
                  number);
  ImGui::SetNextItemWidth(std::max(2 * em(), ImGui::GetContentRegionAvail().x - right));
  int frame = start + live.frame;
  const bool is_typed = ImGui::TempInputIsActive(ImGui::GetID("##time"));
  if (!is_typed) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_BLACK_TRANS);
  const bool is_moved = ImGui::SliderInt("##time", &frame, start, start + last);
  if (!is_typed) ImGui::PopStyleColor();
  if (is_moved) {
    state.is_playing = false;
    show_frame(state, std::max(0, frame - start));
  }
  note_label("time line");
  tip(fmt::format("{} frames are kept, {}; beyond {} older ones are thinned out", live.kept.size(),
                  bytes_text(live.kept_bytes), bytes_text(live.kept_budget))
          .c_str());
  draw_ticks(live, last);
  draw_keyframes(live, last);
  const auto button = [&](const char* name, const char* short_name, bool is_on, const char* help) {
    ImGui::SameLine();
    ImGui::BeginDisabled(!is_on);
    const bool is_pressed = ImGui::Button(is_short ? short_name : name);
    ImGui::EndDisabled();
    note_label(name);
    tip(help);
    return is_pressed;
  };
  if (button("Vary from here", "Vary", true, "runs that begin at this frame, with other values"))
    open_sweep(state);
  if (button("Continue from here", "Continue", live.is_older,
             "simulate from this frame with the current values;\nlater frames are dropped, after a "
             "question"))
    state.asks_to_continue = !state.asks_to_continue;
  const ImVec2 asked_at = ImGui::GetItemRectMin();
  if (button("Back to the run", "Back", live.is_older, "show the newest frame"))
    state.bench.session().show_head();
  draw_question(state, asked_at);
}

void draw_help(ViewerState& state) {
  if (!state.is_help_open) return;
  // The help lies over a column, so that what it explains can be seen.
  const PanelPlace place = column_beside(state);
  ImGui::SetNextWindowPos(place.at);
  ImGui::SetNextWindowSize(place.size);
  if (!ImGui::Begin("Keys and mouse", &state.is_help_open,
                    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::End();
    return;
  }
  note_label("keys and mouse", {place.at.x, place.at.y, place.size.x, place.size.y});
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg)) {
    draw_keys("left drag", "orbit");
    draw_keys("middle drag, shift + left drag", "pan");
    draw_keys("wheel, right drag", "zoom towards the mouse");
    draw_keys("click", "inspect the particle");
    draw_keys("ctrl + click", "inspect the node of the grid");
    draw_keys("B, then click", "throw a ball; B or escape ends it");
    draw_keys("space", "run and pause");
    draw_keys(".   ,   ;", "next frame, step, stage");
    draw_keys("R", "reset to the first frame");
    draw_keys("left, right, home, end", "kept frames");
    draw_keys("1 to 9", "the first nine views");
    draw_keys("F   shift + F", "frame the selection; everything");
    draw_keys("X   Y   Z", "look along an axis; press again for the other side");
    draw_keys("P", "save a picture");
    draw_keys("ctrl + S", "save the scene with its changes");
    draw_keys("ctrl + Z   ctrl + Y", "undo, redo");
    draw_keys("tab", "show or hide the panels");
    draw_keys("ctrl + click on a slider", "type a number");
    draw_keys("right click on a parameter", "restore its value, sweep around it");
    draw_keys("?   escape", "this list; close it, clear the probe");
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace neve::app::view::panels
