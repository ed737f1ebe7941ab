#include "app/resolve.h"

#include <algorithm>
#include <cmath>

#include "app/auto_camera.h"
#include "app/auto_ranges.h"
#include "app/dry_run.h"
#include "app/plots.h"
#include "app/snow_pieces.h"

namespace neve::app {

namespace {

/// Nothing about it is left to be framed.
bool has_place(const CameraSettings& camera) {
  if (camera.eye && camera.target) return true;
  const auto is_placed = [](const CameraKeyframe& key) { return key.eye && key.target; };
  return !camera.keyframes.empty() &&
         std::all_of(camera.keyframes.begin(), camera.keyframes.end(), is_placed);
}

double aspect_of(const PictureSize& size) {
  return static_cast<double>(size.width) / static_cast<double>(size.height);
}

bool shows_slice(const View& view) {
  return has_layer(view, Layer::arrows) || has_layer(view, Layer::heatmap);
}

/// Pictures of about the same shape are framed by the same camera.
bool is_of_shape(double aspect, double other) {
  return std::abs(aspect / other - 1) < 0.02;
}

/// Whether the scene's own camera is used and has no place.
bool needs_shared_camera(const Scene& scene) {
  const bool is_used = std::any_of(scene.views.begin(), scene.views.end(),
                                   [](const View& view) { return !view.camera; });
  return is_used && !has_place(scene.camera.value_or(CameraSettings{}));
}

/// The plane goes through the middle of what the snow comes from.
sim::Vec3d middle_of_snow(const Scene& scene) {
  const std::vector<SnowPiece> pieces = snow_places(scene);
  sim::Bounds all = sim::bounds(*pieces.front().shape);
  for (const SnowPiece& piece : pieces) {
    const sim::Bounds box = sim::bounds(*piece.shape);
    all.min = all.min.cwiseMin(box.min);
    all.max = all.max.cwiseMax(box.max);
  }
  return 0.5 * (all.min + all.max);
}

void resolve_slice(const Scene& scene, SliceStyle& slice) {
  if (!slice.point && slice.follow.empty()) slice.point = middle_of_snow(scene);
  if (!slice.range) slice.range = automatic_range(scene, slice.field);
  if (!slice.scalar_range) slice.scalar_range = automatic_range(scene, slice.scalar);
}

}  // namespace

bool needs_framing(const Scene& scene) {
  return needs_shared_camera(scene) ||
         std::any_of(scene.views.begin(), scene.views.end(),
                     [](const View& view) { return view.camera && !has_place(*view.camera); });
}

void resolve_cameras(Scene& scene, const std::vector<Moment>& moments) {
  const bool is_shared = needs_shared_camera(scene);
  const CameraSettings lens = scene.camera.value_or(CameraSettings{});
  const double shared = aspect_of(scene.size);
  if (is_shared) scene.camera = automatic_camera(scene, moments, lens, shared);
  for (View& view : scene.views) {
    const double aspect = aspect_of(size_of(scene, view));
    if (view.camera && !has_place(*view.camera))
      view.camera = automatic_camera(scene, moments, *view.camera, aspect);
    else if (!view.camera && is_shared && shows_slice(view))
      view.camera = automatic_camera(scene, moments, lens, aspect, view.slice.normal);
    else if (!view.camera && is_shared && !is_of_shape(aspect, shared))
      view.camera = automatic_camera(scene, moments, lens, aspect);
  }
}

void resolve_ranges(Scene& scene, std::size_t particle_count) {
  for (View& view : scene.views) {
    if (!view.particles.range && view.particles.color_by != ColorBy::snow)
      view.particles.range = automatic_range(scene, view.particles.color_by, particle_count);
    if (has_layer(view, Layer::smoke) && view.smoke.field != ScalarField::mass && !view.smoke.range)
      view.smoke.range = automatic_range(scene, view.smoke.field);
    if (shows_slice(view)) resolve_slice(scene, view.slice);
    if (has_layer(view, Layer::plots)) resolve_plot_ranges(scene, view.plots);
  }
}

void resolve(Scene& scene, std::size_t particle_count) {
  if (needs_framing(scene)) resolve_cameras(scene, dry_run(scene));
  resolve_ranges(scene, particle_count);
}

}  // namespace neve::app
