#pragma once
/// Coarse copies of a scene, run to their end.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/support/progress.h"

namespace neve::app::predict {

/// Quantities that are predicted: those that a person sees, and that copies tell.
enum class Quantity { spread, height, mean_J_P, largest_piece, force };
inline constexpr int quantity_count = 5;

struct QuantityInfo {
  const char *name, *unit, *title;
};
const QuantityInfo& info_of(Quantity quantity);

struct Copy {
  double coarsening = 1;
  std::uint64_t seed = 1;
  std::string failure;  ///< why it has no end, a sentence; empty: it has
  /// The values at the last frame; the force is the largest mean over a frame that a collider felt.
  double values[quantity_count] = {};
  std::optional<bool> has_broken;  ///< see record::has_broken
  double whole = 1;                ///< largest piece as a share of what it was at the start
  double value(Quantity quantity) const { return values[static_cast<int>(quantity)]; }
};

/// The copies that a prediction runs: one fine one, and some coarse ones that differ in their seed.
struct CopyPlan {
  double coarsening;
  int seeds;
};
inline constexpr CopyPlan copy_plans[] = {{1.5, 1}, {2, 2}};

/// Tells why copies cannot tell of a scene, known before they run; "" if they can.
std::string why_not(const scene::Scene& scene);

/// The scene of a copy. @throws UsageError where its cells are too large for a body
scene::Scene copy_of(const scene::Scene& scene, double coarsening, std::uint64_t seed);

/// @return work of the copies over that of the run, as far as it follows from cells and steps
double share_of_work();

/// "runs 3 coarse copies (1 with --coarsen 1.5, 2 with --coarsen 2), about 32 % of the work of the
/// run"
std::string cost_text();

/// Runs copies, the finest first. Those that cannot run, or diverge, say so.
/// @param last  frame, counted from 0
std::vector<Copy> run_copies(const scene::Scene& scene, int last, int threads, Progress& progress);

}  // namespace neve::app::predict
