#pragma once
/// The frame loop of `neve render`: advance, draw, write, record.

#include <atomic>
#include <filesystem>
#include <future>
#include <optional>
#include <set>
#include <vector>

#include "app/health/diagnosis.h"
#include "app/run/drawing.h"
#include "app/run/ledger.h"
#include "app/run/render_job.h"
#include "app/run/resume.h"
#include "app/support/progress.h"
#include "app/timeline/timeline.h"
#include "render/renderer.h"
#include "sim/checks/watch.h"

namespace neve::app::run {

struct RenderResult {
  bool has_checkpoint = false;  ///< the run can be resumed
  record::RunStatus status = record::RunStatus::ok;
  std::vector<std::filesystem::path> movies;
  std::optional<render::Image> last_picture;   ///< of the first view
  int drawn = 0;                               ///< frames
  int simulated = 0;                           ///< of these
  bool is_addition = false;                    ///< to a run that the folder had
  std::optional<health::Diagnosis> diagnosis;  ///< of a run that diverged
};

/// The traces of an earlier command in the folder, where this one adds to its run.
struct Inherited {
  int newest_checkpoint = -1;                ///< its frame, counted from 0
  bool was_cut_off = false;                  ///< the command
  int reached = -1;                          ///< the last frame that it made, counted from 0
  std::vector<std::string> step_warnings{};  ///< up to that frame
};

class RenderRun {
 public:
  /// @param job       with a resolved scene; must outlive the run, like the others
  /// @param timeline  at the start, or at the fork of the job
  RenderRun(const RenderJob& job, timeline::Timeline& timeline, const render::gl::Context& context,
            render::Renderer& renderer, Progress& progress);

  /// Removes the files of an earlier run, or resumes it, then makes all frames and movies. run.json
  /// says at every moment how far it got, also when this throws.
  RenderResult run();

  const record::RunRecord& record() const { return ledger_.record(); }
  /// Findings of --validate; empty without the flag.
  const std::optional<sim::checks::Watch>& laws() const { return laws_; }

 private:
  /// Adds to the run that the folder has, or replaces it. @throws UsageError for what would be lost
  void begin_beside(const std::optional<EarlierRun>& earlier);
  record::ViewFrames frames_asked(const std::optional<EarlierRun>& earlier) const;
  /// Warnings of the earlier part of the run stay in its run.json.
  void keep_warnings(const std::optional<EarlierRun>& earlier,
                     bool (*is_kept)(const std::string& warning));
  void keep_step_warnings(const EarlierRun& earlier);
  std::set<int> trusted_states(const std::optional<EarlierRun>& earlier) const;
  timeline::StatesFolder states_folder(const std::optional<EarlierRun>& earlier) const;
  /// True where the run that is drawn has another folder.
  bool is_elsewhere() const;
  void note_states();
  /// True where the run has the pictures of a frame already; of a run that was cut off its state
  /// too, if it is to be kept.
  bool is_done(int frame) const;
  /// Starts, or resumes. @return frames before with pictures that are missing or damaged
  std::vector<int> begin();
  void continue_from(const timeline::Moment& moment);
  /// Makes these frames again, then goes back to the newest checkpoint. @return whether the run
  /// continues
  bool mend(const std::vector<int>& frames);
  void make_frames();
  void add_slates();
  void watch_laws();
  void look_at_laws();
  /// @return whether the frame was reached in good health
  bool go_to_frame(int frame);
  bool take_kept(int frame);
  struct Advanced {
    bool is_reached = false;
    double seconds = 0;  ///< that it took
  };
  Advanced simulate_to(int frame);
  /// Lets the next frame be simulated while this one is drawn, where there are cores for both.
  void begin_next(int frame);
  void compare_with_picture(int frame, std::uint64_t state_hash);
  void draw_frame(int frame);
  void warn_of_changed_files();
  void note_undrawn(int frame);
  bool checkpoint_is_due(int frame) const;
  void write_checkpoint();
  void note_warnings();
  /// Notes them for run.json, and warns of new ones.
  void tell_retries();
  void note_retries();
  void report_incident();

  const RenderJob& job_;
  timeline::Timeline& timeline_;
  Progress& progress_;
  record::PictureRecord picture_;  ///< of any view and frame
  Drawing drawing_;
  std::optional<sim::checks::Watch> laws_;  ///< of --validate
  RenderResult result_;
  setup::FrameRange frames_;  ///< to draw, counted from 0
  Inherited inherited_;
  std::vector<std::string> told_before_;  ///< warnings of that command, but for those of its steps
  std::size_t retries_told_ = 0;
  double seconds_ = 0;         ///< that the simulation of the frame took
  bool is_continued_ = false;  ///< from a checkpoint or a fork
  bool is_mending_ = false;
  bool said_slow_ = false;
  std::atomic<bool> is_abandoned_ = false;  ///< nobody waits for the frame being simulated
  std::future<Advanced> next_;  ///< the frame after the one being drawn, if it was begun
  Ledger ledger_;               ///< last: its writer stops first
};

}  // namespace neve::app::run
