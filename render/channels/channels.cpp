#include "render/channels/channels.h"

#include <stdexcept>

#include "render/frame/view.h"

namespace neve::render::channels {
namespace {

void check_count(std::size_t found, std::size_t expected, const std::string& what) {
  if (found != expected)
    throw std::invalid_argument("Request: " + std::to_string(found) + " " + what + " for " +
                                std::to_string(expected) + " of the frame");
}

}  // namespace

ExrHeader camera_header(const Frame& frame) {
  const View view = make_view(frame.camera, frame.width, frame.height);
  const std::array axes{view.right, view.up, view.forward};
  // Points are rows: each axis is a column.
  const auto columns = [&](const std::array<Vec3f, 4>& of, std::array<float, 4> last) {
    std::array<float, 16> rows{};
    for (std::size_t column = 0; column < 4; ++column) {
      for (int axis = 0; axis < 3; ++axis)
        rows[static_cast<std::size_t>(4 * axis) + column] = of[column][axis];
      rows[12 + column] = last[column] - dot(view.eye, of[column]);
    }
    return rows;
  };
  ExrHeader header;
  header.to_camera = columns({axes[0], axes[1], axes[2], Vec3f{}}, {0, 0, 0, 1});
  header.screen_width = static_cast<float>(frame.width) / view.pixels_per_slope;
  const float across = view.pixels_per_slope / static_cast<float>(frame.width);
  const float down = view.pixels_per_slope / static_cast<float>(frame.height);
  header.to_ndc = columns(
      {axes[0] * across + axes[2] * 0.5f, axes[2] * 0.5f - axes[1] * down, axes[2], axes[2]},
      {0, 0, 0, 0});
  return header;
}

void check_request(const Frame& frame, const Request& request) {
  const std::size_t points = frame.points.position.size();
  const auto has = [&](Pass pass) { return request.passes.contains(pass); };
  if (has(Pass::motion)) check_count(request.velocity.size(), points, "velocities");
  if (has(Pass::body)) check_count(request.body.size(), points, "bodies");
  if (has(Pass::motion) || has(Pass::collider)) {
    check_count(request.meshes.size(), frame.meshes.size(), "meshes");
    check_count(request.grounds.size(), frame.grounds.size(), "grounds");
  }
  for (const PointNumbers& numbers : request.numbers)
    check_count(numbers.value.size(), numbers.channels.size() * points, numbers.name + " numbers");
}

void check_moment(const Frame& frame, const Frame& moment) {
  if (moment.width != frame.width || moment.height != frame.height ||
      moment.supersampling != frame.supersampling)
    throw std::invalid_argument("Request: a moment of another size than the frame");
}

}  // namespace neve::render::channels
