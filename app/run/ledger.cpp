#include "app/run/ledger.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/file_hash.h"
#include "app/output/movie.h"
#include "app/output/sequence.h"
#include "app/record/earlier.h"
#include "app/run/identity.h"
#include "app/scene/burn_in.h"
#include "app/support/errors.h"

namespace neve::app::run {

namespace {

bool has_alpha(const scene::Scene& scene, const std::string& name) {
  return std::any_of(scene.views.begin(), scene.views.end(), [&](const scene::View& view) {
    return view.name == name && scene::background_of(scene, view) == scene::Background::transparent;
  });
}

}  // namespace

Ledger::Ledger(const RenderJob& job, const setup::SeededScene& seeded, record::RunRecord record,
               Progress& progress)
    : job_(job),
      progress_(progress),
      record_(std::move(record)),
      exporter_(job.scene, job.folder / output::exports_folder, seeded, job.changes) {}

void Ledger::replace_earlier() {
  record::remove_earlier_run(job_.folder);
  output::remove_checkpoints(job_.folder);
}

timeline::Made Ledger::made(int frame) const {
  const int number = scene::number_of(job_.scene, frame);
  timeline::Made made{record_.frames, record_.files, record_.exports,
                      scene::number_of(job_.scene, 0)};
  // Later ones are of an earlier command: run.json has them.
  std::erase_if(made.frames, [&](const record::FrameRecord& f) { return f.frame > number; });
  return made;
}

void Ledger::add_to(const EarlierRun& earlier) {
  record::remove_listed(job_.folder, add_to_run(job_, earlier, record_));
  if (!job_.scene.exports.empty() && earlier.json.contains("exports") &&
      are_exports_kept(job_, earlier))
    exporter_.resume(earlier.json["exports"], output::max_frame);
  note_exports();
  earlier_ = earlier;
}

bool Ledger::is_made(int frame) const {
  if (!earlier_ || exporter_.lacks_places(frame)) return false;
  const int number = scene::number_of(job_.scene, frame);
  const auto has = [&](const std::string& name) {
    const auto file = record_.files.find(name);
    return file != record_.files.end() && record::has_hash(job_.folder / name, file->second);
  };
  const auto has_picture = [&](const std::string& view) {
    const record::ViewRecord& record = record_.view_records.at(view);
    // A picture with the name of a frame before the earlier ones is their slate.
    return record.frames && record.frames->has(number) && earlier_->frames_of(view).has(number) &&
           has(record::picture_name(view, number));
  };
  const auto has_passes = [&](const std::string& view) {
    return has(record::channels_name(view, number));
  };
  const auto has_export = [&](const std::string& name) {
    return has(std::string(output::exports_folder) + "/" + name);
  };
  return std::ranges::all_of(record_.views, has_picture) &&
         std::ranges::all_of(record_.views_of_passes, has_passes) &&
         std::ranges::all_of(exporter_.files_of(frame), has_export);
}

void Ledger::take(const timeline::Moment& moment) {
  record_.frames = moment.made.frames;
  record_.files = moment.made.files;
  try {
    exporter_.resume(moment.made.exports, scene::number_of(job_.scene, moment.frame));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    timeline::refuse_moment(moment.file, error);
  }
  note_exports();
}

void Ledger::make_folders() {
  if (!job_.scene.exports.empty()) output::make_own_folder(job_.folder / output::exports_folder);
  for (const std::string& view : record_.views) output::make_own_folder(job_.folder / view);
}

void Ledger::open() {
  make_folders();
  write();
}

void Ledger::note_written() {
  for (const output::WrittenFile& file : writer_.take_written()) note_file(file);
}

void Ledger::note_file(const output::WrittenFile& file) {
  record_.files[file.file.lexically_relative(job_.folder).generic_string()] =
      record::hash_text(file.hash);
  unsynced_.insert(file.file);
}

void Ledger::note_exports() {
  if (!job_.scene.exports.empty())
    record_.exports = exporter_.to_json(std::string(output::exports_folder) + "/");
}

std::vector<exports::Exporter::Work> Ledger::read_exports(const timeline::Timeline& timeline) {
  const int frame = timeline.here().frame;
  const bool is_due = !exporter_.files_of(frame).empty();
  if (!is_due && !exporter_.has_stage()) return {};
  const int number = scene::number_of(job_.scene, frame);
  std::vector<exports::Exporter::Work> work;
  if (is_due) work = exporter_.add(timeline.scene().colliders, timeline.simulation(), number, true);
  if (const std::string warning = exporter_.take_warning(); !warning.empty())
    progress_.warning(warning);
  exporter_.add_between(timeline.scene().colliders, timeline.simulation(), number, true);
  note_exports();
  return work;
}

/// Lists a frame first and writes it then: whenever the process is killed, the next run knows every
/// picture that it has to remove. The hash follows when it is written.
void Ledger::add(const record::FrameRecord& frame, Drawing::Files drawn,
                 std::vector<exports::Exporter::Work> exports) {
  has_added_ = true;
  record::add_frame(record_.frames, frame);
  note_written();
  for (const std::string& view : record_.views) {
    record_.files.erase(record::picture_name(view, frame.frame));
    std::optional<record::ViewFrames>& frames = record_.view_records[view].frames;
    if (!frames) continue;
    const bool is_first = frames->count() <= 0;
    frames = {is_first ? frame.frame : std::min(frames->first, frame.frame),
              is_first ? frame.frame : std::max(frames->last, frame.frame)};
  }
  for (const std::string& view : record_.views_of_passes)
    record_.files.erase(record::channels_name(view, frame.frame));
  write();
  for (output::Picture& picture : drawn.pictures) writer_.write(std::move(picture));
  for (output::WriteTask& file : drawn.channels) writer_.write(std::move(file));
  for (exports::Exporter::Work& file : exports) writer_.write(std::move(file));
}

void Ledger::bring_to_disk() {
  writer_.finish();
  note_written();
  write();
  unsynced_.insert(output::run_json_path(job_.folder));
  output::sync_files({unsynced_.begin(), unsynced_.end()});
  unsynced_.clear();
}

std::vector<std::filesystem::path> Ledger::finish(record::RunStatus status) {
  writer_.finish();
  note_written();
  std::vector<std::filesystem::path> movies;
  // One picture is no movie.
  if (job_.has_movies())
    for (const std::string& view : record_.views) {
      write_movie(view, style_of(view), movies);
      write_earlier_movies(view, movies);
    }
  for (const output::WrittenFile& file : exporter_.finish()) note_file(file);
  record_.status = status;
  carry_status();
  bring_to_disk();
  return movies;
}

/// True of a movie that does not show all pictures of its view.
bool Ledger::is_movie_short(const std::filesystem::path& file) const {
  return has_added_ || record::short_movies(record_).contains(file.filename().string());
}

/// A film that exists stays as it is where nobody asks for another one.
output::MovieStyle Ledger::style_of(const std::string& view) const {
  const output::MovieStyle& asked = job_.options.movie;
  const std::string file = output::movie_path({}, view, asked.format).filename().string();
  const auto listed = record_.movies.find(file);
  if (asked.is_chosen || listed == record_.movies.end() || !record_.files.contains(file))
    return asked;
  return movie_style_of(job_, listed->second, file);
}

/// Movies in other formats would end where the film did before.
void Ledger::write_earlier_movies(const std::string& view,
                                  std::vector<std::filesystem::path>& movies) {
  const std::filesystem::path own = output::movie_path({}, view, job_.options.movie.format);
  for (const std::filesystem::path file : movies_of(view, record_.files)) {
    const auto listed = record_.movies.find(file.string());
    if (file == own || listed == record_.movies.end() || !is_movie_short(file)) continue;
    write_movie(view, movie_style_of(job_, listed->second, file), movies);
  }
}

void Ledger::write_movie(const std::string& view, const output::MovieStyle& style,
                         std::vector<std::filesystem::path>& movies) {
  const record::ViewFrames frames = record::frames_of(record_, view);
  if (frames.count() <= 1) return;
  const int first = frames.first - (record_.slate ? 1 : 0);
  const std::filesystem::path file = output::movie_path(job_.folder, view, style.format);
  const auto listed = record_.files.find(file.filename().string());
  const auto made = record_.movies.find(file.filename().string());
  if (!is_movie_short(file) && listed != record_.files.end() &&
      (made == record_.movies.end() || has_movie_style(job_, made->second, style)) &&
      record::has_hash(file, listed->second)) {
    movies.push_back(file);
    return;
  }
  const output::MovieRequest request{job_.folder / view,
                                     file,
                                     first,
                                     frames.last,
                                     job_.scene.fps,
                                     job_.plate.empty() && has_alpha(job_.scene, view),
                                     0,
                                     style,
                                     scene::time_code_of_movie(job_.scene, first, style.fps)};
  const output::MovieResult movie = output::write_movie(request);
  const std::string failure = no_movie + request.file.string() + ": " + movie.reason;
  switch (movie.outcome) {
    case output::MovieOutcome::written:
      movies.push_back(request.file);
      record_.files[request.file.filename().string()] =
          record::hash_text(output::hash_file(request.file));
      record_.movies[request.file.filename().string()] = movie_style_text(job_, style);
      record_.movie_frames[request.file.filename().string()] = frames;
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
                    "the pictures are complete; free disk space, and --resume makes the movie");
  }
}

