#pragma once
/// Diagnostics over time as plots: energies, largest speed, largest force on a collider, height
/// and speed of bodies, time step and its limit.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "render/frame/frame.h"
#include "sim/simulation.h"

namespace neve::app::picture {

using Rgb = std::array<std::uint8_t, 3>;  ///< sRGB

// Colours that stay apart for all kinds of colour vision (Okabe and Ito).
inline constexpr Rgb sky_blue{86, 180, 233}, orange{230, 159, 0}, white{240, 244, 250},
    green{0, 158, 115}, yellow{240, 228, 66}, purple{204, 121, 167}, vermillion{213, 94, 0},
    pink{240, 110, 150};

/// Name and colour of what limits dt.
struct LimitStyle {
  sim::DtLimit limit;
  const char* name;
  Rgb color;
};
inline constexpr LimitStyle limit_styles[] = {
    {sim::DtLimit::max_dt, "max_dt", white},         {sim::DtLimit::cfl, "cfl", sky_blue},
    {sim::DtLimit::acoustic, "acoustic", orange},    {sim::DtLimit::strain, "strain", purple},
    {sim::DtLimit::fixed, "fixed", yellow},          {sim::DtLimit::frame_end, "frame end", green},
    {sim::DtLimit::collider, "collider", vermillion}};
static_assert(std::size(limit_styles) == sim::dt_limit_count);

/// @param samples  each with a time, s
render::PlotSeries curve(const char* name, Rgb color, const auto& samples, auto value) {
  render::PlotSeries series{.name = name, .color = color, .x = {}, .value = {}};
  for (const auto& sample : samples) {
    series.x.push_back(static_cast<float>(sample.time));
    series.value.push_back(static_cast<float>(value(sample)));
  }
  return series;
}

/// A body that moves by itself at one moment, its centre of mass.
struct BodySample {
  std::string name;
  double height = 0;             ///< m, along y
  double speed = 0;              ///< m/s
  sim::Vec3d rotation{0, 0, 0};  ///< degrees, of its shape: without jumps of whole turns
};
/// @param colliders  as they are at that time
/// @param before     of the frame before; none: rotations are next to those that are written
std::vector<BodySample> body_samples(const std::vector<sim::shapes::Collider>& colliders,
                                     double time, const std::vector<BodySample>& before = {});

/// Data of one frame for the plots.
struct PlotSample {
  double time = 0;                                ///< s
  double kinetic_energy = 0, elastic_energy = 0;  ///< J
  double max_speed = 0;                           ///< m/s
  double max_force = 0;                       ///< N, on a collider: the mean since the frame before
  std::size_t steps = 0;                      ///< since the frame before
  sim::DtLimit limit = sim::DtLimit::max_dt;  ///< the one that ruled most of them
  std::vector<BodySample> bodies{};
};

/// @param interval s, that the advance took
PlotSample plot_sample(double time, double interval, const sim::Summary& summary,
                       const sim::AdvanceReport& advance,
                       const std::vector<BodySample>& bodies = {});

/// A curve for each body that there is at any of the samples, with its name where there are
/// several; of many bodies the first ones.
/// @param samples  each with a time, s, and bodies
/// @param value    of a BodySample
std::vector<render::PlotSeries> body_curves(const auto& samples, auto value);

/// @param history one sample per frame, in order; those later than `now` are left out
/// Without colliders there is no plot of forces, without bodies none of their heights and speeds.
/// @param interval s, between frames
/// @param duration s, of the whole scene
std::vector<render::Plot> make_plots(const scene::PlotRanges& ranges, bool has_colliders,
                                     std::span<const PlotSample> history, double now,
                                     double interval, double duration);

inline constexpr Rgb body_colors[] = {sky_blue, orange, green,      pink,
                                      yellow,   purple, vermillion, white};

std::vector<render::PlotSeries> body_curves(const auto& samples, auto value) {
  std::vector<std::string> names;
  for (const auto& sample : samples)
    for (const BodySample& body : sample.bodies)
      if (names.size() < std::size(body_colors) &&
          std::find(names.begin(), names.end(), body.name) == names.end())
        names.push_back(body.name);
  std::vector<render::PlotSeries> list;
  for (const std::string& name : names) {
    const auto of_body = [&](const auto& sample) {
      for (const BodySample& body : sample.bodies)
        if (body.name == name) return value(body);
      return std::numeric_limits<double>::quiet_NaN();
    };
    list.push_back(
        curve(names.size() > 1 ? name.c_str() : "", body_colors[list.size()], samples, of_body));
  }
  return list;
}

}  // namespace neve::app::picture
