/// The inside of a step: stages with their bypass switches, and the probed point.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/health/meanings.h"
#include "app/picture/plots.h"
#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

namespace {

const ImVec4 strange_color{1.0f, 0.42f, 0.32f, 1};
const ImVec4 done_color{0.55f, 0.8f, 1.0f, 1};

std::string expected_text(const std::optional<scene::Range>& expected) {
  if (!expected) return "";
  const auto number = [](double x) {
    return std::isfinite(x) ? rough_text(x) : std::string(x > 0 ? "any" : "-any");
  };
  return number(expected->min) + " to " + number(expected->max);
}

/// The range that is expected, beside the value where there is room, otherwise below it.
void draw_expected(const std::optional<scene::Range>& expected) {
  if (!expected) return;
  const std::string text = "expected " + expected_text(expected);
  const float gap = em(), width = ImGui::CalcTextSize(text.c_str()).x;
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + gap + width < end) ImGui::SameLine(0, gap);
  ImGui::TextDisabled("%s", text.c_str());
}

/// The second column of a row, red where a value is outside its expected range.
void draw_value(const std::string& text, bool is_outside_expected,
                const std::optional<scene::Range>& expected) {
  ImGui::TableNextColumn();
  // A tensor has more than a narrow panel shows in a line.
  if (is_outside_expected) ImGui::PushStyleColor(ImGuiCol_Text, strange_color);
  wrapped_text(text);
  if (is_outside_expected) ImGui::PopStyleColor();
  draw_expected(expected);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return name + (unit.empty() ? "" : " (" + unit + ")");
}

bool begin_quantities(const char* name) {
  if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_RowBg)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

/// The meaning of a symbol, and the range that is expected.
void show_quantity_tip(const session::QuantitySummary& quantity) {
  std::vector<TipLine> lines;
  if (std::string meaning = health::meaning_of(quantity.name); !meaning.empty())
    lines.push_back({std::move(meaning)});
  if (!quantity.why.empty())
    lines.push_back({std::to_string(quantity.magnitudes.outside_expected) +
                         " outside the expected range: " + quantity.why,
                     true});
  lines.push_back({"click for its histogram", true});
  show_tip(lines);
}

void draw_stage_table(ViewerState& state, const session::StageSummary& look) {
  const std::string rows =
      std::to_string(look.rows) + (look.is_of_nodes ? " nodes, " + std::to_string(look.negligible) +
                                                          " of them too light and left out"
                                                    : " particles");
  wrapped_text(std::string("after ") + sim::name(look.stage) + " of a step of " +
                   rough_text(look.dt) + " s: magnitudes of " + rows,
               ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  if (!begin_quantities("stage")) return;
  for (const session::QuantitySummary& quantity : look.quantities) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const session::FieldName field{look.is_of_nodes, quantity.name};
    if (ImGui::Selectable(with_unit(quantity.name, quantity.unit).c_str(),
                          state.is_histogram_open && state.histogram == field)) {
      state.histogram = field;
      state.wants_histogram = true;
    }
    note_label(("stage " + quantity.name).c_str());
    if (wants_tip()) show_quantity_tip(quantity);
    const dump::Extremes& m = quantity.magnitudes;
    draw_value(std::isnan(m.least) ? "-" : rough_text(m.least) + " to " + rough_text(m.greatest),
               m.outside_expected > 0, quantity.expected);
  }
  ImGui::EndTable();
}

/// Phase of the fused driver that contains a stage, and its time.
struct StagePhase {
  const char* name;
  sim::Stage first;
  double seconds;
};

StagePhase phase_of(sim::Stage stage, const sim::PhaseSeconds& p) {
  using enum sim::Stage;
  if (stage <= elastic_forces) return {"particles to grid", rasterize, p.particles_to_grid};
  if (stage <= grid_collisions) return {"grid update", grid_velocities, p.grid_update};
  if (stage == implicit_solve) return {"solve", implicit_solve, p.solve};
  if (stage <= advection) return {"grid to particles", deformation, p.grid_to_particles};
  return {"", colliders, 0};
}

/// Time of a stage: its own if a step was taken stage by stage, otherwise that of its phase.
std::string stage_time_text(const session::LiveFrame& live, sim::Stage stage) {
  if (live.stage) {
    const auto& seconds = live.stage->seconds;
    const double own = seconds[static_cast<std::size_t>(stage)];
    const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
    if (!(own > 0)) return "";
    return fixed_text(1e3 * own, own < 0.01 ? 2 : 0) + " ms, " + fixed_text(100 * own / all, 0) +
           " %";
  }
  const StagePhase phase = phase_of(stage, live.phases);
  if (!(phase.seconds > 0)) return "";
  if (stage != phase.first) return "as above";
  return fixed_text(100 * phase.seconds / live.phases.total(), 0) + " %, " + phase.name;
}

