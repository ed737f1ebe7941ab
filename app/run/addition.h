#pragma once
/// Pictures that are added to a run: a second command draws into a folder, and nothing that is
/// there goes without a word.

#include <optional>
#include <string>
#include <vector>

#include "app/record/verify.h"
#include "app/run/render_job.h"

namespace neve::app::run {

/// The run of a folder, as its run.json lists it.
struct EarlierRun {
  Json json;
  record::Pictures pictures;
  scene::Scene scene;
  bool has_same_numbers = true;  ///< of frames, as the command
  bool is_same = false;          ///< simulation and numbers as those of the command

  bool has(const std::string& view) const;
  /// Returns the frames of a view in this run: all that are listed, or the part given for the view.
  record::ViewFrames frames_of(const std::string& view) const;
};

/// Reads the earlier run of the folder; nothing without a run.json with pictures, exports or
/// movies, or if it cannot be read.
/// @param ours  record of the command, with its simulation
std::optional<EarlierRun> earlier_run(const RenderJob& job, const record::RunRecord& ours);

/// Views of the command whose files differ from those that the folder has.
std::vector<std::string> other_drawings(const EarlierRun& earlier, const record::RunRecord& ours);

/// Movies of a view among files of a run, by their names.
std::vector<std::string> movies_of(const std::string& view, const record::FileHashes& files);

/// Names all that the pictures of a view depend on but the states of its run: neither other views
/// nor whether the scene or the view has its size, camera and background.
/// @param picture  of any view and frame
std::string drawing_of(const RenderJob& job, record::PictureRecord picture,
                       const std::string& view);

/// @throws UsageError for the folder of a sweep, whose runs have folders of their own
void refuse_sweep_folder(const RenderJob& job);

/// Checks a folder of which earlier_run() knows no run. @throws UsageError where its run.json is
/// not the list of one that has made nothing, unless the options replace it
void refuse_unreadable_run(const RenderJob& job);

/// @throws UsageError where files lie in the place of pictures, movies and exports of the command
/// in a folder without a run, unless the options replace them
void refuse_foreign_files(const RenderJob& job, const record::RunRecord& ours);

/// @throws UsageError that says what the command would replace, unless the options replace it, and
/// for the folder of another scene
void refuse_loss(const RenderJob& job, const EarlierRun& earlier, const record::RunRecord& ours,
                 const record::PictureRecord& picture);

/// Exports of the command are those that the folder has already, or it has none.
bool are_exports_kept(const RenderJob& job, const EarlierRun& earlier);

/// Notes the views of an earlier part of the run with the frames that they have, and all else that
/// its run.json says and this command does not.
void keep_views(const RenderJob& job, const EarlierRun& earlier, record::RunRecord& ours);

/// Makes the record of a command one of the earlier run with more pictures. Views that are drawn as
/// before keep their pictures, unless the options replace them; views that are drawn otherwise lose
/// theirs. @return files of the earlier run that are to be removed
record::FileHashes add_to_run(const RenderJob& job, const EarlierRun& earlier,
                              record::RunRecord& ours);

/// Frames to draw, counted from 0: those of the job, and those between them and what exists, so
/// that no view has a gap.
setup::FrameRange frames_without_gaps(const RenderJob& job, const record::RunRecord& ours);

}  // namespace neve::app::run
