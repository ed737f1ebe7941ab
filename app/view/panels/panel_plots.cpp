/// Plots of the run over time: energies, momentum, dt with the limit that set it, and the times of
/// the phases of a step.

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <functional>
#include <string>

#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/viewer_state.h"
#include "render/overlay/ticks.h"

namespace neve::app::view::panels {

namespace {

struct Curve {
  const char* name;
  ImU32 color;
  std::function<double(const session::RunSample&)> value;
};

ImU32 limit_color(sim::DtLimit limit) {
  switch (limit) {
    case sim::DtLimit::max_dt:
      return IM_COL32(150, 160, 175, 255);
    case sim::DtLimit::cfl:
      return IM_COL32(110, 190, 255, 255);
    case sim::DtLimit::acoustic:
      return IM_COL32(255, 175, 80, 255);
    case sim::DtLimit::strain:
      return IM_COL32(240, 110, 150, 255);
    case sim::DtLimit::fixed:
      return IM_COL32(170, 220, 130, 255);
    case sim::DtLimit::frame_end:
      return IM_COL32(110, 120, 130, 255);
    case sim::DtLimit::collider:
      return IM_COL32(225, 110, 60, 255);
  }
  return IM_COL32_WHITE;
}

/// Names of curves in their colours.
using Legend = std::vector<std::pair<std::string, ImU32>>;

/// On the line of the title where there is room.
void draw_legend(const Legend& names) {
  for (const auto& [name, color] : names) {
    const float width = ImGui::CalcTextSize(name.c_str()).x + em();
    if (ImGui::GetItemRectMax().x + width < ImGui::GetWindowPos().x + ImGui::GetWindowWidth())
      ImGui::SameLine(0, em());
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color), "%s", name.c_str());
  }
}

/// A panel with its frame, title and legend above it, the range of its axis inside and the time
/// below it.
class Chart {
 public:
  Chart(const std::string& title, const std::string& unit, double t_end, double low, double high,
        const Legend& legend)
      : t_end_(std::max(t_end, 1e-9)), low_(low), high_(high > low ? high : low + 1) {
    ImGui::TextUnformatted((title + (unit.empty() ? "" : " (" + unit + ")")).c_str());
    draw_legend(legend);
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 5.2f * em());
    at_ = ImGui::GetCursorScreenPos();
    to_ = ImVec2(at_.x + size.x, at_.y + size.y);
    list_ = ImGui::GetWindowDrawList();
    list_->AddRectFilled(at_, to_, IM_COL32(10, 13, 19, 255), 3);
    // At the right: the run comes there last.
    if (high > low) label(rough_text(high_), at_.y + 1);
    label(rough_text(low_), to_.y - em() - 2);
    draw_time_axis();
    ImGui::Dummy(ImVec2(size.x, size.y + 1.1f * em()));
    note_label(title.c_str());
  }

  ImVec2 at(double time, double value) const {
    const double x = std::clamp(time / t_end_, 0.0, 1.0);
    const double y = std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
    return {at_.x + static_cast<float>(x) * (to_.x - at_.x),
            to_.y - 2 - static_cast<float>(y) * (to_.y - at_.y - 4)};
  }

  void curve(const std::vector<session::RunSample>& samples, const Curve& curve) const {
    std::vector<ImVec2> points;
    for (const session::RunSample& sample : samples)
      if (const double value = curve.value(sample); std::isfinite(value))
        points.push_back(at(sample.time, value));
    list_->AddPolyline(points.data(), static_cast<int>(points.size()), curve.color, 0, 1.5f);
  }

  void now(double time) const {
    const float x = at(time, low_).x;
    list_->AddLine(ImVec2(x, at_.y), ImVec2(x, to_.y), IM_COL32(255, 255, 255, 90));
  }

  void segment(ImVec2 a, ImVec2 b, ImU32 color) const { list_->AddLine(a, b, color, 2); }

 private:
  void label(const std::string& text, float y) const {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    list_->AddText(ImVec2(to_.x - width - 4, y), IM_COL32(150, 160, 175, 200), text.c_str());
  }

  void draw_time_axis() const {
    const int most = std::clamp(static_cast<int>((to_.x - at_.x) / (4 * em())), 1, 6);
    const std::vector<render::overlay::Tick> ticks = render::overlay::nice_ticks(0, t_end_, most);
    // The last one has the unit and comes first; ticks that would run into it have no number.
    float free = FLT_MAX;
    for (auto tick = ticks.rbegin(); tick != ticks.rend(); ++tick) {
      const float x = at(tick->value, low_).x;
      list_->AddLine(ImVec2(x, at_.y), ImVec2(x, to_.y), IM_COL32(255, 255, 255, 22));
      const std::string text = tick->label + (tick == ticks.rbegin() ? " s" : "");
      const float width = ImGui::CalcTextSize(text.c_str()).x;
      const float left = std::clamp(x - 0.5f * width, at_.x, std::max(at_.x, to_.x - width));
      if (left + width > free) continue;
      free = left - 0.5f * em();
      list_->AddText(ImVec2(left, to_.y), IM_COL32(150, 160, 175, 200), text.c_str());
    }
  }

  ImVec2 at_, to_;
  ImDrawList* list_;
  double t_end_, low_, high_;
};

