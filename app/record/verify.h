#pragma once
/// Whether the folder of a run is complete: every file that the run lists exists and is unchanged.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/record/run_json.h"

namespace neve::app::record {

/// A file that is not as the run wrote it.
struct Flaw {
  std::string file;  ///< in the folder of the run
  std::string what;  ///< "is missing", "is empty", "is not the file that the run wrote"
};

/// Pictures of a run that can be checked, in the words of run.json.
struct Pictures {
  std::vector<std::string> views;
  std::vector<std::string> views_of_passes;
  std::vector<FrameRecord> frames;
  FileHashes files;
  std::map<std::string, ViewFrames> view_frames{};  ///< of views that have not all of them

  bool has(const std::string& view, int number) const {
    const auto found = view_frames.find(view);
    return found == view_frames.end() || found->second.has(number);
  }
};

/// Returns what run.json says of its pictures; nothing if something is wrong with it.
std::optional<Pictures> listed_pictures(const Json& run);

/// Visits every picture and every file of passes that the run is to have.
using PictureVisitor =
    std::function<void(const std::string& view, const std::string& name, const FrameRecord& frame)>;
void for_each_picture(const Pictures& pictures, const PictureVisitor& visit);

/// True for a picture that says of itself that it is this frame of a run.
bool is_picture_of(const std::filesystem::path& file, const std::string& view,
                   const FrameRecord& frame);

/// Frames from `first` to `last` with pictures that are missing or damaged, and other frames in
/// `pictures` that are. A picture without a hash is held to the state hash inside it.
std::vector<Flaw> picture_flaws(const std::filesystem::path& folder, const Pictures& pictures,
                                int first, int last, std::vector<int>& flawed_frames);

/// The same for the files of exports, up to a frame.
std::vector<Flaw> export_flaws(const std::filesystem::path& folder, const Json& exports,
                               const FileHashes& files, int last, std::vector<int>& flawed_frames);

struct Verification {
  std::string status;     ///< of run.json: "ok", "running"; "" if it cannot be read
  int last_frame = -1;    ///< that is listed; -1: none
  std::size_t files = 0;  ///< that were checked
  std::vector<Flaw> flaws;
  std::vector<std::string> notes{};  ///< of files that are as they were written, and not all
};

/// Reads run.json and all files that it lists, and those of `neve export` of this run.
Verification verify_run(const std::filesystem::path& folder);

/// Adds the kept states and the checkpoints of the run, by their own checksums, and states that
/// run.json lists and that are not in DIR/states. Nothing is said of a folder `states` that was
/// removed, of states that a run thinned out, and of those of a run that was killed or is under
/// way, whose list is of its start.
void verify_kept(const std::filesystem::path& folder, Verification& result);

/// Reads export.json or compare.json and all files that it lists; empty if there is no such list.
/// @param below  put in front of names: "exports/"
std::optional<Verification> verify_list(const std::filesystem::path& list,
                                        const std::string& below = "");

/// "particles/0003.png is missing, particles/0004.png is empty and 12 more"
std::string flaw_text(const std::vector<Flaw>& flaws);

}  // namespace neve::app::record
