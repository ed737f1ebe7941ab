#pragma once
/// State of a simulation at one frame, as far as its views want to see it.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/picture/node_fields.h"
#include "app/picture/plots.h"
#include "app/scene/live_change.h"
#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::picture {

/// The change of the snow by one stage of a step: a number or a vector per particle, in id order.
struct StageChange {
  std::string title, unit;  ///< "change of velocity", "m/s"
  std::vector<double> magnitude;
  std::vector<sim::Vec3d> vector;  ///< the same with direction; empty where it has none
  bool is_of_nodes = false;        ///< the stage works on the grid, which slices show

  /// The end of the scale: 0 where nothing changed.
  double largest() const;
};

/// Shared by all views of a frame.
struct Snapshot {
  int frame = 0;
  double time = 0;                      ///< s
  sim::ParticleArrays particles;        ///< id order
  std::vector<sim::Mat3d> kirchhoff;    ///< Pa; empty unless a view shows stress
  FieldSamples fields;                  ///< empty unless a view shows the grid
  std::optional<sim::DustArrays> dust;  ///< absent unless a view shows it
  sim::Warnings warnings;               ///< of the steps so far
  sim::AdvanceReport advance;           ///< steps since the frame before; the caller fills it in
  std::span<const PlotSample> history;  ///< of the frames up to this one; the caller keeps it
  /// The change by a stage of the next step that is looked at, on a copy; the caller's too.
  std::optional<StageChange> stage_change{};
  std::vector<scene::LiveChange> changes;  ///< made while it ran, for the caption; the caller's too
};

/// "step 9 broke the rule speed_cfl, and was ignored".
std::string ignored_rule_text(const sim::Warnings& warnings);

/// True if one of the views shows stress.
bool needs_stress(std::span<const scene::View> views);

/// True if one of the views shows dust.
bool needs_dust(std::span<const scene::View> views);

/// True if it has everything that the view shows: a view that was chosen since lacks what only it
/// needs.
bool has_all(const Snapshot& snapshot, const scene::View& view);

/// @param views  that will be drawn, not only those of the scene
Snapshot take_snapshot(const scene::Scene& scene, std::span<const scene::View> views,
                       const sim::Simulation& simulation, int frame);

}  // namespace neve::app::picture
