#include "app/record/verify.h"

#include <algorithm>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/file_hash.h"
#include "app/output/sequence.h"
#include "app/record/picture_record.h"
#include "app/support/errors.h"
#include "app/support/room.h"
#include "app/support/text.h"
#include "render/image/exr.h"

namespace neve::app::record {

namespace {

namespace fs = std::filesystem;

constexpr const char *is_missing = "is missing", *is_empty = "is empty",
                     *is_another = "is not the file that the run wrote";

/// "" if the file has this hash.
std::string flaw_of(const fs::path& file, const std::string& hash) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) return is_missing;
  if (!fs::is_regular_file(status)) return "is not a regular file";
  if (fs::file_size(file, error) == 0 && !error) return is_empty;
  try {
    return hash_text(output::hash_file(file)) == hash ? "" : is_another;
  } catch (const IoError& failure) {
    return failure.what();
  }
}

/// Judges a picture that run.json has no hash of: one of an earlier version, or the last before a
/// kill.
std::string flaw_by_text(const fs::path& file, const std::string& view, const FrameRecord& frame) {
  if (const std::string flaw = flaw_of(file, ""); flaw != is_another) return flaw;
  try {
    if (file.extension() == ".exr")
      render::decode_exr(output::read_file(file), memory_room());
    else
      render::decode_png(output::read_file(file), memory_room());
    return is_picture_of(file, view, frame) ? "" : is_another;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const render::ImageSizeError&) {
    return "needs more memory than may be used, and is not checked";
  } catch (const std::exception&) {
    return "is damaged";
  }
}

std::string picture_flaw(const fs::path& folder, const Pictures& pictures, const std::string& view,
                         const std::string& name, const FrameRecord* frame) {
  if (!frame) return is_missing;
  const auto hash = pictures.files.find(name);
  return hash == pictures.files.end() ? flaw_by_text(folder / name, view, *frame)
                                      : flaw_of(folder / name, hash->second);
}

/// True for a name inside the folder of the run, whoever wrote the list.
bool is_inside(const fs::path& name) {
  return name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// A run draws every frame from its first to its last.
void check_gaps(const std::string& name, const std::vector<FrameRecord>& frames,
                std::vector<Flaw>& flaws) {
  for (std::size_t k = 1; k < frames.size(); ++k)
    if (const int expected = frames[k - 1].frame + 1; frames[k].frame != expected)
      flaws.push_back({name, "lists no frame " + std::to_string(expected)});
}

/// A file that is listed with its hash.
std::string listed_flaw(const fs::path& folder, const std::string& name, const std::string& hash) {
  return is_inside(name) ? flaw_of(folder / name, hash) : "is not in the folder of the run";
}

/// Movies, and the pictures of a divergence.
void check_other_files(const fs::path& folder, const Pictures& pictures, Verification& result) {
  std::set<std::string> checked;
  for_each_picture(pictures, [&](const std::string&, const std::string& name, const FrameRecord&) {
    checked.insert(name);
  });
  for (const auto& [name, hash] : pictures.files) {
    if (checked.contains(name)) continue;
    ++result.files;
    const std::string what = listed_flaw(folder, name, hash);
    if (!what.empty()) result.flaws.push_back({name, what});
  }
}

void check_export(const fs::path& folder, Verification& result) {
  const std::string below = std::string(output::exports_folder) + "/";
  const std::optional<Verification> exported =
      verify_list(output::export_list_path(folder / below), below);
  if (!exported) return;
  if (exported->status == name(RunStatus::interrupted))
    result.flaws.push_back({(fs::path(below) / output::export_list_path({}).filename()).string(),
                            "says that neve export was interrupted"});
  result.files += exported->files;
  result.flaws.insert(result.flaws.end(), exported->flaws.begin(), exported->flaws.end());
}

}  // namespace

bool is_picture_of(const fs::path& file, const std::string& view, const FrameRecord& frame) {
  try {
    const PictureRecord record = read_picture_record(file);
    return record.view == view && record.frame == frame.frame &&
           record.state_hash == hash_text(frame.state_hash);
  } catch (const Error&) {
    return false;
  }
}

