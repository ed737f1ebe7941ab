/// The dialog "Vary from here": parameters, values, and the sweep that is made of them.

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <string>
#include <vector>

#include "app/scene/flat.h"
#include "app/scene/search.h"
#include "app/support/text.h"
#include "app/view/panels/beside.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

namespace {

constexpr std::size_t max_axes = 2, max_found = 8;

/// Live parameters of the simulation that a text means; without a text those of materials.
std::vector<scene::FlatParam> found_parameters(const ViewerState& state) {
  const scene::Search search(state.sweep.filter);
  std::vector<scene::FlatParam> found;
  for (scene::FlatParam& param : scene::flatten(*state.live->scene)) {
    if (!param.is_live || !scene::concerns_simulation(param.address)) continue;
    if (param.type == "table" || param.type == "tables" || param.type == "string") continue;
    const bool is_meant = search.is_empty() ? param.address.starts_with("material.")
                                            : search.finds(param.address, param.help);
    const bool is_chosen =
        std::any_of(state.sweep.axes.begin(), state.sweep.axes.end(),
                    [&](const session::SweepAxis& axis) { return axis.address == param.address; });
    if (is_meant && !is_chosen) found.push_back(std::move(param));
  }
  // A name that is meant comes before a description that mentions it.
  std::stable_partition(found.begin(), found.end(),
                        [&](const scene::FlatParam& param) { return search.names(param.address); });
  return found;
}

void draw_found(ViewerState& state) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  ImGui::InputTextWithHint("##vary", "find a parameter to vary", &state.sweep.filter);
  note_label("find a parameter to vary");
  const std::vector<scene::FlatParam> found = found_parameters(state);
  if (found.empty()) wrapped_text("No parameter of this name can change while a simulation runs.");
  for (std::size_t k = 0; k < std::min(found.size(), max_found); ++k) {
    if (ImGui::Selectable((found[k].address + " = " + found[k].text()).c_str())) {
      state.sweep.axes.push_back({found[k].address, session::Workbench::values_around(found[k])});
      state.sweep.filter.clear();
    }
    note_label(("vary " + found[k].address).c_str());
    tip(found[k].help);
  }
  if (found.size() > max_found)
    ImGui::TextDisabled("and %zu more: type a part of the name", found.size() - max_found);
}

void draw_axes(ViewerState& state) {
  std::vector<session::SweepAxis>& axes = state.sweep.axes;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    ImGui::PushID(static_cast<int>(k));
    const bool is_removed = ImGui::SmallButton("x");
    note_label(("omit " + axes[k].address).c_str());
    ImGui::SameLine();
    ImGui::TextUnformatted(axes[k].address.c_str());
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputText("##values", &axes[k].values);
    note_label(("values of " + axes[k].address).c_str());
    tip("one run for each value, separated by commas; two parameters: all combinations");
    ImGui::PopID();
    if (!is_removed) continue;
    axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(k));
    return;
  }
}

void start_sweep(ViewerState& state) {
  state.sweep.error = state.bench.vary_from_here(
      {state.sweep.axes, state.sweep.last_frame, state.sweep.has_longer_steps},
      view_to_keep(state));
  state.sweep.waits_for_sheet = state.sweep.error.empty();
  state.sweep.shows_sheet = false;
}

void draw_form(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  wrapped_text("Runs that begin at exactly frame " +
               std::to_string(scene::number_of(*live.scene, live.frame)) + ", " +
               rough_text(live.frame / live.scene->fps) +
               " s, with the state shown here and the changes made before it.");
  draw_axes(state);
  if (state.sweep.axes.size() < max_axes) draw_found(state);
  ImGui::Separator();
  ImGui::SetNextItemWidth(9 * em());
  int last_number = scene::number_of(*live.scene, state.sweep.last_frame);
  if (ImGui::InputInt("until frame", &last_number))
    state.sweep.last_frame = scene::frame_of(*live.scene, last_number);
  note_label("until frame");
  ImGui::Checkbox("longer steps, for a quick look", &state.sweep.has_longer_steps);
  note_label("longer steps, for a quick look");
  tip("the settings of --fast that fit; cells stay as they are, because the state has them");
  const bool can_start = live.is_frame_end && !live.is_running && !state.sweep.axes.empty();
  if (!can_start) ImGui::BeginDisabled();
  if (labelled_button("Start the runs")) start_sweep(state);
  if (!can_start) ImGui::EndDisabled();
  if (!live.is_frame_end || live.is_running)
    wrapped_text("Runs begin at the end of a frame: pause, or go to one on the time line.");
  if (state.sweep.error.empty()) return;
  wrapped_text(state.sweep.error, ImVec4(1, 0.45f, 0.4f, 1));
}

