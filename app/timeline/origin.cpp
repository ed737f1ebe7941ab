#include "app/timeline/origin.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/record/picture_files.h"
#include "app/scene/coarsen.h"
#include "app/scene/flat.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/setup/curves.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/timeline/times.h"

namespace neve::app::timeline {

namespace {

namespace fs = std::filesystem;

/// Reads the scene with the edits, and with those of --fast where it was given.
/// @param read  scene(overrides)
template <class Read>
void read_scene(const Edits& edits, const Read& read, Origin& origin) {
  origin.overrides.insert(origin.overrides.end(), edits.overrides.begin(), edits.overrides.end());
  std::vector<scene::Override> changes = scene::parse_overrides(edits.overrides);
  origin.scene = read(changes);
  setup::refuse_followers(origin.scene, changes);
  if (edits.is_fast) {
    scene::Scene coarse = origin.scene;
    if (edits.coarsening) scene::coarsen(coarse, *edits.coarsening);
    const int last = edits.last_frame
                         ? std::max(0, scene::frame_of(origin.scene, *edits.last_frame))
                         : scene::last_frame(origin.scene);
    origin.fast = forecast::fast_look(coarse, last, scene::addresses_of(changes),
                                      edits.coarsening.value_or(1));
    for (const std::string& change : origin.fast->overrides) {
      changes.push_back(scene::parse_override(change));
      origin.overrides.push_back(change);
    }
    origin.scene = read(changes);
  }
  if (!edits.coarsening) return;
  origin.finer = origin.scene;
  for (std::string& change : scene::coarsen(origin.scene, *edits.coarsening))
    origin.overrides.push_back(std::move(change));
  origin.coarsening *= *edits.coarsening;
}

void read_scene_file(const Edits& edits, Origin& origin) {
  read_scene(
      edits,
      [&](const std::vector<scene::Override>& changes) {
        return scene::read_scene_file(origin.scene_file, changes);
      },
      origin);
  origin.frames = {0, scene::last_frame(origin.scene)};
}

/// Reads what a picture says of itself, with the present places of its scene's files. @throws Error
record::PictureRecord open_picture(const std::string& file, Agreement agreement) {
  record::PictureRecord record = record::read_picture_record(file);
  record::find_files(file, record, [&](const std::vector<std::string>& outside) {
    require_agreement(file, outside, agreement);
  });
  record::require_listed(record, scene::read_scene_text(record.scene, file + " (its scene)"), file);
  return record;
}

/// The frame and the scene inside a picture.
void read_picture(const Edits& edits, Origin& origin) {
  record::PictureRecord record = open_picture(origin.scene_file, edits.agreement);
  if (!record.cards.empty() && !edits.takes_cards)
    throw UsageError(origin.scene_file,
                     "is a card of " + joined(record.cards, ", ") + ", not a picture of a run",
                     "neve card " + shell_path(origin.scene_file) + " makes it again");
  if (edits.coarsened > 1)
    throw UsageError("--coarsened", "a picture knows whether its scene was coarsened",
                     "give the scene file, or remove it");
  origin.overrides = record.overrides;
  origin.changes = record.changes;
  origin.coarsening = record.coarsening;
  // The frame is by the numbers that the picture has, whatever the edits say.
  const int frame = scene::frame_of(
      scene::read_scene_text(record.scene, origin.scene_file + " (its scene)"), record.frame);
  if (frame < 0)
    throw Error(exit_invalid_scene,
                origin.scene_file + ": error: not a picture made by neve: its frame " +
                    std::to_string(record.frame) + " is before the first of its scene",
                origin.scene_file, "name a picture that neve render wrote");
  origin.frames = {frame, frame};
  read_scene(
      edits,
      [&](const std::vector<scene::Override>& changes) {
        const std::string name = origin.scene_file + " (its scene)";
        scene::Scene again = scene::read_scene_text(record.scene, name, {}, changes);
        scene::place_in_world(again, name);
        setup::reopen(again, changes);
        return again;
      },
      origin);
  const int last = edits.is_start_only ? 0
                   : edits.last_frame  ? scene::frame_of(origin.scene, *edits.last_frame)
                   : record.strip
                       ? static_cast<int>(std::min(
                             1e9, std::ceil(record.strip->times.back() * origin.scene.fps)))
                       : frame;
  require_agreement(record, origin.scene_file, origin.scene, std::max(0, last), edits.agreement);
  origin.picture = std::move(record);
}

std::vector<scene::LiveChange> changes_of_run(const Json& run, const fs::path& file) {
  try {
    return scene::live_changes(run.value("changes", Json::array()));
  } catch (const std::runtime_error& error) {
    throw Error(exit_invalid_scene, file.string() + ": error: " + error.what(), file.string(),
                "neve verify says what else is damaged");
  }
}

/// The snow of a run is as it is; what draws it may change.
std::vector<scene::Override> drawing_changes(const Edits& edits) {
  std::vector<scene::Override> changes = scene::parse_overrides(edits.overrides);
  for (const scene::Override& change : changes)
    if (scene::concerns_simulation(change.address))
      throw UsageError("--set",
                       change.address +
                           " belongs to the simulation, and a run has the scene it was "
                           "made from",
                       "give the scene file instead of the folder to write another run; of a run, "
                       "views, camera, light and output can be set");
  return changes;
}

/// Requires the files that the scene names to be unchanged: states of a run would be mixed with
/// what others make. Those that are gone are missed where they are read.
/// @param before  their hashes when the run was made; none in runs of earlier builds
void require_same_files(const record::FileHashes& before, const Origin& origin) {
  if (before.empty()) return;
  record::FileHashes now;
  try {
    now = record::hash_files(origin.scene, origin.changes);
  } catch (const IoError&) {
    return;
  }
  for (const auto& [file, hash] : before)
    if (const auto found = now.find(file); found != now.end() && found->second != hash)
      throw Error(exit_invalid_scene,
                  file + ": error: has changed since the run in " + origin.run.string() +
                      " was made: its states belong to the old file",
                  file, "restore the old file, or render the scene file into another folder");
}

/// Returns the frames of a run that is continued: those asked for, or once it has them the scene's.
/// @param before  the scene with the numbers that the run has
setup::FrameRange frames_to_make(const Json& run, const scene::Scene& before,
                                 const Origin& origin) {
  const int end = std::max(origin.first, scene::last_frame(origin.scene));
  const std::optional<record::ViewFrames> asked = record::frames_asked(run);
  if (!asked) return {origin.first, end};
  const int first = std::max(0, scene::frame_of(before, asked->first)),
            last = std::max(first, scene::frame_of(before, asked->last));
  const bool has_them = !origin.run_frames.empty() && origin.run_frames.back().frame >= last;
  return {first, has_them ? std::max(last, end) : last};
}

/// The frames of a run that the edits ask for: a length that is set counts as --frames does.
setup::FrameRange frames_to_draw(const Edits& edits, const std::vector<scene::Override>& changes,
                                 const Json& run, const scene::Scene& before,
                                 const Origin& origin) {
  if (scene::sets(changes, "frames"))
    return {origin.first, std::max(origin.first, scene::last_frame(origin.scene))};
  if (!origin.run_frames.empty() && !edits.continues_run)
    return {origin.run_frames.front().frame, origin.run_frames.back().frame};
  return frames_to_make(run, before, origin);
}

void read_run(const Edits& edits, Origin& origin) {
  if (edits.coarsening || edits.is_fast || edits.coarsened > 1)
    throw UsageError(edits.coarsening ? "--coarsen"
                     : edits.is_fast  ? "--fast"
                                      : "--coarsened",
                     "a run has the scene it was made from",
                     "give the scene file instead of the folder to write another run");
  const std::vector<scene::Override> changes = drawing_changes(edits);
  origin.run = origin.scene_file;
  const fs::path file = output::run_json_path(origin.run);
  try {
    const Json run = output::read_json(file);
    const auto text = run.at("scene").get<std::string>();
    const std::string place = file.string() + " (its scene)";
    const auto undrawn = run.value("undrawn", std::string());
    origin.scene = scene::read_with_undrawn(text, undrawn, place, changes);
    setup::reopen(origin.scene, changes);
    origin.changes = changes_of_run(run, file);
    origin.overrides = run.value("overrides", std::vector<std::string>{});
    origin.overrides.insert(origin.overrides.end(), edits.overrides.begin(), edits.overrides.end());
    origin.coarsening = run.value("coarsen", 1.0);
    origin.prediction = run.value("prediction", Json());
    origin.run_frames = record::frame_records(run);
    // Frames are by the numbers that the run has, whatever the edits say.
    const scene::Scene before = scene::read_scene_text(text, place);
    for (record::FrameRecord& made : origin.run_frames)
      made.frame = scene::frame_of(before, made.frame);
    if (!origin.run_frames.empty() && origin.run_frames.front().frame < 0)
      throw Error(
          exit_invalid_scene,
          fmt::format("{}: error: its frame {} is before the first of its scene, {}", file.string(),
                      scene::number_of(before, origin.run_frames.front().frame),
                      scene::number_of(before, 0)),
          file.string(), "render the scene file into another folder");
    require_same_files(run.value("scene_files", record::FileHashes{}), origin);
    if (Json forked = run.value("forked", Json()); forked.is_object()) {
      const int frame = scene::frame_of(before, whole_number<int>(forked.at("frame")));
      origin.first = frame + 1;
      forked["frame"] = scene::number_of(origin.scene, frame);
      origin.forked = std::move(forked);
    }
    origin.frames = frames_to_draw(edits, changes, run, before, origin);
  } catch (const nlohmann::json::exception&) {
    throw Error(exit_invalid_scene, file.string() + ": error: is not a run.json of neve",
                file.string());
  }
}

}  // namespace

bool is_folder(const std::string& path) {
  std::error_code error;
  return !path.empty() && fs::is_directory(path, error);
}

Origin Origin::of(const std::string& named, const Edits& edits) {
  Origin origin;
  origin.coarsening = edits.coarsened;
  origin.scene_file = named.empty() ? default_scene().string() : named;
  std::error_code error;
  if (is_folder(named) && fs::exists(output::run_json_path(named), error))
    read_run(edits, origin);
  else if (!named.empty() && record::is_picture(named))
    read_picture(edits, origin);
  else
    read_scene_file(edits, origin);
  setup::require_curve_values(origin.scene, origin.scene_file);
  return origin;
}

std::string Origin::name() const {
  const bool ends_in_slash = !fs::path(scene_file).has_filename();
  return scene::name_of_scene(ends_in_slash ? fs::path(scene_file).parent_path().string()
                                            : scene_file);
}

int Origin::last_frame() const {
  int last = scene::last_frame(scene);
  if (picture) last = std::max(last, frames.last);
  if (!run_frames.empty()) last = std::max(last, run_frames.back().frame);
  return last;
}

std::string advice_on_frame(double time, int last, const scene::Scene& scene) {
  const int first = scene::number_of(scene, 0);
  if (time != std::floor(time) || time < first || time > first + last) return {};
  return fmt::format("; frame {} is at {} s", time,
                     scene::toml::number_text((time - first) / scene.fps));
}

void require_before_end(const char* flag, double time, const Origin& origin) {
  const scene::Scene& scene = origin.scene;
  const int end = origin.last_frame();
  // Decimals round: 0.167 s means the fourth frame of 24 a second.
  if (is_not_after(time, (end + 0.5) / scene.fps)) return;
  const bool is_run = !origin.run.empty();
  std::string more;
  const int before = frame_at(time, scene.fps);
  const int wanted = is_not_after(time, before / scene.fps) ? before : before + 1;
  const std::string frame = advice_on_frame(time, end, scene);
  // A number that names a frame and lies far behind the end is none of seconds.
  const bool is_frame = !frame.empty() && wanted > 4 * end;
  if (!is_frame && wanted < 1'000'000)
    more = is_run ? fmt::format("; neve render {} --resume --frames {}-{} continues it",
                                shell_path(origin.run.string()), scene::number_of(scene, 0),
                                scene::number_of(scene, wanted))
                  : fmt::format("; --set frames={} makes it longer", wanted - 2 * scene.handles);
  throw UsageError(flag,
                   fmt::format("{} s is after the end of the {}, {} s (frame {})",
                               scene::toml::number_text(time), is_run ? "run" : "scene",
                               rough_text(end / scene.fps), scene::number_of(scene, end)),
                   "expected an earlier time" + frame + more);
}

void warn_of_late_frame(double time, const Origin& origin, Progress& progress) {
  const int frame = frame_at(time, origin.scene.fps), end = origin.last_frame();
  if (frame > end)
    progress.warning(
        fmt::format("frame {} is after the last frame, {}, and is simulated; Ctrl-C "
                    "stops",
                    scene::number_of(origin.scene, frame), scene::number_of(origin.scene, end)));
}

void write_origin(const fs::path& folder, record::RunRecord run, Moment moment) {
  run.status = record::RunStatus::ok;
  run.retries = moment.retries;
  const std::string identity = record::hash_of(run.scene + to_text(scene::to_json(run.changes)));
  output::make_folder(folder);
  output::remove_checkpoints(folder);
  output::write_checkpoint(folder, to_checkpoint(std::move(moment), identity, run.simd));
  record::write_run_json(folder, run);
}

Timeline open(const Origin& origin, int threads, Progress& progress) {
  std::shared_ptr<const setup::SeededScene> seeded;
  {
    const NothingToKeep reading;
    seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(origin.scene));
  }
  return open(origin, std::move(seeded), threads, progress);
}

