#include "app/picture/slice_shape.h"

#include <algorithm>
#include <cmath>

#include "app/picture/snow_volume.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

/// Samples over the spacing of particles: edges are smooth where a particle is a few pixels wide.
constexpr double samples_per_spacing = 3;
constexpr int max_samples = 1024;
/// Reach of the kernel, in spacings.
constexpr double reach = 2;

/// 1/m3: the quintic of Wendland (1995) in three dimensions, zero from `reach` spacings on.
double kernel(double distance, double spacing) {
  const double q = distance / (reach * spacing);
  if (q >= 1) return 0;
  const double rest = 1 - q;
  constexpr double pi = 3.14159265358979323846;
  return 21 / (2 * pi * std::pow(reach * spacing, 3)) * rest * rest * rest * rest * (1 + 4 * q);
}

int samples_of(double extent, double spacing) {
  return static_cast<int>(
      std::clamp(std::ceil(samples_per_spacing * extent / spacing), 1.0, double{max_samples}));
}

}  // namespace

Vec3d point_on(const SlicePlane& plane, double u, double v) {
  return u * plane.across + v * plane.up + plane.point.dot(plane.normal) * plane.normal;
}

SliceShape::SliceShape(const scene::Scene& scene, const sim::ParticleArrays& particles,
                       double spacing, const SlicePlane& plane) {
  std::vector<Near> near;
  for (std::size_t p = 0; p < particles.x.size(); ++p) {
    const Vec3d& x = particles.x[p];
    const double away = (x - plane.point).dot(plane.normal);
    if (!(std::abs(away) < reach * spacing) || !x.allFinite()) continue;
    const double volume = snow_volume(scene, particles, p);
    near.push_back(
        {x.dot(plane.across), x.dot(plane.up), away, volume > 0 ? volume : std::pow(spacing, 3)});
  }
  surround(near, scene.solver.cell_size, spacing);
  for (const Near& particle : near) add(particle, spacing);
  if (std::none_of(share_.begin(), share_.end(), [](float share) { return share >= 0.5f; }))
    columns_ = rows_ = 0;
}

void SliceShape::surround(const std::vector<Near>& near, double cell, double spacing) {
  if (near.empty()) return;
  rectangle_ = {1e300, -1e300, 1e300, -1e300};
  for (const Near& p : near) {
    rectangle_.left = std::min(rectangle_.left, p.u - cell);
    rectangle_.right = std::max(rectangle_.right, p.u + cell);
    rectangle_.bottom = std::min(rectangle_.bottom, p.v - cell);
    rectangle_.top = std::max(rectangle_.top, p.v + cell);
  }
  columns_ = samples_of(rectangle_.width(), spacing);
  rows_ = samples_of(rectangle_.height(), spacing);
  step_u_ = rectangle_.width() / columns_;
  step_v_ = rectangle_.height() / rows_;
  share_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
}

void SliceShape::add(const Near& p, double spacing) {
  const double radius = std::sqrt(std::pow(reach * spacing, 2) - p.away * p.away);
  const auto at = [](double from, double step, int count) {
    return std::clamp(static_cast<int>(std::floor(from / step)), 0, count - 1);
  };
  const int first = at(p.u - radius - rectangle_.left, step_u_, columns_),
            last = at(p.u + radius - rectangle_.left, step_u_, columns_),
            low = at(p.v - radius - rectangle_.bottom, step_v_, rows_),
            high = at(p.v + radius - rectangle_.bottom, step_v_, rows_);
  for (int row = low; row <= high; ++row)
    for (int column = first; column <= last; ++column) {
      const double du = u(column) - p.u, dv = v(row) - p.v;
      const double distance = std::sqrt(du * du + dv * dv + p.away * p.away);
      float& share = share_[index(column, row)];
      share += static_cast<float>(p.volume * kernel(distance, spacing));
      // The share is half at half of a spacing, so that its rim is smooth.
      share = std::max(share, static_cast<float>(1 - distance / spacing));
    }
}

}  // namespace neve::app::picture
