#include "app/setup/resolve.h"

#include <algorithm>
#include <cmath>

#include "app/setup/auto_camera.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/coarse_run.h"
#include "app/setup/snow_pieces.h"

namespace neve::app::setup {

namespace {

/// Nothing about it is left to be framed.
bool has_place(const scene::CameraSettings& camera) {
  if (camera.eye && camera.target) return true;
  const auto is_placed = [](const scene::CameraKeyframe& key) { return key.eye && key.target; };
  return !camera.keyframes.empty() &&
         std::all_of(camera.keyframes.begin(), camera.keyframes.end(), is_placed);
}

double aspect_of(const scene::PictureSize& size) {
  return static_cast<double>(size.width) / static_cast<double>(size.height);
}

/// Pictures of about the same shape are framed by the same camera.
bool is_of_shape(double aspect, double other) {
  return std::abs(aspect / other - 1) < 0.02;
}

/// The lens without its place: what it sees from the front does not turn or follow.
scene::CameraSettings lens_of(const scene::CameraSettings& camera) {
  scene::CameraSettings lens;
  lens.up = camera.up;
  lens.fov = camera.fov;
  return lens;
}

/// A plane alone is read from the front, wherever the scene's camera is.
bool faces_its_plane(const scene::View& view) {
  return !view.camera && scene::shows_slice(view) && !scene::shows_particles(view) &&
         !scene::has_layer(view, scene::Layer::smoke);
}

/// True if the scene's own camera is used and has no place.
bool needs_shared_camera(const scene::Scene& scene) {
  const bool is_used =
      std::any_of(scene.views.begin(), scene.views.end(),
                  [](const scene::View& view) { return !view.camera && !faces_its_plane(view); });
  return is_used && !has_place(scene.camera.value_or(scene::CameraSettings{}));
}

/// The plane goes through the middle of the bodies and emitters.
sim::Vec3d middle_of_snow(const scene::Scene& scene) {
  sim::shapes::Bounds all;
  for (const SnowPiece& piece : snow_places(scene)) all.add(sim::shapes::bounds(*piece.shape));
  return all.center();
}

void resolve_slice(const scene::Scene& scene, scene::SliceStyle& slice) {
  if (!slice.point && slice.follow.empty()) slice.point = middle_of_snow(scene);
  if (!slice.range) slice.range = automatic_range(scene, slice.field);
  if (!slice.scalar_range) slice.scalar_range = automatic_range(scene, slice.scalar);
}

}  // namespace

bool needs_framing(const scene::Scene& scene) {
  return needs_shared_camera(scene) ||
         std::any_of(scene.views.begin(), scene.views.end(), [](const scene::View& view) {
           return faces_its_plane(view) || (view.camera && !has_place(*view.camera));
         });
}

void resolve_cameras(scene::Scene& scene, const std::vector<CoarseMoment>& moments, Shown shown) {
  const bool is_shared = needs_shared_camera(scene);
  const scene::CameraSettings lens = scene.camera.value_or(scene::CameraSettings{});
  const double shared = aspect_of(scene.size);
  if (is_shared) scene.camera = automatic_camera(scene, moments, lens, shared, {}, shown);
  for (scene::View& view : scene.views) {
    const double aspect = aspect_of(size_of(scene, view));
    if (view.camera && !has_place(*view.camera))
      view.camera = automatic_camera(scene, moments, *view.camera, aspect, {}, shown);
    else if (faces_its_plane(view) || (!view.camera && is_shared && scene::shows_slice(view)))
      view.camera =
          automatic_camera(scene, moments, lens_of(lens), aspect, view.slice.normal, shown);
    else if (!view.camera && is_shared && !is_of_shape(aspect, shared))
      view.camera = automatic_camera(scene, moments, lens, aspect, {}, shown);
  }
}

void resolve_ranges(scene::Scene& scene, std::size_t particle_count) {
  for (scene::View& view : scene.views) {
    if (!view.particles.range && view.particles.color_by != scene::ColorBy::snow)
      view.particles.range = automatic_range(scene, view.particles.color_by, particle_count);
    if (scene::has_layer(view, scene::Layer::smoke) &&
        view.smoke.field != scene::ScalarField::mass && !view.smoke.range)
      view.smoke.range = automatic_range(scene, view.smoke.field);
    if (scene::shows_slice(view)) resolve_slice(scene, view.slice);
    if (scene::has_layer(view, scene::Layer::plots)) resolve_plot_ranges(scene, view.plots);
  }
}

void resolve(scene::Scene& scene, std::size_t particle_count) {
  if (needs_framing(scene)) resolve_cameras(scene, coarse_run(scene));
  resolve_ranges(scene, particle_count);
}

}  // namespace neve::app::setup