void Ledger::fail(const std::string& error) {
  record_.status = record::RunStatus::failed;
  record_.error = error;
  note_written();
  forget_unwritten_frames();
  try {
    write();
  } catch (const IoError&) {
    // The first error is the one to report; the disk may be full for this file too.
  }
}

/// A run that ended early has not got further by other pictures of its frames.
void Ledger::carry_status() {
  using enum record::RunStatus;
  if (!earlier_ || record_.status != ok) return;
  const Json& earlier = earlier_->json;
  const std::string before = earlier.value("status", "");
  const std::vector<record::FrameRecord>& frames = earlier_->pictures.frames;
  if (before == record::name(diverged) || earlier.contains("divergence")) {
    // A command that draws further diverges again, and says so itself.
    const int last = scene::number_of(job_.scene, job_.frames.last);
    if (!frames.empty() && last <= frames.back().frame)
      record_.carried_status = record::name(diverged);
    return;
  }
  const bool has_all = record::frames_asked(earlier) && !record_.frames.empty() &&
                       record_.frames.back().frame >= record_.asked->last && has_all_pictures();
  if (before == record::name(ok) || has_all) return;
  // One that was killed had no time to say so.
  record_.carried_status = before == record::name(running) ? record::name(interrupted) : before;
  if (before == record::name(failed)) record_.carried["error"] = earlier.value("error", Json());
}

