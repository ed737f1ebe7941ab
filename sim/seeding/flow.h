#pragma once
/// Snow that comes and goes while a simulation runs: emitters, and solids that remove it.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/shapes/shape.h"
#include "sim/shapes/solid.h"
#include "sim/types/material.h"

namespace neve::sim::seeding {

/// Particles are born inside a shape, unstrained, each with an equal share of the snow:
/// V0 = h^3 / particles_per_cell / J_P, m = density V0.
struct Emitter {
  std::string name;      ///< unnamed emitters are called by their number from 1
  std::string material;  ///< name of a material
  shapes::Shape shape;
  Vec3d velocity{0, 0, 0};          ///< m/s
  Vec3d angular_velocity{0, 0, 0};  ///< rad/s about the shape's centre
  double particles_per_cell = 8.0;
  double J_P = 1;             ///< det F_P at birth; more than 1: loose, less dense by that factor
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
  std::uint64_t withheld = 0;                 ///< particles that found no room so far
  double emitted_mass = 0, removed_mass = 0;  ///< kg
  double max_speed = 0, max_sound_speed = 0;  ///< m/s, of emitted snow at its birth
};

/// kg/m3 of an emitter's snow at birth, without variation.
inline double density_at_birth(const Emitter& emitter, const Material& material) {
  return material.density / emitter.J_P;
}

/// kg/s that leave the shape of an emitter at the density at birth, by its velocity and spin or by
/// gravity, whichever carries more: births beyond that wait, or they would pack snow into snow.
/// Infinite where the whole shape is filled at once, 0 where nothing carries the snow away.
/// @param gravity  m/s2
/// @throws ShapeError
double natural_rate(const Emitter& emitter, const Material& material, const Vec3d& gravity);

/// True if a rate is larger than the natural one by more than rounded numbers are.
inline bool exceeds(double rate, double natural) {
  return rate > 1.01 * natural;
}

/// Returns the time from one birth of an emitter with a rate to the next, s, while none waits. The
/// k-th, from 0, is due half of it after the k-th period began.
double birth_period(const Emitter& emitter, const Material& material, double cell_size);

/// Particles that an emitter has until a time, at most 2^32.
/// @throws ShapeError
std::uint64_t count_emitted(const Emitter& emitter, const Material& material, double cell_size,
                            double time);

/// Births look for room within so many cube roots of their volume: 33 particles of packed snow.
inline constexpr double room_radius = 2;

/// A particle at the moment of its birth.
struct Birth {
  Vec3d x, v;    ///< m, m/s; where it is at the time that was asked for
  double m, V0;  ///< kg, m3
  double J_P;
  double room;  ///< m3 that particles within room_radius of it may fill, for it to be born
  double stiffness, threshold;
};

/// True if snow may be born there.
using HasRoom = std::function<bool(const Birth&)>;
inline bool has_room_everywhere(const Birth&) {
  return true;
}

/// The births of one emitter, in order. A birth waits until the natural rate lets it come, and
/// looks for room at several places; if there is none it waits, and so do those after it: the clock
/// of the emitter stops. An emitter that fills its shape once leaves out the places without room.
class EmitterStream {
 public:
  /// @throws ShapeError
  EmitterStream(const Emitter& emitter, std::size_t number, const Material& material,
                std::uint64_t seed, double cell_size);

  /// Appends the births since the last call, up to and with `time`. A particle born between two
  /// steps has moved on since.
  /// @param gravity  m/s2, now, for the natural rate; absent: births come however fast they are
  /// asked for
  void advance_to(double time, std::vector<Birth>& births,
                  const HasRoom& has_room = has_room_everywhere,
                  const std::optional<Vec3d>& gravity = std::nullopt);

  /// State needed to resume a run.
  struct State {
    std::uint64_t born = 0, candidate = 0;  ///< candidates for places, looked at so far
    std::uint64_t withheld = 0;             ///< births that an empty grid would have seen by now
    double waited = 0;  ///< s, for which its clock stood still, or will until the next birth
  };
  const State& state() const { return state_; }
  /// True if its births are the particles of one body: they are not in each other's way.
  bool fills_whole() const { return emitter_.rate == 0; }
  void restore(const State& state) { state_ = state; }

  /// True if nothing was in the way of the births of a state of this stream: each was born where
  /// and when the stream alone says, whatever the run.
  bool is_undisturbed(const State& state) const;

 private:
  double pause_after_birth(const Vec3d& gravity) const;
  void fill_whole(double age, std::vector<Birth>& births, const HasRoom& has_room);
  std::optional<Birth> next_birth(double age, const HasRoom& has_room);
  Vec3d next_candidate();
  Vec3d next_place();
  void fill_pool();
  Birth born_at(const Vec3d& local, double age) const;
  double room_around(const Vec3d& local) const;

  Emitter emitter_;
  Material material_;
  std::uint64_t key_;
  shapes::Solid solid_;
  shapes::Bounds box_;       ///< local
  double share_;             ///< m3, of the stream for each particle
  double volume_ = share_;   ///< m3, of one particle at birth
  std::vector<Vec3d> pool_;  ///< local places, of a shape that fills next to nothing of its box
  State state_;
};

}  // namespace neve::sim::seeding
