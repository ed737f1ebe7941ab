/// The bar at the top: control of the simulation, and exports.

#include <imgui.h>

#include <cmath>
#include <string>
#include <vector>

#include "app/record/run_json.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

namespace {

/// Starts a new row if the current one has no room for the next item.
void start_item(float width) {
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetCursorScreenPos().x + width > end) ImGui::NewLine();
}

bool button(const char* label, const char* what, bool is_enabled = true, bool is_marked = false) {
  start_item(ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x);
  if (!is_enabled) ImGui::BeginDisabled();
  if (is_marked) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.16f, 0.46f, 0.78f, 1));
  const bool is_pressed = ImGui::Button(label);
  if (is_marked) ImGui::PopStyleColor();
  if (!is_enabled) ImGui::EndDisabled();
  note_label(label);
  tip(what);
  ImGui::SameLine();
  return is_pressed && is_enabled;
}

void gap() {
  ImGui::Dummy(ImVec2(0.5f * em(), 0));
  ImGui::SameLine();
}

bool item(const char* label, const char* key = nullptr, bool is_on = false) {
  const bool is_chosen = ImGui::MenuItem(label, key, is_on);
  note_label(label);
  return is_chosen;
}

/// A download is written as a file first, so that both machines have it.
void draw_download_items(ViewerState& state) {
  ImGui::Separator();
  if (item("Download the picture")) state.wants_picture = state.is_picture_downloaded = true;
  if (item("Download the scene with the changes")) {
    if (const std::filesystem::path file = state.bench.save_copy(); !file.empty())
      state.download(file);
  }
  if (item("Download a file ...")) open_file_list(state);
  ImGui::Separator();
}

void draw_out_menu(ViewerState& state) {
  if (button("Save ...", "save pictures, sequences, the scene, a command line"))
    ImGui::OpenPopup("out");
  if (!ImGui::BeginPopup("out")) return;
  // Only pictures of frames can be made again: between two, the run first advances to the next.
  const bool is_frame = state.live->is_frame_end && !state.live->is_running;
  if (item(is_frame ? "Picture of this frame" : "Picture of the next frame", "P"))
    state.wants_picture = true;
  if (item("Record every frame", nullptr, state.is_recording)) {
    state.is_recording = !state.is_recording;
    state.bench.session().set_recording(state.is_recording);
  }
  ImGui::Separator();
  if (item("Scene with the changes", "ctrl+S")) state.bench.save_copy();
  if (state.bench.may_save_over_file() && item("Scene with the changes, over its file"))
    state.bench.save_scene(state.bench.document().file());
  if (state.download) draw_download_items(state);
  if (item("Copy the command line")) copy_command(state);
  ImGui::EndPopup();
}

/// "250 times slower than real time"
std::string speed_text(double speed) {
  if (speed >= 0.95) return rough_text(speed) + " times real time";
  const double slower = 1 / speed;
  return (slower < 10 ? rough_text(round_to(slower, slower, 2)) : fixed_text(slower, 0)) +
         " times slower than real time";
}

/// "frame 12 of 48   t = 0.512 s   step 812   5 times slower than real time", or as much of it as
/// there is room for.
std::string status_text(const session::LiveFrame& live, float room) {
  std::string text;
  const auto add = [&](const std::string& more) {
    const std::string longer = text + (text.empty() ? "" : "   ") + more;
    if (ImGui::CalcTextSize(longer.c_str()).x <= room) text = longer;
  };
  const auto number = [&](int frame) {
    return std::to_string(scene::number_of(*live.scene, frame));
  };
  const std::string frame = number(live.frame), last = number(scene::last_frame(*live.scene));
  const std::string time = fixed_text(live.snapshot.time, 4) + " s";
  add("frame " + frame + " of " + last + "   t = " + time);
  if (text.empty()) add(frame + "/" + last + "   " + time);
  if (text.empty()) add(time);
  if (live.is_running && live.speed > 0) add(speed_text(live.speed));
  add("step " + std::to_string(live.steps));
  return text;
}

}  // namespace

void draw_transport(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  session::Session& session = state.bench.session();
  const bool is_broken = live.is_head_broken;
  const float first_row = ImGui::GetCursorPosY();
  if (live.is_running) {
    if (button("Pause", "stop after this step (space)", true, true)) session.pause();
  } else {
    const bool is_at_end = !live.is_older && live.frame >= scene::last_frame(*live.scene);
    if (button("Run",
               is_broken   ? "the run broke a rule: reset it, or continue from an older frame"
               : is_at_end ? "the run has reached its last frame: raise `frames` to continue"
                           : "simulate (space)",
               !is_broken && !is_at_end)) {
      state.is_playing = false;
      session.run();
    }
  }
  if (button("Frame", "simulate to the end of the frame (.)", !is_broken)) session.next_frame();
  if (button("Step", "one step (,)", !is_broken)) session.next_step();
  if (button("Stage", "the next stage of a step, on a copy (;)", !live.divergence)) {
    session.next_stage();
    state.go_to_tab = tab::inspect;
  }
  const std::vector<std::string> waiting = state.bench.waiting_for_reset();
  if (button("Reset",
             waiting.empty() ? "go back to the first frame (R)"
                             : "go back to the first frame with the values that wait for it (R)",
             true, !waiting.empty()))
    state.bench.reset();
  gap();
  if (button("Undo", "undo the last change (ctrl+Z)", state.bench.document().can_undo()))
    state.bench.undo();
  if (button("Redo", "ctrl+Y", state.bench.document().can_redo())) state.bench.redo();
  gap();
  draw_out_menu(state);
  if (button("?", "keys and mouse")) state.is_help_open = !state.is_help_open;
  if (button("Tour", "a guided tour of ten steps", true, state.tour_step >= 0)) start_tour(state);
  PanelSwitches& panels = state.panels;
  if (panels.is_one_of_two() &&
      button(panels.prefers_right ? "Parameters" : "View",
             panels.prefers_right ? "show parameters, objects and changes in the column"
                                  : "show view, inspection, plots and messages in the column"))
    panels.prefers_right = !panels.prefers_right;
  if (panels.is_narrow && button("Hide", "show the picture alone (tab)"))
    panels.left = panels.right = false;
  state.bar_rows = 1 + static_cast<int>(std::lround((ImGui::GetCursorPosY() - first_row) /
                                                    ImGui::GetFrameHeightWithSpacing()));
  gap();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(status_text(live, ImGui::GetContentRegionAvail().x).c_str());
  if (state.is_recording) {
    ImGui::SameLine();
    ImGui::TextColored(ImVec4(1, 0.35f, 0.3f, 1), "recording: %d", state.recorded);
  }
}

}  // namespace neve::app::view::panels