void draw_running(ViewerState& state, const session::ViewSweepProgress& progress) {
  const int finished = progress.ok + progress.failed;
  wrapped_text(std::to_string(finished) + " of " + std::to_string(progress.runs) +
               " runs are finished");
  ImGui::ProgressBar(static_cast<float>(progress.share), ImVec2(-FLT_MIN, 1.2f * em()));
  if (labelled_button("Stop the runs")) state.bench.sweep().stop();
}

/// The report shows pictures of its folder: a page gets both in one file.
void download_sweep(ViewerState& state) {
  try {
    state.download(state.bench.sweep().pack());
  } catch (const std::exception& error) {
    state.sweep.error = error.what();
  }
}

/// Downloads where the files are on another machine, otherwise their paths.
void draw_files_of_sweep(ViewerState& state, const session::ViewSweepProgress& progress) {
  if (state.download) {
    if (labelled_button("Download the sheet")) state.download(progress.sheet());
    if (labelled_button("Download report and pictures")) download_sweep(state);
    tip("an archive: unpack it, and open report.html");
  }
  for (const auto& [name, file] :
       {std::pair{"sheet", progress.sheet()}, std::pair{"report", progress.report()}}) {
    wrapped_text(std::string(name) + ": " + file.string());
    if (!state.download && labelled_button((std::string("Copy the path of the ") + name).c_str()))
      state.copy(std::filesystem::absolute(file).string());
  }
}

void draw_result(ViewerState& state, const session::ViewSweepProgress& progress) {
  using State = session::ViewSweepProgress::State;
  ImGui::Separator();
  if (progress.state == State::failed) wrapped_text("The sweep failed: " + progress.error);
  if (progress.state == State::stopped) wrapped_text("Stopped. The command continues from there.");
  if (progress.state == State::done) {
    wrapped_text(std::to_string(progress.ok) + " of " + std::to_string(progress.runs) +
                 " runs are finished" +
                 (progress.failed > 0 ? ", " + std::to_string(progress.failed) + " failed" : "") +
                 ".");
    bool& is_shown = state.sweep.shows_sheet;
    if (labelled_button(is_shown ? "Show the run" : "Show the sheet", "Show the sheet"))
      is_shown = !is_shown;
    tip("the contact sheet in the place of the picture; a click on it shows the run again");
    draw_files_of_sweep(state, progress);
  }
  if (labelled_button("Copy the command of the sweep")) state.copy(progress.command);
  tip(progress.command.c_str());
}

}  // namespace

void open_sweep(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  state.is_playing = false;
  state.sweep.is_open = true;
  state.sweep.error.clear();
  const int shown = live.is_running || !live.is_frame_end ? live.frame + 1 : live.frame;
  state.sweep.last_frame = std::max(scene::last_frame(*live.scene), shown + 1);
  // The end of the frame that it is in.
  if (live.is_running || !live.is_frame_end) state.bench.session().next_frame();
}

void draw_sweep(ViewerState& state) {
  if (!state.sweep.is_open) {
    state.sweep.shows_sheet = false;
    return;
  }
  const PanelPlace place = column_beside(state);
  ImGui::SetNextWindowPos(place.at);
  ImGui::SetNextWindowSize(place.size);
  if (ImGui::Begin("Vary from here", &state.sweep.is_open,
                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    note_label("sweep", {place.at.x, place.at.y, place.size.x, place.size.y});
    const session::ViewSweepProgress& progress = state.bench.sweep().progress();
    using State = session::ViewSweepProgress::State;
    if (state.sweep.waits_for_sheet && progress.state != State::running) {
      state.sweep.waits_for_sheet = false;
      state.sweep.shows_sheet = progress.state == State::done && !state.live->is_running;
    }
    if (state.bench.sweep().is_running()) {
      draw_running(state, progress);
    } else {
      draw_form(state);
      if (progress.state != session::ViewSweepProgress::State::none) draw_result(state, progress);
    }
  }
  ImGui::End();
}

}  // namespace neve::app::view::panels
