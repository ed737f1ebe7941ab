#pragma once
/// The dust of a run: air and cloud, and when they take a step. Nothing here acts on the snow.

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/dust/air.h"
#include "sim/dust/cloud.h"

namespace neve::sim::dust {

/// Numbers that later steps depend on, besides air and cloud. All of them must have 8 bytes.
struct DustProgress {
  double time = 0;          ///< s, that air and cloud have reached
  std::uint64_t steps = 0;  ///< of dust
  double fastest = 0;       ///< m/s, of snow and air in the last step
};

/// All but the snow of a step.
struct DustScene {
  const DustSettings& settings;
  double cell_size = 0;  ///< m, of the snow's grid
  Vec3d gravity{0, 0, 0};
  const Solids& solids;
  ThreadPool& pool;
};

/// Returns the longest step of air and dust, s, at a speed of snow or air, m/s.
double longest_step(const DustSettings& settings, double cell_size, double speed);

class Dust {
 public:
  /// True if a step is due at a time: no step is longer than max_step, or than what air and snow
  /// take for a cell and a half. Steps up to `end`, of a frame, are about as long as each other.
  bool is_due(double time, double end, const DustSettings& settings, double cell_size) const;
  /// A step up to a time. @param snow  all of it
  void advance(double time, std::span<const SnowGrain> snow, const DustScene& scene);

  /// Forgets the air, and is at a time: no step was due before. Totals, and with them the numbers
  /// of motes, stay.
  void start_at(double time);
  /// See Air::forget_solids.
  void forget_solids() { air_.forget_solids(); }
  double time() const { return progress_.time; }
  const Air& air() const { return air_; }
  const Cloud& cloud() const { return cloud_; }
  DustArrays arrays() const;
  /// Returns a hash of all dust in the air, in any order.
  std::uint64_t hash() const;
  std::size_t memory_bytes() const;

  std::vector<std::uint8_t> save() const;
  /// @throws SavedStateError; nothing has changed then
  void restore(std::span<const std::uint8_t> bytes);

  static constexpr double max_step = 0.05;  ///< s

 private:
  DustProgress progress_;
  Air air_;
  Cloud cloud_;
};

}  // namespace neve::sim::dust
