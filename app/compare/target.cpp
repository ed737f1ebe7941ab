#include "app/compare/target.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/record/earlier.h"
#include "app/scene/burn_in.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/version.h"

namespace neve::app::compare {

namespace {

namespace fs = std::filesystem;

std::optional<output::MovieFormat> movie_format_of(const fs::path& out) {
  const std::string suffix = out.extension().string();
  return suffix.empty() ? std::nullopt : output::movie_format_named(suffix.substr(1));
}

/// Returns the style of --movie, with the format of the file's suffix where none is named.
/// @throws UsageError where the two formats are not the same
output::MovieStyle movie_for(const PairOptions& options, TargetKind kind) {
  output::MovieStyle movie = options.movie;
  if (kind != TargetKind::movie) return movie;
  const output::MovieFormat format = *movie_format_of(options.out);
  const bool is_same =
      std::string(output::info_of(movie.format).suffix) == output::info_of(format).suffix;
  if (movie.is_chosen && movie.has_format && (!is_same || !movie.is_made))
    throw UsageError(
        std::string("--movie ") + (movie.is_made ? output::name(movie.format) : "none"),
        "does not fit " + options.out,
        std::string("omit it, or name a file ") + output::info_of(movie.format).suffix);
  if (!movie.has_format) movie.format = format;
  movie.is_chosen = movie.has_format = true;
  return movie;
}

TargetKind kind_of(const fs::path& out) {
  const std::string suffix = out.extension().string();
  if (suffix == ".png") return TargetKind::picture;
  if (suffix == ".csv") return TargetKind::table;
  if (movie_format_of(out)) return TargetKind::movie;
  return TargetKind::folder;
}

std::vector<Mode> all_modes() {
  std::vector<Mode> modes;
  for (const auto& each : names(Mode{})) modes.push_back(each.value);
  return modes;
}

std::vector<Mode> modes_for(const PairOptions& options, TargetKind kind) {
  if (kind == TargetKind::folder) return options.modes.empty() ? all_modes() : options.modes;
  if (options.modes.size() > 1)
    throw UsageError("--mode", "is given more than once, and " + options.out + " holds one",
                     "give one --mode, or name a folder with --out");
  const bool is_metrics = !options.modes.empty() && options.modes.front() == Mode::metrics;
  if (kind == TargetKind::table && !options.modes.empty() && !is_metrics)
    throw UsageError("--mode", "a table has metrics", "omit --mode");
  if (kind == TargetKind::movie && is_metrics)
    throw UsageError("--mode", "metrics are one picture of all times, not a movie",
                     "name a file .png or .csv, or a folder");
  if (kind == TargetKind::table) return {Mode::metrics};
  return options.modes.empty() ? std::vector<Mode>{Mode::beside} : options.modes;
}

std::string run_name(const std::string& run) {
  return without_slash(fs::path(run).lexically_normal()).generic_string();
}

bool is_same_run(const Json& before, const std::string& now) {
  return before.is_string() && record::is_same_path(before.get<std::string>(), now);
}

}  // namespace

Target::Target(const PairOptions& options)
    : out_(options.out),
      a_(run_name(options.a)),
      b_(run_name(options.b)),
      replaces_(options.replaces),
      kind_(kind_of(options.out)),
      modes_(modes_for(options, kind_)),
      movie_(movie_for(options, kind_)) {
  std::error_code error;
  if (kind_ != TargetKind::folder || !fs::exists(output::run_json_path(out_), error)) return;
  throw UsageError("--out", options.out + " is the folder of a run",
                   "name another folder, or a file .png or .mp4");
}

Target::~Target() {
  std::error_code error;
  if (!scratch_.empty()) fs::remove_all(scratch_, error);
}

bool Target::has(Mode mode) const {
  return std::find(modes_.begin(), modes_.end(), mode) != modes_.end();
}

void Target::leave_out(Mode mode) {
  std::erase(modes_, mode);
}

std::vector<fs::path> Target::files() const {
  std::vector<fs::path> names;
  for (const output::WrittenFile& file : files_) names.push_back(file.file);
  return names;
}

fs::path Target::folder_of(Mode mode) const {
  return kind_ == TargetKind::movie ? scratch_ : out_ / name(mode);
}

/// Names of the files of this comparison.
std::set<std::string> Target::files_to_come(const setup::FrameRange& frames) const {
  std::set<std::string> files;
  for (const Mode mode : modes_) {
    if (mode == Mode::metrics) {
      files.insert({"metrics.csv", "metrics.png"});
      continue;
    }
    if (movie_.is_made)
      files.insert(output::movie_path("", name(mode), movie_.format).generic_string());
    for (int frame = frames.first; frame <= frames.last; ++frame)
      files.insert(output::frame_path("", name(mode), frame).generic_string());
  }
  return files;
}

/// Files of others in the place of those to come.
void Target::refuse_foreign(const record::FileHashes& made, const setup::FrameRange& frames) const {
  if (replaces_) return;
  std::set<std::string> listed;
  for (const auto& [name, hash] : made) listed.insert(name);
  const std::vector<std::string> files = record::foreign_files(out_, files_to_come(frames), listed);
  if (files.empty()) return;
  throw UsageError(
      "--out",
      fmt::format("{} has files that no neve compare there has made; it would replace {}",
                  out_.string(), record::files_text(files)),
      "add --replace, or choose another folder with --out");
}

/// A comparison that is made again loses nothing.
void Target::refuse_loss(const Json& earlier, record::FileHashes lost,
                         const setup::FrameRange& frames) const {
  if (replaces_) return;
  const bool is_of_others =
      earlier.is_object() && earlier.contains("a") &&
      !(is_same_run(earlier["a"], a_) && is_same_run(earlier.value("b", Json()), b_));
  const std::set<std::string> to_come = files_to_come(frames);
  if (!is_of_others)
    std::erase_if(lost, [&](const auto& file) { return to_come.contains(file.first); });
  const std::vector<std::string> gone = record::unchanged_files(out_, lost);
  if (gone.empty()) return;
  throw UsageError("--out",
                   fmt::format("{} has a comparison {}; it would replace {}", out_.string(),
                               is_of_others ? "of other runs" : "with other frames or modes",
                               record::files_text(gone)),
                   "add --replace, or choose another folder with --out");
}

void Target::begin(const setup::FrameRange& frames) {
  if (kind_ != TargetKind::folder) {
    output::make_folder(out_.parent_path());
    if (kind_ == TargetKind::movie) scratch_ = output::temporary_name(out_);
    output::make_folder(scratch_);
    return;
  }
  output::make_folder(out_);
  lock_.emplace(out_, "neve compare");
  const Json earlier = record::read_json(output::comparison_list_path(out_));
  const record::FileHashes made = record::files_made(out_, earlier);
  refuse_loss(earlier, made, frames);
  refuse_foreign(made, frames);
  record::remove_listed(out_, made);
  // If this one is killed, the next one knows which files were to be its own.
  write_list(false, files_to_come(frames));
  for (const Mode mode : modes_)
    if (mode != Mode::metrics) output::make_own_folder(folder_of(mode));
}

void Target::add(Mode mode, int frame, const render::Image& image, const render::PngText& text) {
  if (!first_) first_ = frame;
  last_ = frame;
  fs::path file = out_;
  if (kind_ == TargetKind::folder) file = output::frame_path(out_, name(mode), frame);
  if (kind_ == TargetKind::movie) file = output::frame_path(scratch_, ".", frame);
  const output::WrittenFile written = output::write_hashed(file, render::encode_png(image, text));
  if (kind_ != TargetKind::movie) files_.push_back(written);
}

std::vector<std::string> Target::add_movies(const scene::Scene& scene) {
  std::vector<std::string> warnings;
  // One picture is no movie, unless it was asked for.
  const bool has_movie =
      kind_ == TargetKind::movie || (kind_ == TargetKind::folder && movie_.is_made);
  if (!has_movie || !first_ || (first_ == last_ && kind_ == TargetKind::folder)) return warnings;
  for (const Mode mode : modes_) {
    if (mode == Mode::metrics) continue;
    const fs::path file =
        kind_ == TargetKind::movie ? out_ : output::movie_path(out_, name(mode), movie_.format);
    const output::MovieResult movie =
        output::write_movie({folder_of(mode), file, *first_, last_, scene.fps, false, 0, movie_,
                             scene::time_code_of_movie(scene, *first_, movie_.fps)});
    if (movie.outcome == output::MovieOutcome::written) {
      files_.push_back({file, output::hash_file(file)});
      continue;
    }
    const bool has_none = movie.outcome == output::MovieOutcome::no_ffmpeg;
    const std::string why = has_none ? "ffmpeg is not installed" : movie.reason;
    if (kind_ == TargetKind::movie || movie.outcome == output::MovieOutcome::unwritable)
      throw IoError("no movie " + file.string() + ": " + why, file.string(),
                    "name a folder with --out for the pictures");
    warnings.push_back("no movie " + file.string() + ": " + why);
    if (has_none) break;
  }
  return warnings;
}

void Target::add_metrics(const std::string& csv, const std::optional<render::Image>& picture,
                         const render::PngText& text) {
  if (kind_ == TargetKind::table || kind_ == TargetKind::folder) {
    const fs::path file = kind_ == TargetKind::table ? out_ : out_ / "metrics.csv";
    files_.push_back(output::write_hashed(file, csv));
  }
  if (!picture || kind_ == TargetKind::table) return;
  const fs::path file = kind_ == TargetKind::picture ? out_ : out_ / "metrics.png";
  files_.push_back(output::write_hashed(file, render::encode_png(*picture, text)));
}

void Target::finish(bool is_whole) {
  if (kind_ == TargetKind::folder) write_list(is_whole, {});
}

void Target::write_list(bool is_whole, const std::set<std::string>& begun) const {
  record::FileHashes hashes;
  for (const output::WrittenFile& file : files_)
    hashes[file.file.lexically_relative(out_).generic_string()] = record::hash_text(file.hash);
  Json list{{"version", version}, {"a", a_}, {"b", b_}, {"is_whole", is_whole}, {"files", hashes}};
  if (!begun.empty()) list["begun"] = begun;
  output::write_file(output::comparison_list_path(out_), record::with_own_hash(list));
}

}  // namespace neve::app::compare
