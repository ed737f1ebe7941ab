#pragma once
/// The frame loop of `neve render`: simulate, draw, write, record.

#include <atomic>
#include <filesystem>
#include <future>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/exports/exporter.h"
#include "app/health/diagnosis.h"
#include "app/output/picture_writer.h"
#include "app/picture/frame_builder.h"
#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/run/changes.h"
#include "app/run/fork.h"
#include "app/run/kept_states.h"
#include "app/run/passes.h"
#include "app/run/render_job.h"
#include "app/run/resume.h"
#include "app/run/validation.h"
#include "app/support/progress.h"
#include "render/renderer.h"
#include "sim/simulation.h"

namespace neve::app::run {

struct RenderResult {
  bool has_checkpoint = false;  ///< the run can be resumed
  record::RunStatus status = record::RunStatus::ok;
  std::vector<std::filesystem::path> movies;
  std::optional<render::Image> last_picture;   ///< of the first view
  std::optional<health::Diagnosis> diagnosis;  ///< of a run that diverged
};

class RenderRun {
 public:
  /// @param job with a resolved scene; must outlive the run, like the others
  /// @param fork that the simulation is at; null: it is at the start
  RenderRun(const RenderJob& job, sim::Simulation& simulation, const render::gl::Context& context,
            render::Renderer& renderer, const setup::SeededScene& seeded, Progress& progress,
            const ForkPoint* fork = nullptr);

  /// Removes the files of an earlier run, or resumes it, then makes all frames and movies. run.json
  /// says at every moment how far it got, also when this throws.
  RenderResult run();

  const record::RunRecord& record() const { return record_; }
  /// Findings of --validate; null without the flag.
  const Validation* validation() const { return validation_ ? &*validation_ : nullptr; }

 private:
  /// @return the first frame to make
  int begin();
  /// The same for a run that is not resumed, or from no checkpoint.
  int start();
  /// The same for a run that goes on.
  int resume(Resumption found);
  void continue_from(ResumedRun run);
  /// Back to the newest checkpoint, once its flawed pictures are made. @return its frame
  int end_repair();
  int last_frame() const;
  bool is_to_draw(int frame) const;
  void make_frames(int first);
  bool checkpoint_is_due(int frame) const;
  void write_checkpoint(int frame);
  /// Steps towards a frame, and the seconds that they took.
  struct Advanced {
    sim::AdvanceReport report;
    std::vector<sim::Retry> retries;
    scene::Scene scene;  ///< as it is then
    double seconds = 0;
  };
  Advanced simulate_to(int frame);
  /// @return whether to stop
  bool after_step();
  bool advance_to_frame(int frame);
  /// Brings the simulation to the kept state of a frame. @return whether there is one
  bool take_kept_state(int frame);
  /// Reads the state for the exports of a frame, before the next one is begun.
  std::vector<exports::Exporter::Work> read_exports(int frame);
  /// Lets the next frame be simulated while this one is drawn, where there are cores for both.
  void begin_next(int frame);
  void draw_frame(int frame);
  /// Moments of the shutter; none without motion blur.
  std::vector<render::Frame> moments_of(const scene::View& view, const picture::Snapshot& snapshot,
                                        const render::Frame& frame) const;
  /// Draws over the plate, and as the mean of the moments. @param number  of the frame
  render::Image draw_composed(const scene::View& view, int number, const render::Frame& frame,
                              const std::vector<render::Frame>& moments);
  render::Image draw_tile(const scene::View& view, const picture::Snapshot& snapshot,
                          const render::Frame& tile);
  /// Writes the channels of a picture.
  void add_channels(const scene::View& view, const picture::Snapshot& snapshot,
                    const render::Frame& frame, const std::vector<render::Frame>& moments);
  std::vector<scene::View> views_of_snapshot() const;
  /// Takes the hashes of the files that were written in the meantime.
  void note_written();
  void note_exports();
  void note_file(const output::WrittenFile& file);
  /// Writes everything made so far, and waits until it would survive a power cut.
  void bring_to_disk();
  void note_warnings();
  void note_retries(const std::vector<sim::Retry>& retries);
  void report_incident();
  void write_movies();
  void write_movie(const std::string& view);
  void forget_unwritten_frames();
  /// By itself, not only in a mosaic.
  bool is_drawn(const scene::View& view) const;
  /// Updates the text of pictures about the current simulation.
  void note_state(std::uint64_t state_hash);
  render::PngText png_text(const std::string& view, int frame) const;
  record::PictureRecord record_of(const std::string& view, int frame) const;

  const RenderJob& job_;
  const setup::SeededScene* seeded_;
  const ForkPoint* fork_;
  sim::Simulation& simulation_;
  render::Renderer& renderer_;
  Progress& progress_;
  scene::Scene scene_;  ///< the job's with the changes made so far
  ChangePlayer player_;
  picture::FrameBuilder builder_;
  exports::Exporter exporter_;
  std::optional<PassReader> passes_;                          ///< of --passes
  std::vector<render::channels::PointNumbers> pass_numbers_;  ///< of the frame being drawn
  std::vector<output::WriteTask> pass_work_;                  ///< likewise
  record::RunRecord record_;
  record::PictureRecord picture_record_;
  Checkpoints checkpoints_;
  KeptStates states_;
  std::optional<std::size_t> kept_grid_blocks_;  ///< of the kept state that a frame is drawn from
  std::optional<Validation> validation_;
  /// Frames with missing or damaged pictures, and the run that goes on when they are made.
  struct Repair {
    std::set<int> frames;
    ResumedRun then;
  };
  std::optional<Repair> repair_;
  RenderResult result_;
  sim::AdvanceReport advance_;                ///< of the frame being made
  sim::Summary summary_;                      ///< of the frame being made
  std::vector<picture::PlotSample> history_;  ///< of all frames simulated
  double seconds_sim_ = 0;
  bool said_slow_ = false;
  std::atomic<bool> is_abandoned_ = false;  ///< nobody waits for the frame being simulated
  std::future<Advanced> next_;  ///< the frame after the one being drawn, if it was begun
  std::set<std::filesystem::path> unsynced_;  ///< files that a power cut may still take
  output::PictureWriter writer_;              ///< last: stops before its inputs are destroyed
};

}  // namespace neve::app::run
