/// Inside the step: stages with their bypass switches, and what was clicked on.

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/text.h"
#include "app/view/labels.h"
#include "app/view/viewer_state.h"

namespace neve::app {

namespace {

const ImVec4 strange_color{1.0f, 0.42f, 0.32f, 1};
const ImVec4 done_color{0.55f, 0.8f, 1.0f, 1};

std::string expected_text(const std::optional<Range>& expected) {
  if (!expected) return "";
  const auto number = [](double x) {
    return std::isfinite(x) ? rough_text(x) : std::string(x > 0 ? "any" : "-any");
  };
  return number(expected->min) + " to " + number(expected->max);
}

void cell(const std::string& text, bool is_strange = false) {
  ImGui::TableNextColumn();
  if (is_strange)
    ImGui::TextColored(strange_color, "%s", text.c_str());
  else
    ImGui::TextUnformatted(text.c_str());
}

void draw_stage_table(const StageLook& look) {
  const std::string rows =
      std::to_string(look.rows) + (look.is_of_nodes ? " nodes, " + std::to_string(look.feathers) +
                                                          " of them feather-light and left out"
                                                    : " particles");
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("after %s of a step of %s s: %s", sim::name(look.stage),
                      rough_text(look.dt).c_str(), rows.c_str());
  ImGui::PopTextWrapPos();
  if (!ImGui::BeginTable("stage", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
    return;
  for (const char* title : {"magnitude", "min", "max", "expected"}) ImGui::TableSetupColumn(title);
  ImGui::TableHeadersRow();
  for (const QuantitySummary& quantity : look.quantities) {
    ImGui::TableNextRow();
    cell(quantity.name + (quantity.unit.empty() ? "" : " (" + quantity.unit + ")"),
         quantity.strange > 0);
    if (ImGui::IsItemHovered() && !quantity.why.empty())
      ImGui::SetTooltip("%zu outside of what is expected: %s", quantity.strange,
                        quantity.why.c_str());
    cell(rough_text(quantity.min), quantity.strange > 0);
    cell(rough_text(quantity.max), quantity.strange > 0);
    cell(expected_text(quantity.expected));
  }
  ImGui::EndTable();
}

/// Each stage of a step with a switch that skips it, like the bypass flag of a node.
void draw_stages(ViewerState& state) {
  const LiveFrame& live = *state.live;
  std::vector<sim::Stage> bypass = state.bench.document().scene()->solver.bypass;
  ImGui::TextDisabled("Untick a stage to bypass it.");
  if (ImGui::BeginTable("stages", 2)) {
    for (const auto& named : names(sim::Stage{})) {
      ImGui::TableNextColumn();
      const auto at = std::find(bypass.begin(), bypass.end(), named.value);
      bool is_done = at == bypass.end();
      const bool is_past = live.stage && named.value <= live.stage->stage;
      if (is_past) ImGui::PushStyleColor(ImGuiCol_Text, done_color);
      if (ImGui::Checkbox(named.text, &is_done)) {
        if (is_done)
          bypass.erase(at);
        else
          bypass.push_back(named.value);
        state.bench.set("solver.bypass", toml_literal(to_value(bypass)));
      }
      if (is_past) ImGui::PopStyleColor();
      note_label(named.text);
    }
    ImGui::EndTable();
  }
  if (live.stage)
    draw_stage_table(*live.stage);
  else
    ImGui::TextDisabled("\"Stage\" does them one by one on a copy.");
}

void draw_values(const ProbeRow& row) {
  std::string text;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    text += (k == 0 ? "" : row.values.size() == 9 && k % 3 == 0 ? "\n" : "  ");
    text += row.name == "id" || row.name == "node" ? fixed_text(row.values[k], 0)
                                                   : rough_text(row.values[k]);
  }
  cell(text, row.is_strange);
}

void draw_trace(ViewerState& state) {
  if (state.trace.points.size() < 2) return;
  std::vector<float> values;
  float low = 1e30f, high = -1e30f;
  for (const auto& [time, value] : state.trace.points) {
    values.push_back(static_cast<float>(value));
    low = std::min(low, values.back());
    high = std::max(high, values.back());
  }
  const std::string text = "|" + state.trace.quantity + "| from " +
                           rough_text(static_cast<double>(low)) + " to " +
                           rough_text(static_cast<double>(high)) +
                           ", t = " + fixed_text(state.trace.points.front().first, 3) + " to " +
                           fixed_text(state.trace.points.back().first, 3) + " s";
  ImGui::PlotLines("##trace", values.data(), static_cast<int>(values.size()), 0, nullptr, low, high,
                   ImVec2(-FLT_MIN, 5 * em()));
  ImGui::TextDisabled("%s", text.c_str());
}

void draw_probe(ViewerState& state) {
  const LiveFrame& live = *state.live;
  if (!state.probe) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled(
        "Click a particle in the picture, or with ctrl the nearest node of the "
        "grid, to read all that it carries.");
    ImGui::PopTextWrapPos();
    return;
  }
  if (ImGui::Button("Let go")) {
    set_probe(state, std::nullopt);
    return;
  }
  note_label("Let go");
  ImGui::SameLine();
  ImGui::Checkbox("follow it", &state.follows_probe);
  note_label("follow it");
  if (!live.probe) {
    ImGui::TextDisabled(live.probed == state.probe ? "it is not there" : "reading ...");
    return;
  }
  const ProbeReading& probe = *live.probe;
  const std::string title =
      (probe.is_node ? "node" : "particle " + std::to_string(std::get<std::size_t>(probe.target))) +
      " at " + rough_text(probe.place.x()) + ", " + rough_text(probe.place.y()) + ", " +
      rough_text(probe.place.z()) + " m" + (probe.after.empty() ? "" : ", after " + probe.after);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(title.c_str());
  ImGui::PopTextWrapPos();
  draw_trace(state);
  if (!ImGui::BeginTable("probe", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
    return;
  for (const char* column : {"quantity", "value", "expected"}) ImGui::TableSetupColumn(column);
  ImGui::TableHeadersRow();
  for (const ProbeRow& row : probe.rows) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string name = row.name + (row.unit.empty() ? "" : " (" + row.unit + ")");
    if (ImGui::Selectable(name.c_str(), state.trace.quantity == row.name)) {
      state.trace.quantity = row.name;
      state.trace.points.clear();
    }
    note_label(("probe " + row.name).c_str());
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s\nclick: plotted over time", row.why.empty() ? "" : row.why.c_str());
    draw_values(row);
    cell(expected_text(row.expected));
  }
  ImGui::EndTable();
}

}  // namespace

void draw_inspector(ViewerState& state) {
  if (ImGui::CollapsingHeader("Stages", ImGuiTreeNodeFlags_DefaultOpen)) draw_stages(state);
  note_label("Stages");
  if (ImGui::CollapsingHeader("Probe", ImGuiTreeNodeFlags_DefaultOpen)) draw_probe(state);
  note_label("Probe");
}

}  // namespace neve::app
