#include "render/channels/channels.h"

#include <stdexcept>

namespace neve::render::channels {
namespace {

void check_count(std::size_t found, std::size_t expected, const std::string& what) {
  if (found != expected)
    throw std::invalid_argument("Request: " + std::to_string(found) + " " + what + " for " +
                                std::to_string(expected) + " of the frame");
}

}  // namespace

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
  for (const Frame& moment : request.moments)
    if (moment.width != frame.width || moment.height != frame.height ||
        moment.supersampling != frame.supersampling)
      throw std::invalid_argument("Request: a moment of another size than the frame");
}

}  // namespace neve::render::channels
