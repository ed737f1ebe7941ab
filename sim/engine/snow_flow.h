#pragma once
/// Emitters and sinks of a run: particles come and go between steps.

#include <cstdint>
#include <vector>

#include "sim/seeding/flow.h"
#include "sim/shapes/solid.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

template <class Real>
class SnowFlow {
 public:
  /// @throws std::invalid_argument for an emitter without a material, particles or a rate
  SnowFlow(const seeding::Flow& flow, const Method<Real>& method);

  /// Adds and removes the particles that come and go before the first step.
  void open(State<Real>& state);
  /// Does the same after every step.
  void run(State<Real>& state);

  std::vector<seeding::EmitterStream::State> emitter_states() const;
  void restore(const std::vector<seeding::EmitterStream::State>& states);

 private:
  struct Emitter {
    seeding::EmitterStream births;
    std::uint16_t material;
    Vec3d spin;  ///< rad/s
  };
  struct Sink {
    shapes::Solid solid;
    bool outside;
  };

  void emit(State<Real>& state);
  void remove_in_sinks(State<Real>& state) const;
  static bool may_remove(const Sink& sink, std::uint64_t block, const Lattice& lattice);

  std::vector<Emitter> emitters_;
  std::vector<Sink> sinks_;
};

}  // namespace neve::sim::engine
