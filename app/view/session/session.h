#pragma once
/// A run on a thread of its own: takes requests and publishes LiveFrames.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/setup/plan.h"
#include "app/timeline/timeline.h"
#include "app/view/session/inspector.h"
#include "app/view/session/live_frame.h"
#include "app/view/session/mailbox.h"
#include "app/view/session/samples.h"

namespace neve::app::view::session {

/// A run that exists: the session continues it, and shows the moments that it kept.
struct Past {
  std::filesystem::path run;                         ///< its folder
  std::vector<scene::LiveChange> changes;            ///< until that moment, or all of them
  std::vector<record::FrameRecord> frames;           ///< that it lists, of a moment
  std::shared_ptr<const timeline::Moment> newest{};  ///< null: none is kept, it starts again
};

struct SessionOptions {
  int threads = 0;             ///< 0: one per core
  double coarsening = 1;       ///< of --coarsen, for advice
  std::optional<Past> past{};  ///< of the scene that the session begins with
};

/// Simulated seconds for each second of the clock.
class Pace {
 public:
  void begin(double time) {
    at_ = Clock::now();
    time_ = time;
  }
  /// Measures it once enough time has passed, and begins again.
  /// @param pace  set then
  void measure(double time, double& pace);

 private:
  Clock::time_point at_{};
  double time_ = 0;  ///< s, simulated then
};

/// All functions but moment(), latest() and taken() only ask: their effect shows in the frames that
/// follow.
class Session {
 public:
  /// @param scene resolved, of the start
  /// @param wake called on the session's thread after each LiveFrame
  Session(std::shared_ptr<const scene::Scene> scene, const SessionOptions& options,
          std::function<void()> wake);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void run();
  void pause();
  void next_step();
  void next_frame();
  /// Does the next stage of a step on a copy of the shown frame, and shows its result. After the
  /// last one the step is taken, in an older frame only the frame shown again.
  void next_stage();
  /// Shows the step up to the end of this stage, wherever it is.
  void show_stage(sim::Stage stage);
  /// Shows the state between two steps again.
  void leave_stage();

  /// Starts again. On an error the old run continues.
  /// @param start_number  of this start; frames say which they come from
  void reset(std::shared_ptr<const scene::Scene> scene, std::uint64_t start_number);
  /// Goes on with the live changes that make this scene of the one that runs. They are listed in
  /// all snapshots that follow.
  void apply(std::shared_ptr<const scene::Scene> scene);

  /// Shows a kept moment, the nearest at or before this frame. The run waits.
  void show_frame(int frame);
  /// Shows the moment at which the run is.
  void show_head();
  /// Continues the run from the kept frame shown, with the parameters it had then; frames and
  /// changes after it are forgotten.
  void continue_from_here();

  /// Continues a run that broke a rule from its last kept frame, with the settings of this scene,
  /// which ignore rules.
  void continue_anyway(std::shared_ptr<const scene::Scene> scene);

  /// Sets the views whose fields the session computes.
  void set_views(std::vector<scene::View> views);
  void set_probe(std::optional<dump::Probe> probe);
  /// A histogram of this field in each frame; nothing: of none.
  void set_histogram(std::optional<FieldName> field);
  /// While on, every frame is shown at its end, and waits until taken() has it.
  void set_recording(bool is_on);

  /// The moment shown. Waits for the session's thread.
  timeline::Moment moment();

  std::shared_ptr<const LiveFrame> latest() const { return mailbox_.latest(); }
  /// The picture of this one is done: the next is welcome.
  void taken(std::uint64_t number) { mailbox_.take(number); }

 private:
  /// The event that pauses the run.
  enum class Goal { none, step, frame, end };

  // All of these run on the session's thread.
  void work();
  bool obey(const std::function<void()>& request);
  bool tell();
  void start(const std::shared_ptr<const scene::Scene>& scene, const std::optional<Past>& past);
  std::function<void()> give_up_run();
  std::unique_ptr<timeline::Timeline> make_timeline(
      const scene::Scene& scene, std::vector<scene::LiveChange> changes,
      std::shared_ptr<const setup::SeededScene> seeded, timeline::Moments moments);
  void set_goal(Goal goal);
  void load(const timeline::Moment& moment);
  void leave_older();
  void fork_here();
  void advance();
  void reach_frame();
  void note_return(std::size_t steps);
  void return_to(double time);
  void require_room() const;
  bool after_step();
  bool waits_for_picture() const;
  void publish();
  std::shared_ptr<const scene::Scene> shown_scene() const;
  std::optional<sim::Divergence> divergence() const;
  const sim::Simulation& simulation() const { return timeline_->simulation(); }

  std::function<void()> wake_;
  SessionOptions options_;
  std::unique_ptr<timeline::Timeline> timeline_;
  setup::Plan plan_;  ///< its limit of memory holds where broken rules are ignored
  std::optional<timeline::Moment> head_;  ///< where the run is, while an older frame is shown
  /// The rule that the run broke where it is, once an older frame was shown: a simulation that goes
  /// back to a saved state does not know it any more.
  std::optional<sim::Divergence> broken_;
  Goal goal_ = Goal::none;
  std::vector<scene::View> views_;
  Inspector inspector_;
  Samples samples_;
  bool is_recording_ = false;
  bool has_news_ = true;
  LiveFrame told_;  ///< the parts of a frame that stay until they change: number, speed, errors
  Clock::time_point published_at_{};
  Pace pace_;
  std::size_t steps_seen_ = 0;     ///< of the run, when it was looked at last
  double begun_at_ = 0;            ///< s, where what is simulated now began
  std::uint64_t returned_in_ = 0;  ///< number of the frame that tells of the last return
  Mailbox mailbox_;
  std::thread thread_;
};

}  // namespace neve::app::view::session
