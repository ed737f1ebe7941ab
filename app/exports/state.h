#pragma once
/// The state of a simulation at one moment, as far as exports want to see it.

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/exports/origins.h"
#include "app/scene/scene.h"
#include "sim/simulation.h"
#include "sim/types/grid_fields.h"

namespace neve::app::exports {

/// Pose of a collider, and the time of its shape (see sim::shapes::shape_time).
struct PlacedShape {
  std::string collider;
  sim::shapes::Pose pose;
  double time = 0;        ///< s
  std::size_t shape = 0;  ///< which of those that it has had in the run; 0: the one of the scene
};
std::vector<PlacedShape> placed_at(const std::vector<scene::Collider>& colliders, double time);

/// Read while the simulation stands still, used while it continues.
struct State {
  double time = 0;  ///< s
  std::uint64_t hash = 0;
  sim::ParticleArrays particles;      ///< id order
  std::vector<sim::Mat3d> kirchhoff;  ///< Pa; empty unless an export has stress
  /// Nodes by the bodies that exports with the grid name: none for all snow.
  std::map<std::vector<std::string>, sim::RasterizedNodes> nodes;
  /// Emitters that have waited for room. Their clock stands still while snow is in their way:
  /// births are late from then on, each by what it had waited.
  std::vector<std::string> waiting;
  sim::DustArrays dust;                ///< empty unless an export has it
  std::vector<PlacedShape> colliders;  ///< of that moment
};

/// The dust as if it were the snow of a state: `particles`, and `nodes` where there are any.
std::shared_ptr<const State> state_of_dust(const State& state);

/// Why some ages of an export are not-a-number; "" where none is.
std::string unknown_ages(const scene::Export& e, const State& state);

/// True for formats that have the grid instead of particles.
bool has_grid(const scene::Export& e);

/// @param colliders  where their drawn places come from: the scene's, followed to this moment
std::shared_ptr<const State> read_state(std::span<const scene::Export> exports,
                                        const Origins& origins,
                                        const std::vector<scene::Collider>& colliders,
                                        const sim::Simulation& simulation);

}  // namespace neve::app::exports
