#pragma once
/// The only place where simulation data becomes what the renderer draws, and double becomes float.

#include <string>
#include <vector>

#include "app/plan.h"
#include "app/scene/scene.h"
#include "render/frame.h"
#include "sim/simulation.h"

namespace neve::app {

/// State of a simulation at one frame, shared by all views of it.
struct Snapshot {
  int frame = 0;
  double time = 0;                    ///< s
  sim::ParticleArrays particles;      ///< id order
  std::vector<sim::Mat3d> kirchhoff;  ///< Pa; empty unless a view shows stress
};

/// @param with_stress computes the Kirchhoff stress too
Snapshot take_snapshot(const sim::Simulation& simulation, int frame, bool with_stress);

bool needs_stress(const Scene& scene);

class FrameBuilder {
 public:
  /// @param scene resolved: cameras and ranges are there; must outlive the builder
  /// @param spacing mean distance of particles in packed snow, m
  /// @param overrides "material.snow.hardening=5", for the caption
  /// @param coarsening what --coarsen did to the scene, for the caption; 1: nothing
  FrameBuilder(const Scene& scene, double spacing, Quality quality,
               const std::vector<std::string>& overrides, double coarsening);

  render::Frame build(const View& view, const Snapshot& snapshot) const;

  /// The same picture with rings around the particles that broke a rule.
  render::Frame build_incident(const View& view, const Snapshot& snapshot,
                               const sim::Divergence& divergence) const;

 private:
  void add_points(const View& view, const Snapshot& snapshot, render::Frame& frame) const;
  std::vector<std::string> caption(const Snapshot& snapshot) const;

  const Scene& scene_;
  double spacing_;
  Quality quality_;
  std::vector<std::string> override_lines_;
  double coarsening_;
};

/// "hardening = 5" for "material.snow.hardening=5"; the whole address where two end alike.
std::vector<std::string> override_lines(const std::vector<std::string>& overrides);

}  // namespace neve::app
