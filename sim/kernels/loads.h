#pragma once
/// Impulses of colliders on snow. Blocks add up their own in a fixed order; the sums of blocks are
/// whole numbers, so that threads may add them in any order.

#include <cstdint>

#include "sim/kernels/contact.h"

namespace neve::sim::kernels {

/// Sums of a collider in a step, in units of SweepArgs::load_unit.
struct LoadSum {
  std::int64_t impulse[3];  ///< on the snow, N s
  std::int64_t moment[3];   ///< about the collider's point, N m s
};

/// Adds up the impulses of one block. It has an instruction set, so that no two files of kernels
/// share it.
template <class Set>
class BlockLoads {
 public:
  NEVE_INLINE explicit BlockLoads(int colliders) : count_(colliders) {
    for (int k = 0; k < colliders; ++k)
      for (int a = 0; a < 6; ++a) sum_[k][a] = 0;
  }

  /// @param arm  from the collider's point, m
  NEVE_INLINE void add(int collider, const double* impulse, const double* arm) {
    double* s = sum_[collider];
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      s[a] += impulse[a];
      s[3 + a] += arm[b] * impulse[c] - arm[c] * impulse[b];
    }
    is_empty_ = false;
  }

  /// The lanes of a mask. @param r  from the block's first node, m
  template <class V, class Real>
  NEVE_NOINLINE void add(const LocalCollider<Real>& collider, const Vec3<V>& impulse,
                         const Vec3<V>& r, unsigned lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int l = __builtin_ctz(lanes);
      double j[3], arm[3];
      for (int a = 0; a < 3; ++a) {
        j[a] = static_cast<double>(impulse[a][l]);
        arm[a] = static_cast<double>(collider.to_block[a]) + static_cast<double>(r[a][l]);
      }
      add(collider.index, j, arm);
    }
  }

  NEVE_INLINE void give(LoadSum* sums, double unit) const {
    if (is_empty_) return;
    for (int k = 0; k < count_; ++k)
      for (int a = 0; a < 3; ++a) {
        add_whole(&sums[k].impulse[a], sum_[k][a] / unit);
        add_whole(&sums[k].moment[a], sum_[k][3 + a] / unit);
      }
  }

 private:
  NEVE_INLINE static void add_whole(std::int64_t* to, double x) {
    // A run that is about to end as not finite must not end here.
    constexpr double most = 4e18;
    if (!(x > -most && x < most)) return;
    const auto whole = static_cast<std::int64_t>(x < 0 ? x - 0.5 : x + 0.5);
    if (whole != 0) __atomic_fetch_add(to, whole, __ATOMIC_RELAXED);
  }

  double sum_[max_colliders][6];
  int count_;
  bool is_empty_ = true;
};

}  // namespace neve::sim::kernels
