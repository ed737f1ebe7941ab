#include "app/picture/cut.h"

namespace neve::app::picture {

sim::Vec3d middle_of(const std::vector<sim::Vec3d>& positions) {
  sim::Vec3d sum = sim::Vec3d::Zero();
  std::size_t count = 0;
  for (const sim::Vec3d& x : positions) {
    if (!x.allFinite()) continue;
    sum += x;
    ++count;
  }
  return count > 0 ? sim::Vec3d(sum / static_cast<double>(count)) : sum;
}

Cut::Cut(const std::optional<scene::ClipPlane>& clip, const std::vector<sim::Vec3d>& positions) {
  if (!clip) return;
  normal_ = clip->normal;
  point_ = clip->point.value_or(middle_of(positions));
}

}  // namespace neve::app::picture