/// A row: the switch that skips the stage, its name, its time.
void draw_stage(ViewerState& state, sim::Stage stage, const char* name) {
  const session::LiveFrame& live = *state.live;
  std::vector<sim::Stage> bypass = state.bench.document().scene()->solver.bypass;
  const auto at = std::find(bypass.begin(), bypass.end(), stage);
  bool is_done = at == bypass.end();
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::PushID(name);
  if (ImGui::Checkbox("##bypass", &is_done)) {
    if (is_done)
      bypass.erase(at);
    else
      bypass.push_back(stage);
    state.bench.set("solver.bypass", scene::toml::toml_literal(scene::to_value(bypass)));
  }
  note_label((std::string("switch ") + name).c_str());
  tip("untick to skip the stage, like a bypassed node");
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  const bool is_past = live.stage && stage <= live.stage->stage;
  if (is_past) ImGui::PushStyleColor(ImGuiCol_Text, done_color);
  const bool is_shown = live.stage && stage == live.stage->stage;
  if (ImGui::Selectable(name, is_shown)) {
    session::Session& session = state.bench.session();
    is_shown ? session.leave_stage() : session.show_stage(stage);
  }
  if (is_past) ImGui::PopStyleColor();
  note_label(name);
  if (wants_tip()) {
    const health::StageMeaning& meaning = health::meaning_of(stage);
    show_tip({{meaning.sentence},
              {std::string("the paper, ") + meaning.paper, true},
              {"click to take a step on a copy, up to the end of this stage; click again to return "
               "to the frame",
               true}});
  }
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", is_done ? stage_time_text(live, stage).c_str() : "skipped");
  ImGui::PopID();
}

/// Draws each stage of a step with a switch that skips it, like the bypass flag of a node.
void draw_stages(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  if (ImGui::BeginTable("stages", 3, ImGuiTableFlags_NoPadOuterX)) {
    ImGui::TableSetupColumn("switch", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthStretch);
    for (const auto& named : scene::names(sim::Stage{})) draw_stage(state, named.value, named.text);
    ImGui::EndTable();
  }
  dim_text(live.stage       ? "Time of each stage of this one step, taken stage by "
                              "stage on a copy. The run itself is faster."
           : live.steps > 0 ? "Time of the run so far, by phase, because the run joins the "
                              "stages of a phase. Click a stage for its own time."
                            : "Click a stage to inspect a step, on a copy.");
  if (live.stage) draw_stage_table(state, *live.stage);
}

/// Tensors have a line for each row.
std::string values_text(const session::ProbeRow& row) {
  std::string text;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    text += (k == 0 ? "" : row.values.size() == 9 && k % 3 == 0 ? "\n" : "  ");
    text += row.name == "id" || row.name == "node" ? fixed_text(row.values[k], 0)
                                                   : rough_text(row.values[k]);
  }
  return text;
}

void draw_trace(const ViewerState& state) {
  const ProbeTrace& trace = state.trace;
  if (trace.points.size() < 2) return;
  std::string unit;
  for (const session::ProbeRow& row : state.live->probe->rows)
    if (row.name == trace.quantity) unit = row.unit;
  constexpr picture::Rgb blue{110, 190, 255};
  render::PlotSeries series{.name = "", .color = blue, .x = {}, .value = {}};
  for (const auto& [time, value] : trace.points) {
    series.x.push_back(static_cast<float>(time));
    series.value.push_back(static_cast<float>(value));
  }
  draw_over_time(state, "probe plot", with_unit("|" + trace.quantity + "|", unit),
                 {std::move(series)}, false);
}

void draw_probe(ViewerState& state) {
  const session::LiveFrame& live = *state.live;
  if (!state.probe) {
    dim_text(
        "Click a particle in the picture, or ctrl-click the nearest node of the grid, to read its "
        "values.");
    return;
  }
  if (labelled_button("Clear")) {
    set_probe(state, std::nullopt);
    return;
  }
  ImGui::SameLine();
  ImGui::Checkbox("follow it", &state.follows_probe);
  note_label("follow it");
  if (!live.probe) {
    ImGui::TextDisabled(live.probed == state.probe ? "it does not exist now" : "reading ...");
    return;
  }
  const session::ProbeReading& probe = *live.probe;
  const std::string title =
      (probe.is_node ? "node" : "particle " + std::to_string(std::get<std::size_t>(probe.target))) +
      " at " + rough_text(probe.place.x()) + ", " + rough_text(probe.place.y()) + ", " +
      rough_text(probe.place.z()) + " m" + (probe.after.empty() ? "" : ", after " + probe.after) +
      (probe.time == live.snapshot.time ? "" : ", at " + fixed_text(probe.time, 3) + " s");
  wrapped_text(title);
  draw_trace(state);
  if (!begin_quantities("probe")) return;
  for (const session::ProbeRow& row : probe.rows) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ImGui::Selectable(with_unit(row.name, row.unit).c_str(),
                          state.trace.quantity == row.name)) {
      state.trace.quantity = row.name;
      state.trace.points.clear();
    }
    note_label(("probe " + row.name).c_str());
    if (wants_tip()) {
      std::vector<TipLine> lines;
      if (std::string meaning = health::meaning_of(row.name); !meaning.empty())
        lines.push_back({std::move(meaning)});
      if (!row.why.empty()) lines.push_back({"expected: " + row.why, true});
      lines.push_back({"click to plot it over time", true});
      show_tip(lines);
    }
    draw_value(values_text(row), row.is_outside_expected, row.expected);
  }
  ImGui::EndTable();
}

}  // namespace

void draw_inspector(ViewerState& state) {
  const bool shows_stages = ImGui::CollapsingHeader("Stages", ImGuiTreeNodeFlags_DefaultOpen);
  note_label("Stages");
  if (shows_stages) draw_stages(state);
  const bool shows_probe = ImGui::CollapsingHeader("Probe", ImGuiTreeNodeFlags_DefaultOpen);
  note_label("Probe");
  if (shows_probe) draw_probe(state);
  draw_histogram(state);
}

}  // namespace neve::app::view::panels
