#pragma once
/// States of the drawn frames of a run, kept in DIR/states: another drawing of the same simulation,
/// with other views, sizes, colours or cameras, takes its frames from there and simulates nothing.

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "app/run/render_job.h"
#include "app/run/resumed_run.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// The parts of a scene that states depend on, as text: all of it but its views, cameras, colours
/// and light, its exports, and its length.
std::string simulation_text(const scene::Scene& scene);

/// Bytes of a particle on disk in single precision, about.
inline constexpr double state_bytes_per_particle = 160;

/// The state at the end of a frame.
struct KeptState {
  ResumedRun run;
  sim::AdvanceReport advance;   ///< since the frame before
  double seconds = 0;           ///< that its simulation took
  std::size_t grid_blocks = 0;  ///< in its last step, which a state does not hold
};

class KeptStates {
 public:
  /// @param job  must outlive this; its changes are those of the whole run
  KeptStates(const RenderJob& job, const sim::Simulation& simulation, Progress& progress);

  /// Looks for states of this simulation. Those of another one are removed.
  void begin();

  /// True where find() has something to look at.
  bool has(int frame) const { return known_.contains(frame); }

  /// True where write() has something to write, for which the simulation must not go on. The start
  /// is made again faster than it is read.
  bool needs_state(int frame) const { return is_keeping_ && frame > 0 && !has(frame); }

  /// The newest frame after `first` and not after `last` with a whole state; `first` without one.
  int skip_to(int first, int last);

  /// The state of a frame; nothing where there is none, or where it is damaged: that is said.
  std::optional<KeptState> find(int frame);

  /// Writes the state of the simulation, where states are kept and this one is not there.
  /// @throws IoError
  void write(int frame, const sim::AdvanceReport& advance,
             std::span<const picture::PlotSample> history, const record::RunRecord& record);

 private:
  const RenderJob& job_;
  const sim::Simulation& simulation_;
  Progress& progress_;
  std::string identity_;
  std::set<int> known_;
  bool is_keeping_ = false;
};

}  // namespace neve::app::run
