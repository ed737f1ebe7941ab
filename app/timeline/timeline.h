#pragma once
/// A run in time: its present moment, how it gets to another one, and how it forks.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/picture/snapshot.h"
#include "app/setup/seed_scene.h"
#include "app/support/progress.h"
#include "app/timeline/moments.h"

namespace neve::app::timeline {

/// Told while a run moves, in the thread that moves it; each may be empty.
struct Watch {
  std::function<bool(double time)> after_step{};  ///< s, that it ends at; @return whether to stop
  std::function<void(int frame)> after_frame{};
  std::function<void(int frame)> after_jump{};  ///< to a kept moment of this frame
  std::function<void(const scene::Scene& scene)> after_change{};
};

/// Shows how far it is, and stops at an interrupt. @param progress  outlives it
Watch watched_by(Progress& progress, const scene::Scene& scene);

/// Whenever a function returns, all changes with a step up to simulation().steps() have been made:
/// which ones have follows from the number of steps alone, also for a moment that was kept. With
/// on_divergence = "retry" a frame that breaks a rule, or still takes shorter steps for an earlier
/// one, is simulated as a whole: its steps are not final before its end, and changes that fall
/// inside are made there. Curves of the scene give their parameters the value of each frame before
/// its first step, so that these follow from the number of the frame alone.
class Timeline {
 public:
  /// Begins a run at its start. @throws as sim::Simulation
  /// @param start    resolved; changes of views that it lacks are passed over
  /// @param changes  in the order they were made
  /// @param seeded   snow of the start
  /// @param moments  that are kept of this run
  Timeline(const scene::Scene& start, std::vector<scene::LiveChange> changes,
           std::shared_ptr<const setup::SeededScene> seeded, int threads, Moments moments = {},
           Watch watch = {});
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  void watch(Watch watch) { watch_ = std::move(watch); }

  const sim::Simulation& simulation() const { return simulation_; }
  /// Returns the moment that the run is at, without its state.
  const Moment& here() const { return here_; }
  /// Returns the moment with its state.
  Moment moment() const;
  /// Returns the scene with the changes so far, and its colliders where they are.
  scene::Scene scene() const;
  /// Sums and extremes of the state.
  const sim::Summary& summary() const;
  double fps() const { return start_.fps; }
  /// s, of the frame that is simulated next or at present.
  double frame_end() const { return (here_.frame + 1) / fps(); }

  /// The scene it started from, drawn as it is drawn now.
  const scene::Scene& start() const { return start_; }
  /// Returns the changes that were made so far, and those to come.
  const std::vector<scene::LiveChange>& changes() const { return changes_; }
  const setup::SeededScene& seeded() const { return *seeded_; }
  const std::shared_ptr<const setup::SeededScene>& shared_seeded() const { return seeded_; }
  const Moments& moments() const { return moments_; }
  Moments& moments() { return moments_; }

  /// Goes to a time by the run's own steps, from the nearest moment that is kept or from here: the
  /// state is one that the run passes through, before the step that contains the time.
  /// @return whether it got there: not after a divergence, or where the watch says stop
  bool go_to(double time);
  /// Goes to the end of the frame. @return whether it got there
  bool advance_frame();
  /// Takes one step, even if it breaks a rule.
  void advance_step();

  /// Looks at the next step before it is taken. At the end of a frame the scene is the one that the
  /// last step had; while the function runs, curves have given it their values of the next frame.
  /// @param look  is told whether these are others
  void look_at_next(const std::function<void(bool has_other_values)>& look);

  /// Keeps the end of the frame that it is at, in memory.
  void keep() { moments_.keep(moment()); }
  /// Goes to a moment of this run.
  /// @throws IoError for one from a file that no healthy run has; it is then nowhere
  void restore(const Moment& moment);

  /// Makes the changes that lead from the scene here to this one, and lists them; the run forks
  /// then. Inside a frame that may go back it goes to the end of the frame before. Throws like
  /// sim::Simulation::apply; nothing has changed then.
  void change(const scene::Scene& changed);
  /// Forks the run here: forgets later changes and later moments.
  void fork();

 private:
  void begin();
  void use(const std::shared_ptr<const scene::Scene>& scene);
  /// Number of the frame whose values curves give at a moment.
  static int frame_of_curves(const Moment& moment) {
    return moment.is_frame_end() ? moment.frame : moment.frame + 1;
  }
  bool has_other_curves(int frame) const;
  /// Values of the curves for a frame that begins or was jumped into.
  void follow_curves(int frame);
  void restore_state(const Moment& moment);
  void make(std::size_t end);
  void make_due();
  sim::AdvanceReport advance(double time, std::size_t last_step);
  void begin_frame(bool is_left);
  void leave_frame_start();
  void rehearse();
  void end_rehearsed();
  std::size_t next_stop() const;
  bool end_frame();
  bool may_go_back() const { return here_.scene->solver.on_divergence == sim::OnDivergence::retry; }
  bool look_after_step();
  bool must_stop() const { return is_stopped_ || simulation_.divergence().has_value(); }

  scene::Scene start_;
  std::vector<scene::LiveChange> changes_;
  std::shared_ptr<const setup::SeededScene> seeded_;
  int threads_;
  Moments moments_;
  Watch watch_;
  sim::Simulation simulation_;
  Moment here_;
  std::size_t made_ = 0;  ///< changes that here_.scene has
  int curves_at_ = 0;     ///< frame whose values here_.scene has
  bool is_stopped_ = false;
  /// Steps of a frame that may go back, up to the next change or the end of the frame: the factor
  /// of their dt is known to hold, or to break a rule after all retries.
  struct Rehearsed {
    std::size_t end;     ///< the step after them
    double scale_after;  ///< of every dt from there on
  };
  std::optional<Rehearsed> rehearsed_;
  /// The end of the frame before one that has begun, as it was.
  struct FrameStart {
    int curves_at;
    std::shared_ptr<const scene::Scene> scene;
    sim::AdvanceReport advance;
    std::vector<std::uint8_t> state;  ///< empty: curves gave no other values
  };
  std::optional<FrameStart> frame_start_;
  mutable std::optional<sim::Summary> summary_;
};

/// Takes what pictures show of a run where it is, with the history, the steps and the changes of
/// the run so far. The history is that of the timeline: who draws while it moves keeps a copy.
/// @param scene  that is drawn: of the timeline, perhaps with other views
/// @param views  that will be drawn, not only those of the scene
picture::Snapshot take_snapshot(const Timeline& timeline, const scene::Scene& scene,
                                std::span<const scene::View> views, int frame);

}  // namespace neve::app::timeline