/// True where every view has the frames that this command and those before it were asked for: what
/// was interrupted was the drawing, and it is done.
bool Ledger::has_all_pictures() const {
  const auto have = [&](const std::optional<record::ViewFrames>& asked) {
    return !asked || std::ranges::all_of(record_.view_records, [&](const auto& view) {
      const record::ViewFrames frames = record::frames_of(record_, view.first);
      return frames.has(asked->first) && frames.has(asked->last);
    });
  };
  return have(record_.asked) && have(record::frames_asked(earlier_->json));
}

bool Ledger::is_missing(const std::string& view, int number) const {
  std::error_code error;
  const auto& with_passes = record_.views_of_passes;
  return !std::filesystem::exists(output::frame_path(job_.folder, view, number), error) ||
         (std::ranges::find(with_passes, view) != with_passes.end() &&
          !std::filesystem::exists(output::channels_path(job_.folder, view, number), error));
}

void Ledger::forget_unwritten_frames() {
  for (const std::string& view : record_.views) {
    std::optional<record::ViewFrames>& part = record_.view_records[view].frames;
    if (!part) continue;
    while (part->count() > 0 && is_missing(view, part->last)) --part->last;
    while (part->count() > 0 && is_missing(view, part->first)) ++part->first;
  }
  // Frames that an earlier command simulated stay known, even if their pictures are missing.
  const auto is_of_earlier = [&](const record::FrameRecord& frame) {
    return earlier_ && std::ranges::binary_search(earlier_->pictures.frames, frame.frame, {},
                                                  &record::FrameRecord::frame);
  };
  std::erase_if(record_.frames, [&](const record::FrameRecord& frame) {
    if (is_of_earlier(frame)) return false;
    return std::ranges::any_of(
        record_.views, [&](const std::string& view) { return is_missing(view, frame.frame); });
  });
}

}  // namespace neve::app::run