void draw_curves(const ViewerState& state, const char* title, const char* unit,
                 const std::vector<Curve>& curves) {
  const std::vector<session::RunSample>& samples = *state.live->samples;
  double low = 0, high = 0;
  for (const session::RunSample& sample : samples)
    for (const Curve& curve : curves) {
      const double value = curve.value(sample);
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  const scene::Scene& scene = *state.live->scene;
  Legend legend;
  if (curves.size() > 1)
    for (const Curve& curve : curves) legend.emplace_back(curve.name, curve.color);
  const Chart chart(title, unit, scene.frames / scene.fps, low, high, legend);
  for (const Curve& curve : curves) chart.curve(samples, curve);
  chart.now(state.live->snapshot.time);
}

void draw_dt(const ViewerState& state) {
  const std::vector<session::RunSample>& samples = *state.live->samples;
  double high = 0;
  Legend legend;
  for (const session::RunSample& sample : samples) {
    high = std::max(high, sample.dt);
    const std::pair<std::string, ImU32> name{sim::name(sample.limit), limit_color(sample.limit)};
    if (std::find(legend.begin(), legend.end(), name) == legend.end()) legend.push_back(name);
  }
  const scene::Scene& scene = *state.live->scene;
  const Chart chart("time step", "s", scene.frames / scene.fps, 0, high, legend);
  for (std::size_t k = 1; k < samples.size(); ++k)
    chart.segment(chart.at(samples[k - 1].time, samples[k - 1].dt),
                  chart.at(samples[k].time, samples[k].dt), limit_color(samples[k].limit));
  chart.now(state.live->snapshot.time);
}

void draw_phases(const session::LiveFrame& live) {
  const sim::PhaseSeconds& p = live.phases;
  const std::pair<const char*, double> phases[] = {{"partition", p.partition},
                                                   {"particles to grid", p.particles_to_grid},
                                                   {"grid update", p.grid_update},
                                                   {"solve", p.solve},
                                                   {"grid to particles", p.grid_to_particles},
                                                   {"checks", p.checks}};
  double all = 0;
  for (const auto& [name, seconds] : phases) all += seconds;
  if (!(all > 0) || live.steps == 0) return;
  ImGui::TextUnformatted("where the time of a step goes");
  for (const auto& [name, seconds] : phases) {
    if (seconds == 0) continue;
    const std::string text = std::string(name) + ", " + fixed_text(100 * seconds / all, 0) + " %";
    ImGui::ProgressBar(static_cast<float>(seconds / all), ImVec2(-FLT_MIN, 1.1f * em()),
                       text.c_str());
  }
}

}  // namespace

void draw_plots_panel(ViewerState& state) {
  const auto blue = IM_COL32(110, 190, 255, 255), orange = IM_COL32(255, 175, 80, 255),
             pink = IM_COL32(240, 110, 150, 255);
  draw_curves(state, "energy", "J",
              {{"kinetic", blue, [](const session::RunSample& s) { return s.kinetic_energy; }},
               {"elastic", orange, [](const session::RunSample& s) { return s.elastic_energy; }}});
  draw_curves(state, "momentum", "kg m/s",
              {{"x", pink, [](const session::RunSample& s) { return s.momentum.x(); }},
               {"y", blue, [](const session::RunSample& s) { return s.momentum.y(); }},
               {"z", orange, [](const session::RunSample& s) { return s.momentum.z(); }}});
  draw_dt(state);
  draw_curves(state, "largest speed", "m/s",
              {{"speed", blue, [](const session::RunSample& s) { return s.max_speed; }}});
  draw_curves(state, "J_P, plastic volume", "",
              {{"least", orange, [](const session::RunSample& s) { return s.min_J_P; }},
               {"greatest", blue, [](const session::RunSample& s) { return s.max_J_P; }}});
  draw_curves(state, "deepest in a collider", "m",
              {{"depth", pink, [](const session::RunSample& s) { return s.max_depth; }}});
  draw_curves(state, "largest pressure on a collider", "Pa",
              {{"pressure", blue, [](const session::RunSample& s) { return s.max_pressure; }}});
  draw_curves(state, "largest force on a collider", "N",
              {{"force", pink, [](const session::RunSample& s) { return s.max_force; }}});
  draw_phases(*state.live);
  const session::LiveFrame& live = *state.live;
  ImGui::TextDisabled("%s particles, %s, %d threads, %s",
                      std::to_string(live.snapshot.particles.x.size()).c_str(),
                      bytes_text(live.memory).c_str(), live.threads, live.simd.c_str());
  ImGui::TextDisabled("picture %.1f ms, %.0f pictures/s", state.picture_ms,
                      state.frames_per_second);
}

}  // namespace neve::app::view::panels
