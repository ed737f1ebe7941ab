#include "app/setup/resolve.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/setup/auto_camera.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/camera_path.h"
#include "app/setup/coarse_run.h"
#include "app/setup/snow_pieces.h"

namespace neve::app::setup {

namespace {

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

/// A camera whose place neve found, before that. Keyframes that have places are those of push_in,
/// which ends where the camera has been told to follow something since.
scene::CameraSettings without_place(scene::CameraSettings camera) {
  camera.eye.reset();
  camera.target.reset();
  if (has_place(camera)) {
    camera.keyframes.clear();
    camera.push_in = camera.follow.empty();
  }
  camera.found = scene::FoundCamera::nothing;
  return camera;
}

/// True for a view that the scene's camera, which neve found, was not found for.
bool needs_own_camera(const scene::Scene& scene, const scene::View& view) {
  return !view.camera && scene.camera && scene.camera->found != scene::FoundCamera::nothing &&
         (scene::shows_slice(view) ||
          !is_of_shape(aspect_of(size_of(scene, view)), aspect_of(scene.size)));
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

/// True if a change is of this address, or of what is in it.
bool is_in(const scene::Override& change, const std::string& address) {
  return change.address == address || change.address.starts_with(address + ".");
}

/// Leaves open again what changes of a camera make void of what was found.
void reopen(scene::CameraSettings& camera, const std::string& address,
            const std::vector<scene::Override>& changes) {
  if (camera.found == scene::FoundCamera::nothing) return;
  bool is_changed = false;
  for (const scene::Override& change : changes) {
    if (!is_in(change, address)) continue;
    is_changed = true;
    for (const char* key : {".eye", ".target", ".keyframes"})
      if (is_in(change, address + key)) camera.found = scene::FoundCamera::nothing;
  }
  if (is_changed && camera.found != scene::FoundCamera::nothing) camera = without_place(camera);
}

/// Leaves a camera of a view open again that neve found.
void reopen(scene::View& view) {
  if (!view.camera) return;
  if (view.camera->found == scene::FoundCamera::camera)
    view.camera.reset();
  else if (view.camera->found == scene::FoundCamera::place)
    view.camera = without_place(*view.camera);
}

/// The same of the camera of all views.
void reopen_shared(scene::Scene& scene) {
  if (scene.camera && scene.camera->found != scene::FoundCamera::nothing)
    scene.camera = without_place(*scene.camera);
}

/// A range is of its quantity, and a point of what it follows.
void reopen_values(scene::View& view, const auto& is_set) {
  if (is_set("particles.color_by") && !is_set("particles.range")) view.particles.range.reset();
  if (is_set("smoke.field") && !is_set("smoke.range")) view.smoke.range.reset();
  if (is_set("slice.field") && !is_set("slice.range")) view.slice.range.reset();
  if (is_set("slice.scalar") && !is_set("slice.scalar_range")) view.slice.scalar_range.reset();
  if (is_set("slice.follow") && !is_set("slice.point")) view.slice.point.reset();
}

}  // namespace

bool needs_framing(const scene::Scene& scene) {
  return needs_shared_camera(scene) ||
         std::any_of(scene.views.begin(), scene.views.end(), [&](const scene::View& view) {
           return faces_its_plane(view) || needs_own_camera(scene, view) ||
                  (view.camera && !has_place(*view.camera));
         });
}

void resolve_cameras(scene::Scene& scene, const std::vector<CoarseMoment>& moments, Shown shown) {
  scene::CameraSettings lens = scene.camera.value_or(scene::CameraSettings{});
  if (lens.found != scene::FoundCamera::nothing) lens = without_place(lens);
  const double shared = aspect_of(scene.size);
  if (needs_shared_camera(scene))
    scene.camera = automatic_camera(scene, moments, lens, shared, {}, shown);
  for (scene::View& view : scene.views) {
    const double aspect = aspect_of(size_of(scene, view));
    if (view.camera) {
      if (!has_place(*view.camera))
        view.camera = automatic_camera(scene, moments, *view.camera, aspect, {}, shown);
      continue;
    }
    if (faces_its_plane(view) || (needs_own_camera(scene, view) && scene::shows_slice(view)))
      view.camera =
          automatic_camera(scene, moments, lens_of(lens), aspect, view.slice.normal, shown);
    else if (needs_own_camera(scene, view))
      view.camera = automatic_camera(scene, moments, lens, aspect, {}, shown);
    if (view.camera) view.camera->found = scene::FoundCamera::camera;
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

void reopen(scene::Scene& scene, const std::vector<scene::Override>& changes) {
  const auto any = [&](const std::string& address) {
    return std::any_of(changes.begin(), changes.end(),
                       [&](const scene::Override& change) { return is_in(change, address); });
  };
  if (scene.camera) {
    reopen(*scene.camera, "camera", changes);
    if (any("output.size")) reopen_shared(scene);
  }
  for (scene::View& view : scene.views) {
    const std::string address = "view." + view.name + ".";
    const auto is_set = [&](const std::string& key) { return any(address + key); };
    reopen_values(view, is_set);
    if (!view.camera) continue;
    reopen(*view.camera, address + "camera", changes);
    const bool is_turned = is_set("size") || is_set("slice") || any("output.size");
    if (is_turned || (view.camera->found == scene::FoundCamera::camera && any("camera")))
      reopen(view);
  }
}

void reopen_cameras(scene::Scene& scene) {
  reopen_shared(scene);
  for (scene::View& view : scene.views) reopen(view);
}

void set_size(const scene::PictureSize& size, scene::Scene& scene) {
  const double aspect = aspect_of(size);
  if (!is_of_shape(aspect, aspect_of(scene.size))) reopen_shared(scene);
  for (scene::View& view : scene.views) {
    if (!is_of_shape(aspect, aspect_of(size_of(scene, view)))) reopen(view);
    view.size.reset();
  }
  for (scene::Mosaic& mosaic : scene.mosaics) mosaic.width.reset();
  scene.size = size;
}

void resolve_cameras(scene::Scene& scene) {
  if (needs_framing(scene)) resolve_cameras(scene, coarse_run(scene));
}

void resolve(scene::Scene& scene, std::size_t particle_count) {
  resolve_cameras(scene);
  resolve_ranges(scene, particle_count);
}

}  // namespace neve::app::setup
