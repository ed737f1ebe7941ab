#include "app/picture/scale_bar.h"

#include <cmath>

#include "app/picture/cut.h"
#include "app/picture/to_float.h"
#include "app/support/round_number.h"
#include "app/support/text.h"

namespace neve::app::picture {

namespace {

constexpr double share_of_picture = 0.17;

std::string length_text(double metres) {
  if (metres >= 1) return rough_text(metres) + " m";
  if (metres >= 0.0095) return rough_text(100 * metres) + " cm";
  return rough_text(1000 * metres) + " mm";
}

}  // namespace

double pixels_per_metre(const render::Frame& frame, Vec3f place) {
  const render::Camera& camera = frame.camera;
  const Vec3f ahead = normalized(camera.target - camera.eye);
  const double depth = static_cast<double>(dot(place - camera.eye, ahead));
  constexpr double radians = 3.14159265358979323846 / 180;
  if (!(depth > 1e-6)) return 0;
  return 0.5 * frame.height / std::tan(0.5 * static_cast<double>(camera.fov) * radians) / depth;
}

void add_scale_bar(const scene::View& view, const Snapshot& snapshot, const SlicePlane& plane,
                   render::Frame& frame) {
  const bool is_plane = scene::shows_slice(view) && !scene::shows_particles(view);
  if (!is_plane && snapshot.particles.x.empty()) return;
  const sim::Vec3d place = is_plane ? plane.point : middle_of(snapshot.particles.x);
  const double pixels = pixels_per_metre(frame, to_float(place));
  const double length = pixels > 0 ? round_down(share_of_picture * frame.width / pixels) : 0;
  if (!(length > 0)) return;
  frame.scale_bar = {static_cast<float>(length * pixels),
                     length_text(length) + (is_plane ? "" : " at the middle of the snow")};
}

}  // namespace neve::app::picture
