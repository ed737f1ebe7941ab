#pragma once
/// A simulation on a thread of its own: takes requests and publishes LiveFrames.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/run/changes.h"
#include "app/run/moment.h"
#include "app/setup/seed_scene.h"
#include "app/view/session/kept_frames.h"
#include "app/view/session/live_frame.h"

namespace neve::app::view::session {

struct SessionOptions {
  int threads = 0;                ///< 0: one per core
  double coarsening = 1;          ///< of --coarsen, for advice
  std::uint64_t kept_budget = 0;  ///< bytes of kept frames; 0: a quarter of the free memory
};

/// All functions but moment(), latest() and taken() only ask: their effect shows in the frames that
/// follow.
class Session {
 public:
  /// @param scene resolved
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
  /// The same up to the end of this stage, wherever it is.
  void show_stage(sim::Stage stage);
  /// Shows the state between two steps again.
  void leave_stage();

  /// Starts again. On an error the old simulation continues.
  void reset(std::shared_ptr<const scene::Scene> scene);
  /// Goes on with the live changes that make this scene of the one that runs. They are listed in
  /// all snapshots that follow.
  void apply(std::shared_ptr<const scene::Scene> scene);

  /// Shows a kept frame, the nearest at or before this number. The run waits.
  void show_frame(int frame);
  /// Back to where the run is.
  void show_head();
  /// Continues the run from the kept frame shown, with the parameters it had then; frames and
  /// changes after it are forgotten.
  void continue_from_here();

  /// Continues a run that broke a rule from its last kept frame, with the settings of this scene,
  /// which ignore rules.
  void go_on_anyway(std::shared_ptr<const scene::Scene> scene);

  /// Sets the views whose fields the session computes.
  void set_views(std::vector<scene::View> views);
  void set_probe(std::optional<dump::Probe> probe);
  /// While on, every frame is shown at its end, and waits until taken() has it.
  void set_recording(bool is_on);

  /// The moment shown, with the changes made before; without the scene it started from. Waits for
  /// the session's thread.
  run::Moment moment();

  std::shared_ptr<const LiveFrame> latest() const;
  /// The picture of this one is done: the next is welcome.
  void taken(std::uint64_t number);

 private:
  using Clock = std::chrono::steady_clock;
  /// Until when it runs.
  enum class Goal { none, step, frame, end };

  void ask(std::function<void()> command);
  void work();
  void obey(const std::function<void()>& command);
  void start(const std::shared_ptr<const scene::Scene>& scene);
  void set_goal(Goal goal);
  void stop_looking_inside();
  void leave_older();
  void forget_later();
  void require_room() const;
  void advance();
  void reach_frame();
  double seconds_left() const;
  sim::Summary note_sample();
  bool is_publication_due() const;
  void publish();
  void after_step();
  /// As it is simulated now.
  const scene::Scene& scene() const { return player_->scene(); }
  std::shared_ptr<const scene::Scene> shown_scene() const;
  void inspect_next_step(LiveFrame& live);
  void load(const KeptFrame& kept);
  void keep();
  KeptFrame state_now() const;
  run::Moment moment_now() const;

  std::function<void()> wake_;
  SessionOptions options_;

  // Only the session's thread.
  std::unique_ptr<sim::Simulation> simulation_;
  std::optional<run::ChangePlayer> player_;       ///< advances the simulation
  std::vector<sim::shapes::Collider> colliders_;  ///< where the simulation has them
  std::shared_ptr<const setup::SeededScene> seeded_;
  int frame_ = 0;                   ///< the last one passed
  sim::AdvanceReport advance_;      ///< of the frame that was reached last, or is on its way
  bool advance_is_new_ = true;      ///< the next step belongs to another frame
  std::size_t steps_of_frame_ = 0;  ///< that the simulation had at the frame before
  std::vector<picture::PlotSample> history_;
  std::shared_ptr<std::vector<RunSample>> samples_;
  KeptFrames kept_{0};
  std::uint64_t memory_at_most_ = 0;  ///< bytes of a simulation whose broken rules are ignored
  std::optional<KeptFrame> head_;     ///< where the run is, while an older frame is shown
  bool head_is_broken_ = false;       ///< it broke a rule there
  Goal goal_ = Goal::none;
  std::optional<int> stage_;  ///< of a step that is looked at: the last one done
  std::vector<scene::View> views_;
  std::optional<dump::Probe> probe_;
  std::optional<ProbeReading> last_reading_;
  bool is_recording_ = false;
  bool has_news_ = true;
  Clock::time_point published_at_{};
  Clock::time_point probed_at_{}, sampled_at_{};
  Clock::duration sampling_took_{};
  Clock::time_point measured_at_{};
  double measured_time_ = 0, speed_ = 0;
  std::uint64_t number_ = 0;
  std::string error_;
  std::uint64_t errors_ = 0;
  std::optional<health::Diagnosis> diagnosis_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> commands_;
  std::shared_ptr<const LiveFrame> latest_;
  std::atomic<bool> has_commands_ = false, is_wanted_ = true, is_ending_ = false;
  std::atomic<std::uint64_t> taken_ = 0;
  std::thread thread_;
};

}  // namespace neve::app::view::session
