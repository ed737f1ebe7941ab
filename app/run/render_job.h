#pragma once
/// Job of `neve render`, assembled from the scene, the flags, or a picture.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/run/render_options.h"
#include "app/scene/override.h"
#include "app/timeline/origin.h"
#include "app/timeline/timeline.h"

namespace neve::app::run {

/// Another way of a run from a time on, see fork.h.
struct Fork {
  double time = 0;  ///< s
  std::vector<scene::Override> changes;
  std::vector<std::string> notes{};  ///< what a preset among them would set and cannot
  record::RunStart start{};          ///< of the run that begins there, when it is reached
};

/// An origin, with the chosen views and sizes, and what is made of it.
struct RenderJob : timeline::Origin {
  RenderOptions options{};  ///< that it was made from
  std::filesystem::path folder{};
  setup::Quality quality = setup::Quality::preview;
  std::vector<std::string> only_tiles{};  ///< views drawn in a mosaic and not by themselves
  std::string plate{};                    ///< picture behind, see plate.h; empty: none
  std::string lut{};                      ///< look of the pictures, a .cube file; empty: none
  double shutter = 0;                     ///< degrees of motion blur; 0: none
  std::vector<std::string> passes{};      ///< of --passes, see passes.h; none: only PNGs
  std::vector<std::string> warnings{};    ///< of the start, for run.json
  /// The lines of --predict, of the picture, or of the run, for captions.
  std::vector<std::string> prediction_lines{};
  std::optional<Fork> fork{};

  /// True where the folder is that of the run that is drawn, by whatever name.
  bool is_drawn_in_place() const;
  /// False for a view that is drawn in a mosaic only.
  bool draws_alone(const scene::View& view) const;
  /// Returns the lines in the captions of its mosaics, see setup::layout_of; 0 without a caption.
  int caption_lines() const;
  bool has_movies() const { return options.has_movies && options.movie.is_made; }
};

/// Finds a mosaic by its name; null if the scene has none of it.
const scene::Mosaic* find_mosaic(const scene::Scene& scene, const std::string& name);

/// @throws SceneError, UsageError, IoError, Error
RenderJob make_job(const RenderOptions& options);

/// The record of all pictures of a job, without their frame, view and state.
/// @param scene  resolved, TOML @param simd  of the simulation
record::PictureRecord picture_record(const RenderJob& job, const std::string& scene,
                                     const std::string& simd);

/// The record of the run of a job with a resolved scene, as it begins.
record::RunRecord run_record(const RenderJob& job, const sim::Simulation& simulation);

/// Returns the start as a picture of frame 0 would record it; makes it if no run.json knows it.
/// @param before  run.json of this run; null: there is none
/// @param last    number of the frame before those of this run
record::RunStart start_of_run(const timeline::Timeline& timeline, const Json& before, int last);
/// The same of a run that leaves the run of a job, or draws it elsewhere. Nothing is known of the
/// frames before where that one begins later: what it knows is greatest may have come after them.
/// @param last  number of the frame of the fork, or of the frame before those of this run
record::RunStart start_beside(const timeline::Timeline& timeline, const RenderJob& job, int last);

/// The bodies of the frame that a timeline is at: their rotations have no jumps from frame to
/// frame.
std::vector<record::BodyRecord> bodies_here(const timeline::Timeline& timeline);

/// Adds the frame that a timeline is at, which is passed on the way to those that are drawn: what
/// was greatest in it counts. It is passed over where it is not the next one that they know.
void add_passed(const timeline::Timeline& timeline, record::Extremes& extremes);

}  // namespace neve::app::run