std::optional<Pictures> listed_pictures(const Json& run) {
  Pictures pictures;
  try {
    for (const Json& frame : run.at("frames")) pictures.frames.push_back(frame_record(frame));
    pictures.views = run.at("views").get<std::vector<std::string>>();
    if (run.contains("views_of_passes"))
      pictures.views_of_passes = run["views_of_passes"].get<std::vector<std::string>>();
    if (run.contains("view_frames"))
      for (const auto& [view, range] : run["view_frames"].items())
        pictures.view_frames[view] = range.empty() ? ViewFrames{}
                                                   : ViewFrames{whole_number<int>(range.at(0)),
                                                                whole_number<int>(range.at(1))};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  for (const auto* names : {&pictures.views, &pictures.views_of_passes})
    if (!std::ranges::all_of(*names, output::is_plain_name)) return std::nullopt;
  pictures.files = file_hashes(run);
  return pictures;
}

void for_each_picture(const Pictures& pictures, const PictureVisitor& visit) {
  for (const FrameRecord& frame : pictures.frames) {
    for (const std::string& view : pictures.views)
      if (pictures.has(view, frame.frame)) visit(view, picture_name(view, frame.frame), frame);
    for (const std::string& view : pictures.views_of_passes)
      if (pictures.has(view, frame.frame)) visit(view, channels_name(view, frame.frame), frame);
  }
}

std::vector<Flaw> picture_flaws(const fs::path& folder, const Pictures& pictures, int first,
                                int last, std::vector<int>& flawed_frames) {
  std::map<int, const FrameRecord*> wanted;
  for (int frame = first; frame <= last; ++frame) wanted[frame] = nullptr;
  for (const FrameRecord& frame : pictures.frames) wanted[frame.frame] = &frame;
  std::vector<Flaw> flaws;
  for (const auto& entry : wanted) {
    const int number = entry.first;
    const FrameRecord* frame = entry.second;
    const std::size_t before = flaws.size();
    const auto check = [&](const std::string& view, const std::string& name) {
      if (!pictures.has(view, number)) return;
      if (const std::string what = picture_flaw(folder, pictures, view, name, frame); !what.empty())
        flaws.push_back({name, what});
    };
    for (const std::string& view : pictures.views) check(view, picture_name(view, number));
    for (const std::string& view : pictures.views_of_passes)
      check(view, channels_name(view, number));
    if (flaws.size() > before) flawed_frames.push_back(number);
  }
  return flaws;
}

std::vector<Flaw> export_flaws(const fs::path& folder, const Json& exports, const FileHashes& files,
                               int last, std::vector<int>& flawed_frames) {
  std::vector<Flaw> flaws;
  if (!exports.is_array()) return flaws;
  for (const Json& item : exports)
    for (const Json& file : item.at("files")) {
      const auto name = file.at("file").get<std::string>();
      const int number = whole_number<int>(file.at("number"));
      const auto hash = files.find(name);
      if (number > last || hash == files.end() || !is_inside(name)) continue;
      const std::string what = flaw_of(folder / name, hash->second);
      if (what.empty()) continue;
      flaws.push_back({name, what});
      flawed_frames.push_back(number);
    }
  return flaws;
}

Verification verify_run(const fs::path& folder) {
  Verification result;
  const std::string name = output::run_json_path({}).string();
  std::error_code error;
  if (!fs::exists(output::run_json_path(folder), error)) {
    result.flaws.push_back({name, is_missing});
    return result;
  }
  ++result.files;
  const Json run = read_run_json(folder);
  const std::optional<Pictures> pictures = listed_pictures(run);
  if (!pictures || !run.contains("status") || !run["status"].is_string()) {
    result.flaws.push_back({name, "is damaged"});
    return result;
  }
  if (!is_untouched(run)) result.flaws.push_back({name, is_another});
  result.status = run["status"].get<std::string>();
  if (!pictures->frames.empty()) result.last_frame = pictures->frames.back().frame;
  check_gaps(name, pictures->frames, result.flaws);
  for (const auto& [movie, shown] : short_movies(run))
    result.notes.push_back(movie + short_movie_text(shown));
  std::vector<int> flawed;
  for (Flaw& flaw : picture_flaws(folder, *pictures, 0, -1, flawed))
    result.flaws.push_back(std::move(flaw));
  for_each_picture(*pictures, [&](const std::string&, const std::string&, const FrameRecord&) {
    ++result.files;
  });
  check_other_files(folder, *pictures, result);
  check_export(folder, result);
  return result;
}

void verify_kept(const fs::path& folder, Verification& result) {
  const output::KeptFiles kept = output::check_kept(folder);
  result.files += kept.count;
  for (const auto& [name, what] : kept.damaged) result.flaws.push_back({name, what});
  if (!kept.has_states || result.status.empty() || result.status == name(RunStatus::running))
    return;
  try {
    const Json run = read_run_json(folder);
    if (!run.contains("states") || !run["states"].contains("frames")) return;
    const int first = run.value("first_number", 0);
    for (const Json& number : run["states"]["frames"]) {
      const int frame = whole_number<int>(number) - first;
      if (frame < 0 || frame > output::max_frame) continue;
      if (!std::ranges::binary_search(kept.states, frame))
        result.flaws.push_back({output::state_name(frame), is_missing});
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const IoError&) {
    throw;
  } catch (const std::exception&) {
    result.flaws.push_back({output::run_json_path({}).string(), "is damaged"});
  }
}

std::optional<Verification> verify_list(const fs::path& list, const std::string& below) {
  const fs::path folder = list.parent_path();
  const std::string name = below + list.filename().string();
  std::error_code error;
  if (!fs::exists(list, error)) return std::nullopt;
  Verification result;
  ++result.files;
  const Json json = read_json(list);
  // Lists of exports of earlier versions have no hashes, those of comparisons no word of their end.
  const bool has_files = json.is_object() && json.contains("files"),
             says_whole = json.is_object() && json.contains("is_whole");
  const bool is_list = (has_files || says_whole) && (!has_files || json["files"].is_object()) &&
                       (!says_whole || json["is_whole"].is_boolean());
  if (!is_list) {
    result.flaws.push_back({name, "is damaged"});
    return result;
  }
  if (!is_untouched(json)) result.flaws.push_back({name, is_another});
  result.status = !says_whole || json["is_whole"].get<bool>() ? "ok" : "interrupted";
  for (const auto& [file, hash] : file_hashes(json)) {
    ++result.files;
    if (const std::string what = listed_flaw(folder, file, hash); !what.empty())
      result.flaws.push_back({below + file, what});
  }
  return result;
}

std::string flaw_text(const std::vector<Flaw>& flaws) {
  std::vector<std::string> texts;
  for (const Flaw& flaw : flaws) texts.push_back(flaw.file + " " + flaw.what);
  return first_joined(std::move(texts));
}

}  // namespace neve::app::record
