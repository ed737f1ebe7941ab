#include "app/picture/plots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/setup/auto_ranges.h"
#include "app/support/round_number.h"
#include "sim/rigid/rigid_bodies.h"
#include "sim/types/math.h"
#include "sim/types/time_step.h"

namespace neve::app::picture {

namespace {

render::Plot plot_of(const char* title, const char* unit, const std::optional<scene::Range>& range,
                     double now, double duration) {
  const scene::Range axis = range.value_or(scene::Range{});
  return {.title = title,
          .unit = unit,
          .x_end = static_cast<float>(duration),
          .now = static_cast<float>(now),
          .min = static_cast<float>(axis.min),
          .max = static_cast<float>(axis.max),
          .series = {}};
}

/// A bar per frame of the mean step, coloured by the limit that ruled most; only limits that did
/// are named.
render::Plot dt_plot(const scene::PlotRanges& ranges, std::span<const PlotSample> history,
                     double now, double interval, double duration) {
  const scene::Range seconds = ranges.dt.value_or(scene::Range{});
  render::Plot plot = plot_of("time step", "ms",
                              scene::Range{1000 * seconds.min, 1000 * seconds.max}, now, duration);
  for (const LimitStyle& style : limit_styles) {
    render::PlotSeries bars{.name = style.name,
                            .color = style.color,
                            .x = {},
                            .value = {},
                            .bar_width = static_cast<float>(interval)};
    for (const PlotSample& sample : history) {
      if (sample.steps == 0 || sample.limit != style.limit) continue;
      bars.x.push_back(static_cast<float>(sample.time));
      bars.value.push_back(static_cast<float>(1000 * interval / static_cast<double>(sample.steps)));
    }
    if (!bars.x.empty()) plot.series.push_back(std::move(bars));
  }
  return plot;
}

/// A rotation has many angles: these are nearest to the ones before, so that a thing that turns on
/// and on has no jump.
sim::Vec3d degrees_next_to(const sim::Vec3d& before, const sim::Mat3d& rotation) {
  const sim::Vec3d degrees = sim::degrees_from_rotation(rotation);
  const auto near = [&](sim::Vec3d angles) {
    for (int a = 0; a < 3; ++a) angles[a] -= 360 * std::round((angles[a] - before[a]) / 360);
    return angles;
  };
  // All of them are one of these two and whole turns.
  const sim::Vec3d one = near(degrees),
                   two = near({degrees.x() + 180, 180 - degrees.y(), degrees.z() + 180});
  return (two - before).norm() < (one - before).norm() ? two : one;
}

}  // namespace

std::vector<BodySample> body_samples(const std::vector<sim::shapes::Collider>& colliders,
                                     double time, const std::vector<BodySample>& before) {
  std::vector<BodySample> bodies;
  for (const sim::shapes::Collider& collider : colliders) {
    if (!collider.body.moves()) continue;
    const sim::rigid::Motion motion = sim::rigid::motion_at(collider, time);
    const auto last = std::ranges::find(before, collider.name, &BodySample::name);
    const sim::Vec3d& next_to = last == before.end() ? collider.shape.rotation : last->rotation;
    bodies.push_back({collider.name, motion.centre.y(), motion.velocity.norm(),
                      degrees_next_to(next_to, sim::shapes::pose_at(collider, time).rotation)});
  }
  return bodies;
}

PlotSample plot_sample(double time, double interval, const sim::Summary& summary,
                       const sim::AdvanceReport& advance, const std::vector<BodySample>& bodies) {
  PlotSample sample{time, summary.kinetic_energy, summary.elastic_energy, summary.max_speed,
                    0,    advance.steps,          advance.limit(),        bodies};
  for (const sim::ColliderLoad& load : advance.loads)
    sample.max_force = std::max(sample.max_force, load.impulse.norm() / interval);
  return sample;
}

std::vector<render::Plot> make_plots(const scene::PlotRanges& ranges, bool has_colliders,
                                     std::span<const PlotSample> history, double now,
                                     double interval, double duration) {
  // The margin is half an interval: times are sums of steps and not exact.
  const auto later = std::find_if(history.begin(), history.end(), [&](const PlotSample& sample) {
    return sample.time > now + 0.5 * interval;
  });
  history = history.first(static_cast<std::size_t>(later - history.begin()));

  render::Plot energy = plot_of("energy", "J", ranges.energy, now, duration);
  energy.series = {
      curve("kinetic", sky_blue, history, [](const PlotSample& s) { return s.kinetic_energy; }),
      curve("elastic", orange, history, [](const PlotSample& s) { return s.elastic_energy; }),
      curve("total", white, history,
            [](const PlotSample& s) { return s.kinetic_energy + s.elastic_energy; })};
  render::Plot speed = plot_of("largest speed", "m/s", ranges.speed, now, duration);
  speed.series = {curve("", vermillion, history, [](const PlotSample& s) { return s.max_speed; })};
  std::vector<render::Plot> plots{energy, speed};
  if (has_colliders) {
    plots.push_back(plot_of("largest force on a collider", "N", ranges.force, now, duration));
    plots.back().series = {
        curve("", pink, history, [](const PlotSample& s) { return s.max_force; })};
  }
  const auto add_bodies = [&](const char* title, const char* unit,
                              const std::optional<scene::Range>& range, auto value) {
    std::vector<render::PlotSeries> curves = body_curves(history, value);
    if (curves.empty()) return;
    plots.push_back(plot_of(title, unit, range, now, duration));
    plots.back().series = std::move(curves);
  };
  add_bodies("height of bodies", "m", ranges.body_height,
             [](const BodySample& body) { return body.height; });
  add_bodies("speed of bodies", "m/s", ranges.body_speed,
             [](const BodySample& body) { return body.speed; });
  plots.push_back(dt_plot(ranges, history, now, interval, duration));
  return plots;
}

}  // namespace neve::app::picture
