#pragma once
/// Job of `neve render`, assembled from the scene, the flags, or a picture.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/forecast/fast.h"
#include "app/run/changes.h"
#include "app/run/past_run.h"
#include "app/run/render_options.h"
#include "app/scene/scene.h"

namespace neve::app::run {

/// Another way of a run from a time on, see fork.h.
struct Fork {
  double time = 0;  ///< s
  PastRun past;     ///< that may have checkpoints
  std::vector<scene::Override> changes;
};

struct RenderJob {
  scene::Scene scene;      ///< with the chosen views and sizes; cameras and ranges not yet resolved
  std::string scene_file;  ///< as named by the user
  std::filesystem::path folder;
  setup::FrameRange frames;
  setup::Quality quality = setup::Quality::preview;
  std::vector<std::string> overrides;      ///< for the caption; those of a picture come first
  std::optional<forecast::FastLook> fast;  ///< of --fast; its overrides are among those above
  std::vector<scene::LiveChange> changes;  ///< to be made while it runs, as they were in a picture
  std::vector<std::string> only_tiles;  ///< views that are drawn in a mosaic and not by themselves
  std::string plate;                    ///< picture behind, see plate.h; empty: none
  double shutter = 0;                   ///< degrees of motion blur; 0: none
  std::vector<std::string> passes;      ///< of --passes, see passes.h; none: only PNGs
  bool validate = false;                ///< with the checks of sim/checks/watch.h
  bool resume = false;                  ///< from the checkpoint in the folder
  int checkpoint_every = 10;            ///< frames; 0: none
  bool keeps_states = false;            ///< of drawn frames, see kept_states.h
  bool has_movies = true;
  output::MovieStyle movie{};
  std::vector<std::string> warnings;  ///< of the start, for run.json
  double coarsening = 1;              ///< done to the scene, a picture's included
  std::optional<Fork> fork{};
};

/// @throws SceneError, UsageError, IoError, Error
RenderJob make_job(const RenderOptions& options);

}  // namespace neve::app::run
