#include "app/picture/turn.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace neve::app::picture {

render::PackedTurn turn_of(const sim::Mat3d& F_E) {
  sim::Mat3d R;
  R.col(0) = F_E.col(0).normalized();
  R.col(1) = (F_E.col(1) - R.col(0) * R.col(0).dot(F_E.col(1))).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  const Eigen::Quaterniond q(R);
  if (!(std::abs(q.norm() - 1) < 1e-3)) return render::no_turn;
  const auto packed = [](double x) {
    return static_cast<std::int16_t>(std::lround(32767 * std::clamp(x, -1.0, 1.0)));
  };
  return {packed(q.w()), packed(q.x()), packed(q.y()), packed(q.z())};
}

}  // namespace neve::app::picture
