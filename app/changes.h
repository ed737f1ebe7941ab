#pragma once
/// What was changed while a simulation ran: kept with its pictures, made again by `neve render`.
///
/// A change belongs to the step after which it was made. Everything that happens to a run in these
/// terms is a function of the scene it started from and the list of its changes, which is why the
/// list alone makes the run again, bit for bit.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/json.h"
#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "sim/retry.h"
#include "sim/simulation.h"

namespace neve::app {

struct LiveChange {
  std::size_t step = 0;  ///< steps that had been taken
  std::string address;
  std::string value;  ///< as --set takes it: TOML, a word, or "none"

  bool operator==(const LiveChange&) const = default;
};

Json to_json(const std::vector<LiveChange>& changes);
/// @throws std::runtime_error that says what is wrong with the list: no list of step, address and
///         value, steps that go back, or addresses that cannot change while a simulation runs
std::vector<LiveChange> live_changes(const Json& json);

/// "step 120: material.snow.hardening = 5"
std::string text_of(const LiveChange& change);

/// Adds a change that was made now. Of many at one step to one address, as a slider makes them
/// while a run is paused, the first and the last are kept: what comes in between leaves no trace in
/// the state. (Both, since a value that came back leaves one: last bits of the stress.)
void note_change(std::vector<LiveChange>& changes, LiveChange change);

/// Forgets the changes made after a step: a run that goes on from an earlier state.
void forget_changes_after(std::vector<LiveChange>& changes, std::size_t step);

/// A scene before its changes.
struct SceneSource {
  std::string text;      ///< TOML
  std::string name;      ///< of the file, in messages
  std::string base_dir;  ///< see read_scene_text
  std::vector<Override> overrides;
};

/// The scene as it is after the changes made at steps up to this one, read the one way that scenes
/// are read. What scenes leave to the program ("auto") is not filled in.
/// @throws SceneError for the text, UsageError for overrides and changes
Scene with_changes(const SceneSource& source, const std::vector<LiveChange>& changes,
                   std::size_t up_to_step = static_cast<std::size_t>(-1));

/// The changes that concern what a scene has: those of views and mosaics that it lacks, since
/// pictures are made again one view at a time, are left out.
std::vector<LiveChange> changes_of(const Scene& scene, std::vector<LiveChange> changes);

/// The scene to keep with a picture: what the simulation started from, drawn as it is drawn now.
/// Changes of views, cameras, light and output then need not be kept as changes.
Scene recorded_scene(const Scene& start, const Scene& now);

/// The colliders of the scene where those of the simulation are, for what draws or measures them.
void follow_colliders(const sim::Simulation& simulation, Scene& scene);

/// Gives a simulation what it can take of a scene while it runs, and the scene the places of its
/// colliders. @throws std::invalid_argument, see sim::Simulation::apply
void apply_scene(Scene& scene, sim::Simulation& simulation);

/// Advances a simulation and makes the changes again on the way.
///
/// Whenever it returns, all changes with a step up to simulation.steps() have been made: which ones
/// have follows from the number of steps alone, also for a state that was saved and restored. With
/// on_divergence = "retry" a frame that breaks a rule, or still takes shorter steps for an earlier
/// one, is simulated as a whole: its steps are not final before its end, and changes that fall
/// inside are made there.
class ChangePlayer {
 public:
  /// @param start       resolved, what the simulation was built from; its views decide which are
  ///                    drawn: changes of others are passed over
  /// @param changes     in the order they were made
  /// @param after_each  is told the scene after each change, in the thread that advances; may be
  ///                    empty
  ChangePlayer(const Scene& start, std::vector<LiveChange> changes, sim::Simulation& simulation,
               std::function<void(const Scene&)> after_each = {});

  /// The scene as it is now.
  const Scene& scene() const { return scene_; }
  const std::vector<LiveChange>& changes() const { return changes_; }

  /// Makes the changes that are due before the first step.
  void begin() { make_due(); }

  /// Before a state after so many steps is restored into the simulation.
  void go_to(std::size_t steps);

  /// sim::Simulation::advance_to or sim::advance_retrying, as the settings want it by then.
  sim::AdvanceReport advance_to(double time, bool (*interrupted)(),
                                std::vector<sim::Retry>& retries);

 private:
  void make_due();
  void make(std::size_t end);
  sim::AdvanceReport advance(double time, bool (*interrupted)(), std::size_t last_step,
                             std::vector<sim::Retry>& retries);

  SceneSource source_;
  std::vector<LiveChange> changes_;
  std::size_t made_ = 0;  ///< how many of them
  sim::Simulation& simulation_;
  std::function<void(const Scene&)> after_each_;
  Scene scene_;
};

}  // namespace neve::app
