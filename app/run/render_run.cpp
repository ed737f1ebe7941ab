#include "app/run/render_run.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/health/incident.h"
#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/file_hash.h"
#include "app/output/sequence.h"
#include "app/run/identity.h"
#include "app/run/step_warnings.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "sim/shapes/held_files.h"

namespace neve::app::run {

namespace {

/// Two pools of threads on fewer cores would only take turns.
constexpr int threads_for_overlap = 4;

record::RunRecord begin_record(const RenderJob& job, const sim::Simulation& simulation,
                               const render::gl::Context& context, const Drawing& drawing,
                               const record::PictureRecord& picture) {
  record::RunRecord record = run_record(job, simulation);
  record.simulation = identity_of_states(job, simulation.simd());
  record.scene_files = picture.files;
  record.backend = context.backend;
  record.gl_renderer = context.renderer;
  record.views = drawing.views();
  record.passes = job.passes;
  if (!job.passes.empty()) record.views_of_passes = record.views;
  for (const scene::Mosaic& mosaic : job.scene.mosaics) record.views.push_back(mosaic.name);
  for (const std::string& view : record.views)
    record.view_records[view].drawing = drawing_of(job, picture, view);
  return record;
}

/// A list of run.json; none if it is no list of texts.
std::vector<std::string> texts_of(const Json& run, const char* key) {
  std::vector<std::string> list;
  if (const Json json = run.value(key, Json()); json.is_array())
    for (const Json& text : json)
      if (text.is_string()) list.push_back(text.get<std::string>());
  return list;
}

}  // namespace

RenderRun::RenderRun(const RenderJob& job, timeline::Timeline& timeline,
                     const render::gl::Context& context, render::Renderer& renderer,
                     Progress& progress)
    : job_(job),
      timeline_(timeline),
      progress_(progress),
      picture_(picture_record(job, scene::write_scene(job.scene), timeline.simulation().simd())),
      drawing_(job, timeline.seeded(), renderer, picture_),
      frames_(job.frames),
      ledger_(job, timeline.seeded(),
              begin_record(job, timeline.simulation(), context, drawing_, picture_), progress) {
  if (job.options.validate) watch_laws();
  timeline_.watch({.after_step =
                       [this](double time) {
                         progress_.step(time);
                         look_at_laws();
                         return is_interrupted() || is_abandoned_;
                       },
                   .after_change =
                       [this](const scene::Scene& scene) {
                         if (laws_) laws_->use(scene.solver, scene.materials);
                       }});
}

/// Their sums begin with the state that they are given first.
void RenderRun::watch_laws() {
  laws_.emplace(timeline_.here().scene->solver, timeline_.here().scene->materials);
}

void RenderRun::look_at_laws() {
  const sim::Simulation& simulation = timeline_.simulation();
  if (!laws_ || !sim::checks::is_watch_due(simulation.steps())) return;
  for (const std::string& sentence : laws_->look(simulation)) progress_.warning(sentence);
}

RenderResult RenderRun::run() {
  const std::vector<int> flawed = begin();
  try {
    progress_.start(frames_.last, scene::number_of(job_.scene, 0));
    if (timeline_.simulation().steps() == 0) look_at_laws();
    if (laws_) ledger_.record().validation = laws_->records();
    if (mend(flawed)) make_frames();
    timeline_.moments().bring_to_disk();
    note_states();
    add_slates();
    warn_of_changed_files();
    result_.movies = ledger_.finish(result_.status);
  } catch (const std::exception& error) {
    is_abandoned_ = true;
    if (next_.valid()) next_.wait();
    ledger_.fail(error.what());
    throw;
  }
  return result_;
}

/// Draws the slates at the end, when the pictures exist that they are as large as.
void RenderRun::add_slates() {
  if (!job_.scene.shot.slate || record().frames.empty()) return;
  ledger_.bring_to_disk();
  for (output::Picture& slate : drawing_.draw_slates(record()))
    ledger_.write_picture(std::move(slate));
  ledger_.record().slate = record().frames.front().frame - 1;
}

/// The pictures have the hashes of the files as they were.
void RenderRun::warn_of_changed_files() {
  for (const std::string& file : sim::shapes::changed_held_files()) {
    std::string warning = fmt::format(
        "{} has changed since the run began, which continues with what it has read; its pictures "
        "make themselves again with the old file alone",
        file);
    progress_.warning(warning);
    told_before_.push_back(std::move(warning));
  }
  note_warnings();
}

std::vector<int> RenderRun::begin() {
  refuse_sweep_folder(job_);
  output::make_folder(job_.folder);
  if (job_.options.checkpoint_every > 0) output::tidy_checkpoint_folder(job_.folder);
  const std::optional<EarlierRun> earlier = earlier_run(job_, record());
  const bool is_same = earlier && earlier->is_same;
  std::optional<Resumption> found;
  // Pictures that a later command has drawn otherwise are none of the checkpoint.
  const bool draws_otherwise = is_same && !other_drawings(*earlier, record()).empty();
  if (job_.options.resume && !draws_otherwise)
    found = find_resumption(job_.folder, record(), picture_, job_.frames, is_same, progress_);
  if (!found)
    begin_beside(earlier);
  else if (is_same)
    ledger_.keep_views(*earlier);
  timeline_.moments() = timeline::Moments(states_folder(earlier), progress_);
  if (is_elsewhere()) timeline_.moments().add_run(job_.run);
  is_continued_ = found || job_.fork;
  if (is_same) keep_step_warnings(*earlier);
  if (found) {
    const auto is_of_earlier_part = [](const std::string& text) {
      return text.starts_with(earlier_part);
    };
    keep_warnings(earlier, is_of_earlier_part);
    for (std::string& warning : found->warnings) told_before_.push_back(std::move(warning));
    if (std::ranges::any_of(told_before_, is_of_earlier_part))
      ledger_.record().simulation = simulation_in_parts();
    ledger_.take(found->moment);
    result_.has_checkpoint = true;
    if (found->flawed.empty()) continue_from(found->moment);
  }
  ledger_.record().asked = frames_asked(is_same ? earlier : std::nullopt);
  note_retries();
  if (frames_.first > 0) {
    const bool is_known =
        earlier && (is_same || found) && record::start_of(earlier->json).has_value();
    const int last = scene::number_of(job_.scene, frames_.first - 1);
    ledger_.record().start = is_known         ? start_of_run(timeline_, earlier->json, last)
                             : job_.fork      ? job_.fork->start
                             : is_elsewhere() ? start_beside(timeline_, job_, last)
                                              : start_of_run(timeline_, Json(), last);
  }
  note_warnings();
  ledger_.open();
  return found ? found->flawed : std::vector<int>{};
}

void RenderRun::begin_beside(const std::optional<EarlierRun>& earlier) {
  if (!earlier) refuse_unreadable_run(job_);
  refuse_foreign_files(job_, record());
  if (earlier) refuse_loss(job_, *earlier, record(), picture_);
  // Nothing goes before there is a place for what replaces it.
  ledger_.make_folders();
  if (!earlier || !earlier->is_same) return ledger_.replace_earlier();
  ledger_.add_to(*earlier);
  frames_ = frames_without_gaps(job_, record());
  for (const auto& [frame, steps] : output::checkpoint_steps(job_.folder))
    inherited_.newest_checkpoint = std::max(inherited_.newest_checkpoint, frame);
  result_.is_addition = true;
  const std::string status = earlier->json.value("status", "");
  inherited_.was_cut_off = status != record::name(record::RunStatus::ok) &&
                           status != record::name(record::RunStatus::diverged);
  result_.has_checkpoint = inherited_.newest_checkpoint >= 0;
  keep_warnings(earlier, [](const std::string& text) { return !text.starts_with(no_movie); });
}

/// Joins the frames of the command and those that the run has or was asked for before. A resumed
/// run with `--frames` is asked for these: other pictures of its frames ask for no other end.
record::ViewFrames RenderRun::frames_asked(const std::optional<EarlierRun>& earlier) const {
  const setup::FrameRange ours = setup::numbers_of(job_.scene, frames_);
  record::ViewFrames asked{ours.first, ours.last};
  const auto join = [&](const record::ViewFrames& others) {
    asked = {std::min(asked.first, others.first), std::max(asked.last, others.last)};
  };
  if (!earlier) return asked;
  if (const auto& listed = earlier->pictures.frames; !listed.empty())
    join({listed.front().frame, listed.back().frame});
  const auto before = record::frames_asked(earlier->json);
  if (before && !(job_.options.resume && job_.options.frames)) join(*before);
  return asked;
}

void RenderRun::keep_warnings(const std::optional<EarlierRun>& earlier,
                              bool (*is_kept)(const std::string& warning)) {
  if (!earlier) return;
  const std::vector<std::string> of_steps = texts_of(earlier->json, "step_warnings");
  for (std::string& warning : texts_of(earlier->json, "warnings"))
    if (is_kept(warning) && std::ranges::find(of_steps, warning) == of_steps.end())
      told_before_.push_back(std::move(warning));
}

void RenderRun::keep_step_warnings(const EarlierRun& earlier) {
  const std::vector<record::FrameRecord>& frames = earlier.pictures.frames;
  if (frames.empty()) return;
  inherited_.reached = scene::frame_of(job_.scene, frames.back().frame);
  inherited_.step_warnings = texts_of(earlier.json, "step_warnings");
}

/// States that an earlier command of the same simulation has listed at its end.
std::set<int> RenderRun::trusted_states(const std::optional<EarlierRun>& earlier) const {
  std::set<int> frames;
  if (!earlier || !earlier->is_same) return frames;
  const std::string status = earlier->json.value("status", "");
  const Json states = earlier->json.value("states", Json());
  const bool has_ended = status == record::name(record::RunStatus::ok) ||
                         status == record::name(record::RunStatus::diverged) ||
                         status == record::name(record::RunStatus::interrupted);
  if (!has_ended || !states.is_object() || !states.contains("frames")) return frames;
  for (const Json& number : states["frames"])
    if (number.is_number_integer())
      frames.insert(scene::frame_of(job_.scene, whole_number<int>(number)));
  return frames;
}

/// The run that is drawn has its folder, with its own record and states, which stay as they are.
bool RenderRun::is_elsewhere() const {
  return !job_.run.empty() && !job_.fork && !job_.is_drawn_in_place();
}

timeline::StatesFolder RenderRun::states_folder(const std::optional<EarlierRun>& earlier) const {
  const std::string simd = timeline_.simulation().simd();
  const RenderOptions& options = job_.options;
  timeline::StatesFolder states{job_.folder, identity_of_states(job_, simd), identity_of(picture_),
                                simd, !options.validate};
  states.are_wanted = options.keeps_all_states || (options.keeps_states && !is_elsewhere());
  states.last_frame = frames_.last;
  states.trusted = trusted_states(earlier);
  if (options.keeps_all_states) return states;
  std::error_code error;
  const std::filesystem::space_info disk = std::filesystem::space(job_.folder, error);
  states.budget = std::max<std::uint64_t>(
      1, std::min(static_cast<std::uint64_t>(options.states_budget),
                  error ? UINT64_MAX : static_cast<std::uint64_t>(disk.available / 2)));
  return states;
}

bool RenderRun::is_done(int frame) const {
  return ledger_.is_made(frame) && !(inherited_.was_cut_off && timeline_.moments().wants(frame));
}

void RenderRun::note_states() {
  const std::optional<timeline::StatesKept> kept = timeline_.moments().kept();
  Json& states = ledger_.record().states;
  states = {};
  if (!kept) return;
  states = {{"frames", Json::array()},
            {"bytes", kept->bytes},
            {"budget", kept->budget > 0 ? Json(kept->budget) : Json()},
            {"every", kept->every}};
  for (const int frame : kept->frames)
    states["frames"].push_back(scene::number_of(job_.scene, frame));
  if (!kept->stopped.empty()) states["stopped"] = kept->stopped;
}

void RenderRun::continue_from(const timeline::Moment& moment) {
  timeline_.restore(moment);
  progress_.note("resumed after frame " +
                 std::to_string(scene::number_of(job_.scene, moment.frame)) + ", step " +
                 std::to_string(moment.steps));
}

bool RenderRun::mend(const std::vector<int>& frames) {
  if (frames.empty()) return true;
  is_mending_ = true;
  for (const int frame : frames) {
    if (frame > timeline_.here().frame && !go_to_frame(frame)) return false;
    draw_frame(frame);
    progress_.frame(frame, frame / job_.scene.fps);
  }
  is_mending_ = false;
  // The run does not continue from a later state: pictures after the checkpoint are unchecked.
  output::FoundCheckpoint found = output::find_checkpoint(job_.folder);
  if (!found.checkpoint)
    throw IoError(job_.folder.string() + ": its checkpoint is missing", job_.folder.string());
  const timeline::Moment newest = timeline::to_moment(*std::move(found.checkpoint));
  continue_from(newest);
  note_retries();
  if (laws_) watch_laws();
  return true;
}

void RenderRun::make_frames() {
  const double fps = timeline_.fps();
  int wanted = frames_.first;
  while (wanted <= frames_.last && is_done(wanted)) ++wanted;
  if (wanted > frames_.last) return;
  int first = is_continued_ ? timeline_.here().frame + 1 : 0;
  if (const auto kept = timeline_.moments().find(wanted / fps, fps, first)) first = kept->frame;
  for (int frame = first; frame <= frames_.last; ++frame) {
    if (frame > wanted && is_done(frame)) continue;
    if (frame > 0 && !go_to_frame(frame)) {
      if (result_.status == record::RunStatus::interrupted) write_checkpoint();
      return;
    }
    if (frame >= wanted)
      draw_frame(frame);
    else
      note_undrawn(frame);
    progress_.frame(frame, frame / job_.scene.fps);
    // A frame that was begun is picked up first: its steps belong to the checkpoint.
    if (is_interrupted() && frame < frames_.last && !next_.valid()) {
      result_.status = record::RunStatus::interrupted;
      write_checkpoint();
      return;
    }
    if (checkpoint_is_due(frame)) write_checkpoint();
  }
}

bool RenderRun::checkpoint_is_due(int frame) const {
  const int every = job_.options.checkpoint_every;
  return every > 0 && frame > inherited_.newest_checkpoint &&
         (frame == frames_.last || (frame > 0 && frame % every == 0));
}

/// Pictures and run.json first: what a checkpoint says was reached is on disk.
void RenderRun::write_checkpoint() {
  if (job_.options.checkpoint_every == 0 || timeline_.here().frame <= inherited_.newest_checkpoint)
    return;
  timeline_.moments().settle();
  note_states();
  ledger_.bring_to_disk();
  timeline::Moment moment = timeline_.moment();
  moment.made = ledger_.made(moment.frame);
  output::write_checkpoint(job_.folder,
                           timeline::to_checkpoint(std::move(moment), identity_of(picture_),
                                                   timeline_.simulation().simd()));
  result_.has_checkpoint = true;
}

RenderRun::Advanced RenderRun::simulate_to(int frame) {
  const auto start = Clock::now();
  timeline_.go_to(frame / timeline_.fps());
  return {timeline_.here().frame == frame, seconds_since(start)};
}

void RenderRun::begin_next(int frame) {
  // A checkpoint of this frame needs the simulation as it is.
  if (timeline_.simulation().threads() < threads_for_overlap || frame >= frames_.last ||
      is_mending_ || checkpoint_is_due(frame) || timeline_.moments().has(frame + 1) ||
      is_done(frame + 1) || is_interrupted())
    return;
  // Moments stay with this thread, which keeps one while the other simulates: looking for one there
  // too would wait for the same file twice.
  next_ = std::async(std::launch::async, [this] {
    const auto start = Clock::now();
    const bool is_reached = timeline_.advance_frame();
    return Advanced{is_reached, seconds_since(start)};
  });
}

bool RenderRun::take_kept(int frame) {
  if (!timeline_.moments().has(frame)) return false;
  const auto kept = timeline_.moments().find(frame / timeline_.fps(), timeline_.fps());
  if (!kept || kept->frame != frame) return false;
  timeline_.restore(*kept);
  const auto& made = kept->made.frames;
  const auto listed =
      std::ranges::find(made, scene::number_of(job_.scene, frame), &record::FrameRecord::frame);
  seconds_ = listed != made.end() ? listed->seconds_sim : 0;
  note_retries();
  ++ledger_.record().frames_from_states;
  return true;
}

bool RenderRun::go_to_frame(int frame) {
  if (take_kept(frame)) {
    note_warnings();
    return true;
  }
  ++result_.simulated;
  const Advanced advanced = next_.valid() ? next_.get() : simulate_to(frame);
  seconds_ = advanced.seconds;
  tell_retries();
  if (laws_) ledger_.record().validation = laws_->records();
  note_warnings();
  if (timeline_.simulation().divergence()) {
    result_.status = record::RunStatus::diverged;
    report_incident();
  } else if (!advanced.is_reached) {
    result_.status = record::RunStatus::interrupted;
  }
  return advanced.is_reached;
}

void RenderRun::compare_with_picture(int frame, std::uint64_t state_hash) {
  std::string warning = timeline::difference_from_picture(job_, frame / job_.scene.fps, state_hash);
  if (job_.fork || warning.empty()) return;
  progress_.warning(warning);
  told_before_.push_back(std::move(warning));
  note_warnings();
}

void RenderRun::draw_frame(int frame) {
  const auto start = Clock::now();
  const std::uint64_t state_hash = timeline_.simulation().state_hash();
  compare_with_picture(frame, state_hash);
  const picture::Snapshot snapshot = drawing_.read(timeline_, state_hash);
  const sim::AdvanceReport advance = timeline_.here().advance;
  const sim::Summary summary = timeline_.summary();
  std::vector<exports::Exporter::Work> exports = ledger_.read_exports(timeline_);
  std::vector<record::BodyRecord> bodies = bodies_here(timeline_);
  std::optional<timeline::Moment> moment;
  if (timeline_.moments().wants(frame)) moment = timeline_.moment();
  begin_next(frame);
  Drawing::Files drawn = drawing_.draw(snapshot);
  if (!drawn.pictures.empty()) result_.last_picture = drawn.pictures.front().image;
  const double h = job_.scene.solver.cell_size;
  record::Metrics metrics = record::measure(snapshot.particles, job_.scene);
  metrics.max_depth_cells = summary.max_depth / h;
  const record::FrameRecord made{scene::number_of(job_.scene, frame),
                                 frame / job_.scene.fps,
                                 advance,
                                 seconds_,
                                 seconds_since(start),
                                 summary,
                                 state_hash,
                                 metrics,
                                 record::forces_of(advance, summary, drawing_.scene().colliders),
                                 std::move(bodies)};
  ledger_.add(made, std::move(drawn), std::move(exports));
  ++result_.drawn;
  if (const auto slowdown = slowdown_warning(record().frames); slowdown && !said_slow_) {
    progress_.warning(*slowdown);
    said_slow_ = true;
  }
  progress_.detail("frame " + std::to_string(scene::number_of(job_.scene, frame)) + ": " +
                   std::to_string(advance.steps) + " steps, simulated in " +
                   fixed_text(seconds_, 2) + " s, drawn in " + fixed_text(seconds_since(start), 2) +
                   " s, deepest in a collider " + rough_text(metrics.max_depth_cells) + " cells");
  if (!moment) return;
  moment->made.frames = {made};
  moment->made.first_number = scene::number_of(job_.scene, 0);
  timeline_.moments().keep(*std::move(moment));
}

void RenderRun::note_undrawn(int frame) {
  std::optional<record::RunStart>& start = ledger_.record().start;
  if (!start) return;
  if (!start->before && frame == 0)
    start->before = record::Extremes{scene::number_of(job_.scene, 0) - 1};
  if (start->before) add_passed(timeline_, *start->before);
}

/// The simulation of a resumed run has the warnings of the steps before. One that draws frames of
/// an earlier command again has had fewer steps than that, whose numbers stay.
void RenderRun::note_warnings() {
  record::RunRecord& record = ledger_.record();
  const sim::Simulation& simulation = timeline_.simulation();
  const bool is_further = timeline_.here().frame > inherited_.reached || simulation.divergence();
  record.step_warnings =
      is_further ? step_warnings(*timeline_.here().scene, simulation) : inherited_.step_warnings;
  record.warnings = job_.warnings;
  record.warnings.insert(record.warnings.end(), record.step_warnings.begin(),
                         record.step_warnings.end());
  for (const std::string& warning : told_before_)
    if (std::ranges::find(record.warnings, warning) == record.warnings.end())
      record.warnings.push_back(warning);
  record.slowdown = slowdown_warning(record.frames);
}

void RenderRun::tell_retries() {
  const std::vector<sim::Retry>& retries = timeline_.here().retries;
  for (std::size_t k = retries_told_; k < retries.size(); ++k)
    progress_.warning(retries[k].sentence + ". Back to " + fixed_text(retries[k].back_to, 3) +
                      " s with dt times " + rough_text(retries[k].dt_scale));
  note_retries();
}

/// Other pictures of earlier frames forget no later one: of the same run, the longer list has all
/// of the shorter one.
void RenderRun::note_retries() {
  const std::vector<sim::Retry>& retries = timeline_.here().retries;
  retries_told_ = retries.size();
  const Json& carried = ledger_.record().carried;
  if (!carried.contains("retries") || retries.size() >= carried["retries"].size())
    ledger_.record().retries = retries;
}

/// The report first: pictures of a broken state are the more delicate part.
void RenderRun::report_incident() {
  record::RunRecord& record = ledger_.record();
  const sim::Divergence divergence = *timeline_.simulation().divergence();
  const health::Diagnosis diagnosis =
      health::diagnose(timeline_.scene(), divergence, job_.coarsening);
  record.divergence = divergence;
  record.cause = scene::name(diagnosis.cause);
  result_.diagnosis = diagnosis;
  const Json incident =
      health::incident_json(divergence, diagnosis, record.scene, job_.scene.solver.cell_size);
  ledger_.note_file(
      output::write_hashed(output::incident_path(job_.folder), to_text(incident) + "\n"));
  for (output::Picture& picture : drawing_.draw_incident(timeline_, divergence, diagnosis))
    ledger_.write_picture(std::move(picture));
}

}  // namespace neve::app::run
