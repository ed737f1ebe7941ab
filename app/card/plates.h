#pragma once
/// A block of snow between two plates that hold it: pressed, pulled or sheared.
///
/// The block has no sides: the lattice is periodic there. So the snow between the plates is
/// strained alike, as in the formulas of its law.

#include <optional>
#include <vector>

#include "app/card/stage.h"

namespace neve::app::card {

/// The upper plate moves by so much. The last motion is slow at first, those before also at last.
struct PlateMotion {
  double seconds;
  sim::Vec3d by;  ///< m
};

/// Means over the time since the sample before.
struct PlateSample {
  sim::Vec3d moved{0, 0, 0};   ///< m, by the upper plate
  sim::Vec3d stress{0, 0, 0};  ///< Pa, of the upper half of the block on the lower one
  /// The strain of the middle half of the block, which does not feel the plates: the change of the
  /// vector between its ends, over its length at first.
  sim::Vec3d strain{0, 0, 0};
};

class Plates {
 public:
  static constexpr double cell = 0.02;  ///< m
  static constexpr int cells_wide = 4, cells_high = 10;
  static constexpr double height = cells_high * cell, side = cells_wide * cell;  ///< m
  static constexpr int samples = 160;                                            ///< of a motion

  /// @param experiment  outlives it, and learns why it ends early
  Plates(const Subject& subject, const std::vector<PlateMotion>& motions, Experiment& experiment);

  /// Goes on to the next sample. @return whether there is one
  bool next(PlateSample& sample);
  /// Keeps the present state for the picture.
  void show();
  /// True if it has diverged. Its measures are no verdict: snow bursts before the watch says so.
  bool has_diverged() const { return simulation_->divergence().has_value(); }

 private:
  void add_motions(const std::vector<PlateMotion>& motions, const sim::Vec3d& from);
  struct Reading {
    sim::Vec3d ends{0, 0, 0};      ///< m, from the lower end of the middle half to its upper one
    sim::Vec3d momentum{0, 0, 0};  ///< kg m/s, of the lower half of the block
  };
  Reading read() const;

  Experiment& experiment_;
  scene::Scene stage_;
  std::vector<double> times_;  ///< s, of samples
  std::size_t next_ = 0;
  /// Particles at the ends of the middle half, and those of the lower half.
  std::vector<std::size_t> lower_end_, upper_end_, lower_half_;
  std::optional<sim::Simulation> simulation_;
  Reading first_, last_;
};

/// s, of a motion so slow that the snow stays in balance: many times what sound takes from plate to
/// plate.
double slow_seconds(const sim::Material& material);

Experiment press(const Subject& subject);
Experiment tear(const Subject& subject);
Experiment shear(const Subject& subject);

}  // namespace neve::app::card
