#include "app/sweep/sheet/moments.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/record/run_json.h"
#include "app/scene/read.h"
#include "app/setup/camera_path.h"
#include "app/setup/framing.h"
#include "app/support/errors.h"

namespace neve::app::sweep::sheet {

namespace {

namespace fs = std::filesystem;

/// The camera that looks at a run, or nothing where that is not known.
struct RunCamera {
  std::optional<scene::CameraSettings> settings{};
  double duration = 0;  ///< s
};

RunCamera camera_of(const fs::path& run_folder, const std::string& view) {
  try {
    const Json record = record::read_run_json(run_folder);
    const scene::Scene scene = scene::read_scene_text(record.at("scene").get<std::string>(), "");
    RunCamera camera{scene.camera, scene::duration(scene)};
    for (const scene::View& shown : scene.views)
      if (shown.name == view && shown.camera) camera.settings = shown.camera;
    // One that moves along with a body is where the body is, which is not known here.
    const bool is_placed = camera.settings && camera.settings->eye && camera.settings->target;
    if (!is_placed || !camera.settings->follow.empty()) camera.settings.reset();
    return camera;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return {};  // a picture more that is taken to have snow
  }
}

/// Returns points around the middle of the snow; what is thrown far does not count.
std::vector<sim::Vec3d> points_of(const store::SnowPlace& place) {
  constexpr double core = 0.6;
  const double across = core * place.spread, up = 0.5 * core * place.height;
  std::vector<sim::Vec3d> points{place.centre};
  for (const double side : {-1.0, 1.0})
    for (const sim::Vec3d& step :
         {sim::Vec3d(across, 0, 0), sim::Vec3d(0, up, 0), sim::Vec3d(0, 0, across)})
      points.push_back(place.centre + side * step);
  return points;
}

bool is_in_picture(const store::SnowPlace& place, const RunCamera& camera, double aspect) {
  if (place.particles == 0) return false;
  const setup::CameraPlace from = setup::camera_at(*camera.settings, place.time, camera.duration);
  const sim::Vec3d back = from.eye - from.target;
  if (back.norm() <= 0) return true;
  const setup::Lens lens{
      camera.settings->up.normalized(), std::tan(setup::radians(0.5 * from.fov)), aspect, 1, {0}};
  const setup::Extent seen =
      setup::extent_of(points_of(place), {{from.target, back.norm()}, back.normalized()}, lens);
  return seen.left < 1 && seen.right > -1 && seen.bottom < 1 && seen.top > -1;
}

}  // namespace

SnowInPictures::SnowInPictures(const fs::path& folder, const store::Manifest& manifest,
                               const std::vector<store::RunResult>& results)
    : first_(manifest.first_frame()), last_(manifest.last_frame()), without_(results.size()) {
  const double aspect = static_cast<double>(manifest.tile_width) / manifest.tile_height;
  std::set<int> with;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (results[k].places.empty()) continue;
    const RunCamera camera =
        camera_of(store::runs_folder(folder) / manifest.runs[k].folder, manifest.view);
    for (const store::SnowPlace& place : results[k].places)
      if (camera.settings && !is_in_picture(place, camera, aspect))
        without_[k].insert(place.frame);
      else
        with.insert(place.frame);
  }
  if (with.empty()) return;
  first_ = std::clamp(*with.begin(), first_, last_);
  last_ = std::clamp(*with.rbegin(), first_, last_);
}

std::vector<int> SnowInPictures::moments(std::size_t most) const {
  const std::size_t count = std::min(most, static_cast<std::size_t>(last_ - first_ + 1));
  std::vector<int> frames;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 1;
    frames.push_back(first_ + static_cast<int>(std::lround(part * (last_ - first_))));
  }
  return frames;
}

}  // namespace neve::app::sweep::sheet
