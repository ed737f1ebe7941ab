#pragma once
/// Numbers of two runs over time: as a table, as JSON and as curves.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/compare/measures.h"
#include "app/record/run_json.h"
#include "app/support/json.h"
#include "render/renderer.h"

namespace neve::app::compare {

/// Both runs at one frame.
struct PairMoment {
  int frame = 0;                               ///< its number in A
  double time = 0;                             ///< s
  std::array<std::vector<double>, 2> metrics;  ///< of A and B, in the order of metric names; empty
                                               ///< where run.json does not list the frame
  std::optional<Displacement> displacement;    ///< absent unless particles were compared
  std::optional<std::array<double, 2>> mass;   ///< kg, more in A and more in B
};

/// The metrics of a frame, counted from 0, as run.json lists them.
PairMoment moment_of(int frame, const scene::Scene& scene_a,
                     const std::vector<record::FrameRecord>& a,
                     const std::vector<record::FrameRecord>& b);

/// A row a frame: "frame,time,spread_a,spread_b,...".
std::string series_csv(const std::vector<PairMoment>& moments);

/// A list of objects with the same names.
Json series_json(const std::vector<PairMoment>& moments);

/// Panels with a curve of A and one of B.
render::Image draw_series(const std::vector<PairMoment>& moments, const std::string& title_a,
                          const std::string& title_b, render::Renderer& renderer);

}  // namespace neve::app::compare
