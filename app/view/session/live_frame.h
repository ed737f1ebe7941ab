#pragma once
/// State of a simulation at one moment, for display: immutable, shared between threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/dump/dump_options.h"
#include "app/dump/histogram.h"
#include "app/dump/quantities.h"
#include "app/health/diagnosis.h"
#include "app/picture/snapshot.h"
#include "app/setup/seed_scene.h"
#include "sim/types/stage.h"

namespace neve::app::view::session {

/// One moment of a run, for plots that are finer than frames.
struct RunSample {
  double time = 0;                                ///< s
  double kinetic_energy = 0, elastic_energy = 0;  ///< J
  sim::Vec3d momentum{0, 0, 0};                   ///< kg m/s
  double max_speed = 0;                           ///< m/s
  double min_J_P = 1, max_J_P = 1;
  double dt = 0;  ///< s, that the settings choose next; of a run that was opened, the longest of
                  ///< the frame; not a number: it has no steps
  sim::DtLimit limit = sim::DtLimit::max_dt;  ///< that rules it
  double max_depth = 0;                       ///< m, of the particle deepest in a collider
  double max_pressure = 0;                    ///< Pa, of snow on a collider
  double max_force = 0;  ///< N, of snow on a collider, the mean since the frame began; not a
                         ///< number: the steps of the frame are being taken
  std::vector<picture::BodySample> bodies{};
};

/// A quantity of many nodes or particles in a few numbers.
struct QuantitySummary {
  std::string name, unit;
  dump::Extremes magnitudes;
  std::optional<scene::Range> expected;
  std::string why;
};

/// A step that is looked at stage by stage, on a copy.
struct StageSummary {
  sim::Stage stage = sim::Stage::rasterize;  ///< the last that was done
  double dt = 0;                             ///< s, of the step
  bool is_of_nodes = false;
  std::size_t rows = 0, negligible = 0;
  std::vector<QuantitySummary> quantities;
  std::array<double, sim::stage_names.size()> seconds{};  ///< of every stage of the step
};

struct ProbeRow {
  std::string name, unit;
  std::vector<double> values;  ///< 1, 3 or 9
  double magnitude = 0;
  std::optional<scene::Range> expected;
  std::string why;
  bool is_outside_expected = false;
};

struct ProbeReading {
  dump::Probe target;
  sim::Vec3d place{0, 0, 0};  ///< m
  bool is_node = false;
  std::string after;  ///< the stage that was done last, or ""
  double time = 0;    ///< s, when it was made: a run is probed less often than it is shown
  std::vector<ProbeRow> rows;
};

/// A quantity of all nodes or of all particles.
struct FieldName {
  bool is_of_nodes = false;
  std::string name;
  bool operator==(const FieldName&) const = default;
};

struct HistogramReading {
  FieldName field;
  std::optional<dump::Histogram> histogram;  ///< absent: there is no such field at this moment
  std::string after;                         ///< the stage that was done last, or ""
  std::vector<FieldName> fields;             ///< those of this moment
};

struct LiveFrame {
  std::uint64_t number = 0;        ///< number of published frames
  std::uint64_t start = 0;         ///< that its run began with; 0: the first one
  std::uint64_t newest_start = 0;  ///< that was tried, `start` too if it succeeded
  std::uint64_t returns = 0;       ///< times that a run left later moments behind
  double returned_to = 0;          ///< s, the earliest of those that readers may not know
  std::shared_ptr<const scene::Scene> scene;  ///< that is simulated, colliders where they are
  picture::Snapshot snapshot;
  std::vector<picture::PlotSample> history;  ///< one per frame; snapshot.history shows these
  std::shared_ptr<const std::vector<RunSample>> samples;
  /// The snow that the run started from.
  std::shared_ptr<const setup::SeededScene> seeded = std::make_shared<setup::SeededScene>();

  int frame = 0;  ///< the last one that was passed
  bool is_frame_end = true;
  std::size_t steps = 0;  ///< since the start
  bool is_running = false;
  bool is_older = false;          ///< not where the run is: a kept frame
  int head = 0;                   ///< frame where the run is, the last one that it passed
  bool is_head_frame_end = true;  ///< the run is at the end of that frame
  bool is_head_broken = false;    ///< the run broke a rule there
  std::vector<int> kept;
  std::uint64_t kept_bytes = 0, kept_budget = 0;

  std::uint64_t state_hash = 0;  ///< at the end of a frame
  sim::PhaseSeconds phases;      ///< of the steps since the start
  double speed = 0;              ///< simulated over wall seconds while it ran last
  std::uint64_t memory = 0;      ///< bytes of the simulation
  int threads = 1;
  std::string simd;

  std::optional<sim::Divergence> divergence;
  std::optional<health::Diagnosis> diagnosis;
  std::optional<StageSummary> stage;
  std::optional<ProbeReading> probe;
  std::optional<dump::Probe> probed;  ///< requested target
  std::optional<HistogramReading> histogram;
  std::string error;         ///< why something that was asked for was not done, the last one
  std::uint64_t errors = 0;  ///< how many there were, to tell a new one from the same
};

/// The run that kept moments are of.
struct KeptRun {
  std::uint64_t start = 0, returns = 0;  ///< of its LiveFrame

  /// Erases the moments that the run of a frame does not have, because it began again or left them.
  /// @param time_of  a moment, s @return the number of those erased
  template <class Moments, class TimeOf>
  std::size_t follow(const LiveFrame& live, Moments& moments, const TimeOf& time_of) {
    constexpr double rounding = 1e-9;  // s
    if (start == live.start && returns == live.returns) return 0;
    const bool is_same_start = start == live.start;
    start = live.start;
    returns = live.returns;
    return std::erase_if(moments, [&](const auto& moment) {
      return !is_same_start || time_of(moment) > live.returned_to + rounding;
    });
  }
};

}  // namespace neve::app::view::session
