#pragma once
/// A sweep as the user wrote it. Data only; describe_sweep.h has every key.

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "app/sweep/run.h"

namespace neve::app::sweep::read {

/// Method of combining the values of the axes.
enum class Method {
  grid,    ///< all combinations
  zip,     ///< the first values of all axes, the second ones, ...
  random,  ///< drawn independently
  lhs,     ///< Latin hypercube: every part of every axis is met
  sobol,   ///< evenly spread; more samples keep the first ones
  morris,  ///< trajectories that change one axis at a time, for the effect of each
  list     ///< only the explicit runs
};

/// True if runs are drawn, as many as samples say.
constexpr bool draws(Method method) {
  return method == Method::random || method == Method::lhs || method == Method::sobol ||
         method == Method::morris;
}

/// Runs of a point that tell its noise, and no more than anybody waits for.
inline constexpr int min_seeds = 2, max_seeds = 100;

enum class TileLabel { differences, name, none };

/// The snow that automatic cameras hold in their pictures.
enum class Framing {
  sheet,  ///< the snow of all runs at the moment of the sheet
  fall,   ///< the whole fall of all runs
  each    ///< its own snow at the moment of the sheet, a camera for each run
};

struct Duration {
  double seconds = 0;
};
/// The two ends of an axis, or mean and standard deviation.
struct Ends {
  double first = 0, last = 0;
};
struct WholeRange {
  std::int64_t first = 0, last = 0, step = 1;  ///< both ends included
};
/// Values as the user wrote them.
struct Values {
  scene::toml::Array items;
};

/// Specification of the values of an axis; exactly one of the first seven is set.
struct AxisRule {
  std::optional<Values> values;
  std::optional<Ends> linspace, logspace;
  std::optional<WholeRange> range;
  std::optional<Ends> uniform, log_uniform, normal;
  int num = 0;
  std::string label;
};

struct SweepSettings {
  std::string scene;  ///< relative to the sweep file
  Method method = Method::grid;
  int samples = 0;
  std::uint64_t seed = 1;  ///< of the samples
  int seeds = 0;           ///< runs of each point, each with a seed of its own; 0: one, the scene's
  std::vector<std::string> where;  ///< conditions, see condition.h
  std::string frames;
  std::string fork;  ///< time at which all runs fork; "": no fork
  bool keep_states = false;
  std::string title;
};

/// A sweep has at most so many.
constexpr int max_runs = 100'000;

struct SweepLimits {
  Duration timeout;          ///< of a run; 0: none
  std::uint64_t memory = 0;  ///< bytes, of a run; 0: only the scene's limit
  int runs = 1000;
};

struct SheetSettings {
  std::string columns, rows;  ///< address or label of an axis; "" automatic
  int wrap = 0;               ///< tiles side by side where there is one axis; 0: automatic
  std::optional<scene::PictureSize> tile;
  std::string view;
  TileLabel label = TileLabel::differences;
  Framing framing = Framing::sheet;
};

/// A sweep file before its addresses and values are looked at.
struct SweepFile {
  SweepSettings sweep;
  scene::toml::Table set, axis;
  std::vector<scene::toml::Table> links, runs;
  SweepLimits limits;
  SheetSettings sheet;
};

/// Values of one or more parameters that change together.
struct Axis {
  struct Parameter {
    std::string address;
    std::string label;  ///< "" for its name
    /// One override per value; or, where values are drawn, a single one that tells the place.
    std::vector<scene::Override> values;
    std::optional<AxisRule> drawn;  ///< uniform, log_uniform or normal
  };
  std::vector<Parameter> parameters;
  std::vector<std::string> value_labels;  ///< as many as values, or none

  /// 0 where values are drawn.
  std::size_t size() const {
    return parameters.front().drawn ? 0 : parameters.front().values.size();
  }
};

struct Sweep {
  std::string name;        ///< stem of the sweep's or scene's file
  std::string file;        ///< the sweep file; "" without one
  std::string scene_file;  ///< to be opened as it is
  SweepSettings settings;
  SweepLimits limits;
  SheetSettings sheet;
  std::vector<scene::Override> fixed;
  std::vector<Axis> axes;
  std::vector<Run> rows;                                ///< of [[run]]
  std::map<std::string, scene::toml::Location> places;  ///< of the keys in the sweep file

  /// Runs that differ in their seed alone.
  int runs_per_point() const { return std::max(1, settings.seeds); }

  /// Throws a SceneError at a key of the sweep file, or a UsageError without a file.
  [[noreturn]] void fail(const std::string& key, const std::string& message,
                         const std::string& hint) const;
};

}  // namespace neve::app::sweep::read