Timeline open(const Origin& origin, std::shared_ptr<const setup::SeededScene> seeded, int threads,
              Progress& progress) {
  Moments moments;
  if (!origin.run.empty()) moments.add_run(origin.run);
  return Timeline(origin.scene, origin.changes, std::move(seeded), threads, std::move(moments),
                  watched_by(progress, origin.scene));
}

std::string difference_from_picture(const Origin& origin, double time, std::uint64_t hash) {
  const std::optional<record::PictureRecord>& picture = origin.picture;
  if (!picture || picture->state_hash.empty() || picture->state_hash == record::hash_text(hash) ||
      origin.overrides.size() != picture->overrides.size() ||
      origin.coarsening != picture->coarsening)
    return {};
  const double shown = picture->strip
                           ? picture->strip->times.back()
                           : scene::frame_of(origin.scene, picture->frame) / origin.scene.fps;
  if (time != shown) return {};
  const std::string what =
      picture->strip ? fixed_text(time, 3) + " s" : fmt::format("frame {}", picture->frame);
  return what + " has another state than " + origin.scene_file + " shows" + other_bits;
}

void compare_with_run(const Origin& origin, int frame, std::uint64_t hash, Progress& progress) {
  for (const record::FrameRecord& record : origin.run_frames)
    if (record.frame == frame && record.state_hash != hash)
      progress.warning("frame " + std::to_string(scene::number_of(origin.scene, frame)) +
                       " has another state than the run in " + origin.run.string() + other_bits);
}

}  // namespace neve::app::timeline
