#pragma once
/// Snow that comes and goes while a simulation runs: emitters, and solids that remove it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/shapes/shape.h"
#include "sim/shapes/solid.h"
#include "sim/types/material.h"

namespace neve::sim::seeding {

/// Particles are born inside a shape, unstrained, each with an equal share of the snow:
/// V0 = h^3 / particles_per_cell, m = density V0.
struct Emitter {
  std::string name;      ///< unnamed emitters are called by their number from 1
  std::string material;  ///< name of a material
  shapes::Shape shape;
  Vec3d velocity{0, 0, 0};          ///< m/s
  Vec3d angular_velocity{0, 0, 0};  ///< rad/s about the shape's centre
  double particles_per_cell = 8.0;
  double rate = 0;            ///< kg/s; 0: the whole shape once, at `start`
  double start = 0;           ///< s
  std::optional<double> end;  ///< s; absent: stays open. Ignored at rate 0
};

/// Particles inside are removed.
struct Sink {
  std::string name;  ///< unnamed ones are called by their number from 1
  shapes::Shape shape;
  bool outside = false;  ///< those outside are removed instead
};

/// All that comes and goes. Places of births are keyed by seed, emitter and number, and times by
/// number alone: the same snow for any steps.
struct Flow {
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  std::uint64_t seed = 1;
};

/// Emitted and removed particles since the start.
struct FlowTotals {
  std::uint64_t emitted = 0, removed = 0;     ///< particles
  double emitted_mass = 0, removed_mass = 0;  ///< kg
};

/// kg/s that leave the shape of an emitter at packed density, by its velocity: more packs snow into
/// snow. Infinite where the whole shape is filled at once, 0 where nothing carries the snow away.
/// @throws ShapeError
double carried_rate(const Emitter& emitter, const Material& material);

/// Particles that an emitter has until a time, at most 2^32.
/// @throws ShapeError
std::uint64_t count_emitted(const Emitter& emitter, const Material& material, double cell_size,
                            double time);

/// A particle at the moment of its birth.
struct Birth {
  Vec3d x, v;    ///< m, m/s; where it is at the time that was asked for
  double m, V0;  ///< kg, m3
  double stiffness, threshold;
};

/// The births of one emitter, in order.
class EmitterStream {
 public:
  /// @throws ShapeError
  EmitterStream(const Emitter& emitter, std::size_t number, const Material& material,
                std::uint64_t seed, double cell_size);

  /// Appends the births since the last call, up to and with `time`. A particle born between two
  /// steps has moved on since.
  void advance_to(double time, std::vector<Birth>& births);

  /// State needed to resume a run.
  struct State {
    std::uint64_t born = 0, candidate = 0;  ///< candidates for places, looked at so far
  };
  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  void fill_whole(double age, std::vector<Birth>& births);
  Vec3d next_candidate();
  Vec3d next_place();
  void fill_pool();
  Birth born_at(const Vec3d& local, double age) const;

  Emitter emitter_;
  Material material_;
  std::uint64_t key_;
  shapes::Solid solid_;
  shapes::Bounds box_;       ///< local
  double V0_;                ///< m3
  std::vector<Vec3d> pool_;  ///< local places, of a shape that fills next to nothing of its box
  State state_;
};

}  // namespace neve::sim::seeding
