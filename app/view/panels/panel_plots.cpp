/// Plots of the run over time: energies, momentum, dt with the limit that set it, and the times of
/// the phases of a step.

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>

#include "app/picture/plots.h"
#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/viewer_state.h"
#include "render/overlay/plots.h"

namespace neve::app::view::panels {

namespace {

using session::RunSample;

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

/// A curve for each limit, where it set dt.
std::vector<render::PlotSeries> dt_series(const std::vector<RunSample>& samples) {
  std::vector<render::PlotSeries> list;
  for (const picture::LimitStyle& style : picture::limit_styles) {
    render::PlotSeries series = picture::curve(style.name, style.color, samples,
                                               [](const RunSample& s) { return 1000 * s.dt; });
    bool is_used = false;
    const auto is_ruled = [&](const RunSample& sample) {
      return sample.limit == style.limit && std::isfinite(sample.dt);
    };
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const bool is_next = k + 1 < samples.size() && is_ruled(samples[k + 1]);
      is_used = is_used || is_ruled(samples[k]);
      if (!is_ruled(samples[k]) && !is_next) series.value[k] = nothing;
    }
    if (is_used) list.push_back(std::move(series));
  }
  return list;
}

/// The curve passes over samples that lack its value.
render::PlotSeries without_gaps(render::PlotSeries series) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < series.value.size(); ++k) {
    if (!std::isfinite(series.value[k])) continue;
    series.x[kept] = series.x[k];
    series.value[kept++] = series.value[k];
  }
  series.x.resize(kept);
  series.value.resize(kept);
  return series;
}

/// Names of curves in their colours, on the line of the title where there is room.
void draw_legend(const std::vector<render::PlotSeries>& list) {
  for (const render::PlotSeries& series : list) {
    if (series.name.empty()) continue;
    const float width = ImGui::CalcTextSize(series.name.c_str()).x + em();
    if (ImGui::GetItemRectMax().x + width < ImGui::GetWindowPos().x + ImGui::GetWindowWidth())
      ImGui::SameLine(0, em());
    const auto [r, g, b] = series.color;
    ImGui::TextColored(ImColor(r, g, b), "%s", series.name.c_str());
  }
}

void draw(const ViewerState& state, const char* title, const char* unit,
          std::vector<render::PlotSeries> list) {
  draw_over_time(state, title, *unit ? std::string(title) + " (" + unit + ")" : title,
                 std::move(list), true);
}

void draw_phases(const session::LiveFrame& live) {
  const sim::PhaseSeconds& p = live.phases;
  const std::pair<const char*, double> phases[] = {{"partition", p.partition},
                                                   {"particles to grid", p.particles_to_grid},
                                                   {"grid update", p.grid_update},
                                                   {"solve", p.solve},
                                                   {"grid to particles", p.grid_to_particles},
                                                   {"dust", p.dust},
                                                   {"checks", p.checks}};
  const double all = p.total();
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

void draw_over_time(const ViewerState& state, const char* label, const std::string& title,
                    std::vector<render::PlotSeries> list, bool has_zero) {
  render::Plot plot;
  const scene::Scene& scene = *state.live->scene;
  // Single frames and steps continue after the last frame.
  const double newest =
      std::max(state.live->snapshot.time,
               state.live->samples->empty() ? 0.0 : state.live->samples->back().time);
  plot.x_end = static_cast<float>(std::max(scene::duration(scene), newest));
  plot.now = static_cast<float>(state.live->snapshot.time);
  plot.min = has_zero ? 0 : HUGE_VALF;
  plot.max = has_zero ? 0 : -HUGE_VALF;
  for (const render::PlotSeries& series : list)
    for (const float value : series.value) {
      if (!std::isfinite(value)) continue;
      plot.min = std::min(plot.min, value);
      plot.max = std::max(plot.max, value);
    }
  ImGui::TextUnformatted(title.c_str());
  draw_legend(list);
  plot.series = std::move(list);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 5.2f * em();
  // Numbers are at the left, and the last time reaches over the right end.
  render::overlay::ImGuiCanvas canvas(*ImGui::GetFont(), *ImGui::GetWindowDrawList());
  render::overlay::draw_plot(
      plot,
      {std::round(at.x + 3.6f * em()), std::round(at.x + width - 1.4f * em()),
       std::round(at.y + 0.4f * em()), std::round(at.y + height)},
      {.has_title = false}, canvas);
  ImGui::Dummy(ImVec2(width, height + 1.6f * em()));
  note_label(label);
}

void draw_plots_panel(ViewerState& state) {
  const std::vector<RunSample>& samples = *state.live->samples;
  const auto curve = [&](const char* name, picture::Rgb color, auto value) {
    return picture::curve(name, color, samples, value);
  };
  constexpr picture::Rgb blue{110, 190, 255}, orange{255, 175, 80}, pink{240, 110, 150};
  draw(state, "energy", "J",
       {curve("kinetic", blue, [](const RunSample& s) { return s.kinetic_energy; }),
        curve("elastic", orange, [](const RunSample& s) { return s.elastic_energy; })});
  draw(state, "momentum", "kg m/s",
       {curve("x", pink, [](const RunSample& s) { return s.momentum.x(); }),
        curve("y", blue, [](const RunSample& s) { return s.momentum.y(); }),
        curve("z", orange, [](const RunSample& s) { return s.momentum.z(); })});
  draw(state, "time step", "ms", dt_series(samples));
  draw(state, "largest speed", "m/s",
       {curve("", blue, [](const RunSample& s) { return s.max_speed; })});
  draw(state, "J_P, plastic volume", "",
       {curve("least", orange, [](const RunSample& s) { return s.min_J_P; }),
        curve("greatest", blue, [](const RunSample& s) { return s.max_J_P; })});
  draw(state, "deepest in a collider", "m",
       {curve("", pink, [](const RunSample& s) { return s.max_depth; })});
  draw(state, "largest pressure on a collider", "Pa",
       {curve("", blue, [](const RunSample& s) { return s.max_pressure; })});
  draw(state, "largest force on a collider", "N",
       {without_gaps(curve("", pink, [](const RunSample& s) { return s.max_force; }))});
  if (auto heights =
          picture::body_curves(samples, [](const picture::BodySample& b) { return b.height; });
      !heights.empty()) {
    draw(state, "height of bodies", "m", std::move(heights));
    draw(state, "speed of bodies", "m/s",
         picture::body_curves(samples, [](const picture::BodySample& b) { return b.speed; }));
  }
  draw_phases(*state.live);
  const session::LiveFrame& live = *state.live;
  ImGui::TextDisabled("%s particles, %s, %d threads, %s",
                      std::to_string(live.snapshot.particles.x.size()).c_str(),
                      bytes_text(live.memory).c_str(), live.threads, live.simd.c_str());
  ImGui::TextDisabled("picture %.1f ms, %.0f pictures/s", state.picture_ms,
                      state.frames_per_second);
}

}  // namespace neve::app::view::panels
