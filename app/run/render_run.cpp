#include "app/run/render_run.h"

#include <algorithm>
#include <new>
#include <system_error>

#include "app/health/incident.h"
#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/file_hash.h"
#include "app/output/movie.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/picture/mosaic.h"
#include "app/picture/shutter.h"
#include "app/run/plate.h"
#include "app/run/slowdown.h"
#include "app/run/step_warnings.h"
#include "app/scene/read.h"
#include "app/support/clock.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "render/image/mean_image.h"

namespace neve::app::run {

namespace {

bool has_alpha(const scene::Scene& scene, const std::string& name) {
  return std::any_of(scene.views.begin(), scene.views.end(), [&](const scene::View& view) {
    return view.name == name && scene::background_of(scene, view) == scene::Background::transparent;
  });
}

/// Two pools of threads on fewer cores would only take turns.
constexpr int threads_for_overlap = 4;

record::RunRecord run_record(const RenderJob& job, const sim::Simulation& simulation,
                             const render::gl::Context& context) {
  record::RunRecord record;
  record.scene = scene::write_scene(job.scene);
  record.scene_file = job.scene_file;
  record.overrides = job.overrides;
  record.changes = job.changes;
  record.coarsening = job.coarsening;
  record.backend = context.backend;
  record.gl_renderer = context.renderer;
  record.threads = simulation.threads();
  record.simd = simulation.simd();
  return record;
}

}  // namespace

RenderRun::RenderRun(const RenderJob& job, sim::Simulation& simulation,
                     const render::gl::Context& context, render::Renderer& renderer,
                     const setup::SeededScene& seeded, Progress& progress, const ForkPoint* fork)
    : job_(job),
      seeded_(&seeded),
      fork_(fork),
      simulation_(simulation),
      renderer_(renderer),
      progress_(progress),
      scene_(job.scene),
      player_(job.scene, job.changes, simulation,
              [this](const scene::Scene& scene) {
                if (validation_) validation_->use(scene.solver, scene.materials);
              }),
      builder_(scene_, seeded, {job.quality, job.overrides, job.coarsening}),
      exporter_(job.scene, job.folder / output::exports_folder, seeded.body_end),
      record_(run_record(job, simulation, context)),
      picture_record_(record_of_job(job, record_.scene, record_.simd)),
      checkpoints_(job.folder, picture_record_, simulation, player_, progress),
      states_(job, simulation, progress) {
  if (job.validate)
    validation_.emplace(job.scene.solver, job.scene.materials, simulation, progress);
  for (const scene::View& view : job.scene.views)
    if (is_drawn(view)) record_.views.push_back(view.name);
  if (!job.passes.empty()) {
    passes_.emplace(scene_, seeded, pass_list(job.passes));
    record_.passes = job.passes;
    record_.views_of_passes = record_.views;
  }
  for (const scene::Mosaic& mosaic : job.scene.mosaics) record_.views.push_back(mosaic.name);
  if (fork) record_.forked = fork->record;
}

/// Frames of the run before stay listed until they are made again: whenever the process is killed,
/// run.json knows every picture that is there.
int RenderRun::begin() {
  output::make_folder(job_.folder);
  if (job_.checkpoint_every > 0) output::tidy_checkpoint_folder(job_.folder);
  states_.begin();
  std::optional<Resumption> found;
  if (job_.resume) found = checkpoints_.find(record_, job_.frames);
  int first = 0;
  if (found) {
    first = resume(std::move(*found));
  } else {
    first = start();
    exports::remove_earlier_exports(job_.folder, record::earlier_exports(job_.folder));
    output::remove_earlier_run(job_.folder);
    output::remove_checkpoints(job_.folder);
  }
  scene_ = player_.scene();
  note_warnings();
  for (const std::string& view : record_.views) {
    output::make_folder(job_.folder / view);
    output::remove_abandoned(job_.folder / view);
  }
  record::write_run_json(job_.folder, record_);
  return first;
}

int RenderRun::start() {
  if (!fork_) {
    player_.begin();
    return 0;
  }
  player_.go_to(fork_->run.steps, fork_->scene);
  history_ = fork_->run.history;
  advance_ = fork_->run.advance;
  record_.retries = fork_->run.retries;
  scene_ = player_.scene();
  return fork_->run.frame + 1;
}

int RenderRun::resume(Resumption found) {
  record_.frames = std::move(found.run.frames);
  record_.files = std::move(found.run.files);
  try {
    exporter_.resume(found.run.exports, found.run.frame);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(found.run.file, error);
  }
  note_exports();
  result_.has_checkpoint = true;
  const int reached = found.run.frame;
  if (found.flawed.empty()) {
    continue_from(std::move(found.run));
    return reached + 1;
  }
  repair_ = {{found.flawed.begin(), found.flawed.end()}, std::move(found.run)};
  if (!found.repair) return start();
  const int before = found.repair->frame;
  continue_from(std::move(*found.repair));
  return before + 1;
}

void RenderRun::continue_from(ResumedRun run) {
  checkpoints_.go_to(run);
  history_ = std::move(run.history);
  advance_ = run.advance;
  record_.retries = std::move(run.retries);
  scene_ = player_.scene();
  progress_.note("resumed after frame " + std::to_string(run.frame) + ", step " +
                 std::to_string(run.steps));
}

int RenderRun::end_repair() {
  ResumedRun then = std::move(repair_->then);
  repair_.reset();
  const int frame = then.frame;
  continue_from(std::move(then));
  // Its sums begin with the state it is given first.
  if (validation_) validation_.emplace(scene_.solver, scene_.materials, simulation_, progress_);
  return frame;
}

int RenderRun::last_frame() const {
  return repair_ ? *repair_->frames.rbegin() : job_.frames.last;
}

bool RenderRun::is_to_draw(int frame) const {
  return repair_ ? repair_->frames.contains(frame) : frame >= job_.frames.first;
}

void RenderRun::note_written() {
  for (const output::WrittenFile& file : writer_.take_written()) note_file(file);
}

void RenderRun::note_file(const output::WrittenFile& file) {
  record_.files[file.file.lexically_relative(job_.folder).generic_string()] =
      record::hash_text(file.hash);
  unsynced_.insert(file.file);
}

void RenderRun::bring_to_disk() {
  writer_.finish();
  note_written();
  record::write_run_json(job_.folder, record_);
  unsynced_.insert(output::run_json_path(job_.folder));
  output::sync_files({unsynced_.begin(), unsynced_.end()});
  unsynced_.clear();
}

RenderResult RenderRun::run() {
  const int first = begin();
  try {
    make_frames(first);
    writer_.finish();
    note_written();
    write_movies();
    for (const output::WrittenFile& file : exporter_.finish()) note_file(file);
    record_.status = result_.status;
    bring_to_disk();
  } catch (const std::exception& error) {
    is_abandoned_ = true;
    if (next_.valid()) next_.wait();
    record_.status = record::RunStatus::failed;
    record_.error = error.what();
    note_written();
    forget_unwritten_frames();
    try {
      record::write_run_json(job_.folder, record_);
    } catch (const IoError&) {
      // The first error is the one to report; the disk may be full for this file too.
    }
    throw;
  }
  return result_;
}

void RenderRun::make_frames(int first) {
  progress_.start(job_.frames.last);
  if (validation_ && simulation_.steps() == 0) {
    validation_->after_step();
    record_.validation = validation_->records();
  }
  if (!repair_) first = states_.skip_to(first, job_.frames.first);
  for (int frame = first; frame <= last_frame(); ++frame) {
    seconds_sim_ = 0;
    if (frame > 0 && !advance_to_frame(frame)) {
      if (result_.status == record::RunStatus::interrupted) write_checkpoint(frame - 1);
      return;
    }
    summary_ = simulation_.summary();
    if (kept_grid_blocks_) summary_.grid_blocks = *kept_grid_blocks_;
    history_.push_back(
        picture::plot_sample(frame / job_.scene.fps, 1 / job_.scene.fps, summary_, advance_));
    if (is_to_draw(frame)) {
      draw_frame(frame);
      states_.write(frame, advance_, history_, record_);
    }
    advance_ = {};
    progress_.frame(frame, frame / job_.scene.fps);
    // A frame that was begun is picked up first: its steps belong to the checkpoint.
    if (is_interrupted() && frame < last_frame() && !next_.valid()) {
      result_.status = record::RunStatus::interrupted;
      write_checkpoint(frame);
      return;
    }
    if (checkpoint_is_due(frame)) write_checkpoint(frame);
    if (repair_ && frame == last_frame()) frame = end_repair();
  }
}

bool RenderRun::checkpoint_is_due(int frame) const {
  const int every = job_.checkpoint_every;
  return every > 0 && !repair_ && (frame == job_.frames.last || (frame > 0 && frame % every == 0));
}

/// Pictures and run.json first: what a checkpoint says was reached is on disk.
void RenderRun::write_checkpoint(int frame) {
  if (job_.checkpoint_every == 0 || repair_) return;
  bring_to_disk();
  checkpoints_.write(frame, advance_, history_, record_);
  result_.has_checkpoint = true;
}

bool RenderRun::after_step() {
  progress_.step();
  if (validation_) validation_->after_step();
  return is_interrupted() || is_abandoned_;
}

RenderRun::Advanced RenderRun::simulate_to(int frame) {
  const auto start = Clock::now();
  Advanced advanced;
  const double time = frame / job_.scene.fps;
  advanced.report = player_.advance_to(
      time, [this] { return after_step(); }, advanced.retries);
  advanced.scene = player_.scene();
  follow_colliders(simulation_, advanced.scene);
  advanced.seconds = seconds_since(start);
  return advanced;
}

void RenderRun::begin_next(int frame) {
  // A checkpoint of this frame needs the simulation as it is.
  if (simulation_.threads() < threads_for_overlap || frame >= last_frame() ||
      checkpoint_is_due(frame) || states_.needs_state(frame) || states_.has(frame + 1) ||
      is_interrupted())
    return;
  next_ = std::async(std::launch::async, [this, frame] { return simulate_to(frame + 1); });
}

bool RenderRun::take_kept_state(int frame) {
  std::optional<KeptState> kept = states_.find(frame);
  if (!kept) return false;
  try {
    player_.go_to(kept->run.steps);
    restore_frame(kept->run, job_.scene.fps, simulation_);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(kept->run.file, error);
  }
  scene_ = player_.scene();
  follow_colliders(simulation_, scene_);
  history_ = std::move(kept->run.history);
  history_.pop_back();  // of this frame, which is about to be added
  record_.retries = std::move(kept->run.retries);
  advance_ = kept->advance;
  seconds_sim_ = kept->seconds;
  kept_grid_blocks_ = kept->grid_blocks;
  ++record_.frames_from_states;
  return true;
}

/// @return whether the frame was reached in good health
bool RenderRun::advance_to_frame(int frame) {
  if (take_kept_state(frame)) {
    note_warnings();
    return true;
  }
  kept_grid_blocks_.reset();
  Advanced advanced = next_.valid() ? next_.get() : simulate_to(frame);
  scene_ = std::move(advanced.scene);
  advance_.append(advanced.report);
  note_retries(advanced.retries);
  seconds_sim_ = advanced.seconds;
  if (validation_) record_.validation = validation_->records();
  note_warnings();
  if (simulation_.divergence()) {
    record_.divergence = simulation_.divergence();
    result_.status = record::RunStatus::diverged;
    report_incident();
    return false;
  }
  if (is_interrupted()) {
    result_.status = record::RunStatus::interrupted;
    return false;
  }
  return true;
}

void RenderRun::draw_frame(int frame) {
  const auto start = Clock::now();
  picture::Snapshot snapshot =
      picture::take_snapshot(scene_, views_of_snapshot(), simulation_, frame);
  if (passes_) pass_numbers_ = passes_->read(snapshot, simulation_);
  snapshot.history = history_;
  snapshot.advance = advance_;
  const std::uint64_t state_hash = simulation_.state_hash();
  note_state(state_hash);
  snapshot.changes = picture_record_.changes;
  std::vector<exports::Exporter::Work> work = read_exports(frame);
  begin_next(frame);
  std::vector<output::Picture> pictures;
  const auto add = [&](const std::string& name, render::Image image) {
    if (pictures.empty()) result_.last_picture = image;
    pictures.push_back(
        {output::frame_path(job_.folder, name, frame), std::move(image), png_text(name, frame)});
  };
  // A GPU draws one view while the next is put together.
  std::vector<std::string> waiting;
  const auto fetch_down_to = [&](std::size_t left) {
    for (; waiting.size() > left; waiting.erase(waiting.begin()))
      add(waiting.front(), renderer_.fetch());
  };
  for (const scene::View& view : scene_.views) {
    if (!is_drawn(view)) continue;
    render::Frame drawn = builder_.build(view, snapshot);
    if (!job_.plate.empty()) drawn.is_transparent = true;
    const std::vector<render::Frame> moments = moments_of(view, snapshot, drawn);
    if (moments.empty() && job_.plate.empty()) {
      renderer_.submit(drawn);
      waiting.push_back(view.name);
    } else {
      fetch_down_to(0);
      add(view.name, draw_composed(view, frame, drawn, moments));
    }
    if (passes_) add_channels(view, snapshot, drawn, moments);
    fetch_down_to(1);
  }
  fetch_down_to(0);
  for (const scene::Mosaic& mosaic : scene_.mosaics)
    add(mosaic.name, picture::draw_mosaic(scene_, mosaic, builder_, snapshot, renderer_,
                                          [&](const scene::View& view, const render::Frame& tile) {
                                            return draw_tile(view, snapshot, tile);
                                          }));
  record::Metrics metrics = measure(snapshot.particles, job_.scene.solver.cell_size);
  metrics.max_depth_cells = summary_.max_depth / job_.scene.solver.cell_size;
  record::add_frame(record_.frames, {frame, frame / job_.scene.fps, advance_, seconds_sim_,
                                     seconds_since(start), summary_, state_hash, metrics,
                                     record::forces_of(advance_, summary_, scene_.colliders)});
  if (const auto slowdown = slowdown_warning(record_.frames); slowdown && !said_slow_) {
    progress_.warning(*slowdown);
    said_slow_ = true;
  }
  // Listed first and written then: whenever the process is killed, the next run knows every picture
  // that it has to remove. The hash follows when it is written.
  note_written();
  for (const std::string& view : record_.views)
    record_.files.erase(record::picture_name(view, frame));
  for (const std::string& view : record_.views_of_passes)
    record_.files.erase(record::channels_name(view, frame));
  record::write_run_json(job_.folder, record_);
  for (output::Picture& picture : pictures) writer_.write(std::move(picture));
  for (output::WriteTask& file : pass_work_) writer_.write(std::move(file));
  pass_work_.clear();
  for (exports::Exporter::Work& file : work) writer_.write(std::move(file));
  progress_.detail("frame " + std::to_string(frame) + ": " + std::to_string(advance_.steps) +
                   " steps, simulated in " + fixed_text(seconds_sim_, 2) + " s, drawn in " +
                   fixed_text(seconds_since(start), 2) + " s, deepest in a collider " +
                   rough_text(metrics.max_depth_cells) + " cells");
}

/// Stress is read only where a view shows it.
std::vector<scene::View> RenderRun::views_of_snapshot() const {
  std::vector<scene::View> views = scene_.views;
  if (!passes_) return views;
  for (scene::View& view : views_for(passes_->list())) views.push_back(std::move(view));
  return views;
}

std::vector<render::Frame> RenderRun::moments_of(const scene::View& view,
                                                 const picture::Snapshot& snapshot,
                                                 const render::Frame& frame) const {
  if (!(job_.shutter > 0)) return {};
  return picture::shutter_moments({scene_, view, *seeded_, snapshot}, frame, job_.shutter);
}

render::Image RenderRun::draw_composed(const scene::View& view, int number,
                                       const render::Frame& frame,
                                       const std::vector<render::Frame>& moments) {
  std::optional<render::Image> plate;
  if (!job_.plate.empty())
    plate = read_plate(plate_path(job_.plate, number), view.name, {frame.width, frame.height});
  const auto draw = [&](const render::Frame& moment) {
    return plate ? renderer_.draw_on_plate(moment, *plate) : renderer_.draw(moment);
  };
  if (moments.empty()) return draw(frame);
  render::MeanImage mean;
  for (const render::Frame& moment : moments) mean.add(draw(moment));
  return mean.mean();
}

/// With motion blur, and never on a plate.
render::Image RenderRun::draw_tile(const scene::View& view, const picture::Snapshot& snapshot,
                                   const render::Frame& tile) {
  const std::vector<render::Frame> moments = moments_of(view, snapshot, tile);
  if (moments.empty()) return renderer_.draw(tile);
  render::MeanImage mean;
  for (const render::Frame& moment : moments) mean.add(renderer_.draw(moment));
  return mean.mean();
}

void RenderRun::add_channels(const scene::View& view, const picture::Snapshot& snapshot,
                             const render::Frame& frame,
                             const std::vector<render::Frame>& moments) {
  const picture::MotionSource source{scene_, view, *seeded_, snapshot};
  render::channels::Request request = passes_->request(source, frame, pass_numbers_);
  request.moments = moments;
  auto picture =
      std::make_shared<const render::ExrPicture>(renderer_.draw_channels(frame, request));
  pass_work_.push_back([file = output::channels_path(job_.folder, view.name, snapshot.frame),
                        header = passes_->header(record_of(view.name, snapshot.frame), frame),
                        picture = std::move(picture)] {
    return std::vector{output::write_hashed(file, render::encode_exr(*picture, header))};
  });
}

std::vector<exports::Exporter::Work> RenderRun::read_exports(int frame) {
  if (!exporter_.is_due(frame)) return {};
  std::vector<exports::Exporter::Work> work =
      exporter_.add(scene_.colliders, simulation_, frame, true);
  note_exports();
  return work;
}

void RenderRun::note_exports() {
  if (!job_.scene.exports.empty())
    record_.exports = exporter_.to_json(std::string(output::exports_folder) + "/");
}

/// The simulation of a resumed run has the warnings of the steps before.
void RenderRun::note_warnings() {
  record_.warnings = job_.warnings;
  for (std::string& warning : step_warnings(scene_, simulation_))
    record_.warnings.push_back(std::move(warning));
  record_.slowdown = slowdown_warning(record_.frames);
}

void RenderRun::note_retries(const std::vector<sim::Retry>& retries) {
  for (const sim::Retry& retry : retries)
    progress_.warning(retry.sentence + ". Back to " + fixed_text(retry.back_to, 3) +
                      " s with dt times " + rough_text(retry.dt_scale));
  record_.retries.insert(record_.retries.end(), retries.begin(), retries.end());
}

/// The state that broke a rule, with the culprits marked, and the slice through them; pictures, but
/// no frames. The report first: pictures of a broken state are the more delicate part.
void RenderRun::report_incident() {
  const sim::Divergence& divergence = *record_.divergence;
  const health::Diagnosis diagnosis = health::diagnose(scene_, divergence, job_.coarsening);
  result_.diagnosis = diagnosis;
  record_.cause = scene::name(diagnosis.cause);
  const Json incident =
      health::incident_json(divergence, diagnosis, record_.scene, job_.scene.solver.cell_size);
  note_file(output::write_hashed(output::incident_path(job_.folder), to_text(incident) + "\n"));
  const int frame = static_cast<int>(divergence.time * job_.scene.fps);
  std::vector<scene::View> views = scene_.views;
  if (const auto slice = health::culprit_slice(scene_, divergence, simulation_.particles()))
    views.push_back(*slice);
  picture::Snapshot snapshot = picture::take_snapshot(scene_, views, simulation_, frame);
  snapshot.time = divergence.time;
  snapshot.advance = advance_;
  snapshot.history = history_;
  note_state(simulation_.state_hash());
  snapshot.changes = picture_record_.changes;
  for (const scene::View& view : views)
    writer_.write({output::diverged_path(job_.folder, view.name),
                   renderer_.draw(builder_.build_incident(view, snapshot, divergence, diagnosis)),
                   png_text(view.name, frame)});
  std::vector<std::string> caption = builder_.caption(snapshot);
  for (std::string& line : picture::FrameBuilder::incident_lines(divergence, diagnosis))
    caption.push_back(std::move(line));
  const auto build = [&](const scene::View& view) {
    return builder_.build_incident(view, snapshot, divergence, diagnosis);
  };
  for (const scene::Mosaic& mosaic : scene_.mosaics)
    writer_.write({output::diverged_path(job_.folder, mosaic.name),
                   picture::draw_mosaic(scene_, mosaic, build, caption, renderer_),
                   png_text(mosaic.name, frame)});
}

void RenderRun::write_movies() {
  // One picture is no movie.
  if (!job_.has_movies || record_.frames.size() < 2) return;
  for (const std::string& view : record_.views) write_movie(view);
}

void RenderRun::write_movie(const std::string& view) {
  const output::MovieRequest request{job_.folder / view,
                                     output::movie_path(job_.folder, view, job_.movie.format),
                                     record_.frames.front().frame,
                                     record_.frames.back().frame,
                                     job_.scene.fps,
                                     job_.plate.empty() && has_alpha(job_.scene, view),
                                     0,
                                     job_.movie};
  const output::MovieResult movie = output::write_movie(request);
  const std::string failure = "no movie " + request.file.string() + ": " + movie.reason;
  switch (movie.outcome) {
    case output::MovieOutcome::written:
      result_.movies.push_back(request.file);
      record_.files[request.file.filename().string()] =
          record::hash_text(output::hash_file(request.file));
      return;
    case output::MovieOutcome::no_ffmpeg:
      if (view == record_.views.front())
        progress_.note("no movie: ffmpeg is not installed; the pictures are in " +
                       job_.folder.string());
      return;
    case output::MovieOutcome::failed:
      record_.warnings.push_back(failure);
      progress_.warning(failure);
      return;
    case output::MovieOutcome::unwritable:
      record_.warnings.push_back(failure);
      throw IoError(failure, request.file.string(),
                    "the pictures are whole; --resume makes the movie when there is room");
  }
}

void RenderRun::forget_unwritten_frames() {
  std::erase_if(record_.frames, [&](const record::FrameRecord& frame) {
    std::error_code error;
    for (const std::string& view : record_.views)
      if (!std::filesystem::exists(output::frame_path(job_.folder, view, frame.frame), error))
        return true;
    for (const std::string& view : record_.views_of_passes)
      if (!std::filesystem::exists(output::channels_path(job_.folder, view, frame.frame), error))
        return true;
    return false;
  });
}

bool RenderRun::is_drawn(const scene::View& view) const {
  const std::vector<std::string>& tiles = job_.only_tiles;
  return std::find(tiles.begin(), tiles.end(), view.name) == tiles.end();
}

void RenderRun::note_state(std::uint64_t state_hash) {
  picture_record_.state_hash = record::hash_text(state_hash);
  picture_record_.changes = job_.changes;
  std::erase_if(picture_record_.changes,
                [&](const scene::LiveChange& change) { return change.step > simulation_.steps(); });
}

record::PictureRecord RenderRun::record_of(const std::string& view, int frame) const {
  record::PictureRecord record = picture_record_;
  record.view = view;
  record.frame = frame;
  if (!job_.plate.empty()) {
    const std::filesystem::path plate = plate_path(job_.plate, frame);
    record.files[plate.string()] = record::hash_text(output::hash_file(plate));
  }
  return record;
}

render::PngText RenderRun::png_text(const std::string& view, int frame) const {
  return record::to_png_text(record_of(view, frame));
}

}  // namespace neve::app::run
