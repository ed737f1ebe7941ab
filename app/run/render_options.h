#pragma once
/// Command line options of a run.

#include <optional>
#include <string>
#include <vector>

#include "app/options/option.h"
#include "app/output/movie_format.h"
#include "app/setup/caps.h"
#include "app/setup/plan.h"
#include "app/support/progress.h"

namespace neve::app::run {

struct RenderOptions {
  std::string scene;  ///< a scene file or a picture; empty: the default scene
  std::vector<std::string> overrides;
  std::optional<double> coarsening;
  std::optional<double> coarsened;  ///< what the scene file was by before
  bool is_fast = false;             ///< with the settings of forecast::fast_look
  bool predicts = false;            ///< the run at full resolution, by further copies
  std::optional<double> from;  ///< s: a fork of the scene's run there, the overrides are changes
  std::optional<setup::FrameRange> frames;
  std::vector<std::string> views;
  std::optional<scene::PictureSize> size;
  std::string out;
  int threads = 0;  ///< 0: one per core
  setup::CapTexts caps;
  std::string backend = "auto";
  std::optional<setup::Quality> quality;
  std::string lut;                  ///< a .cube file; empty: none
  std::string plate;                ///< see plate.h; empty: none
  std::optional<double> shutter;    ///< degrees; absent: by quality
  std::vector<std::string> passes;  ///< see passes.h
  std::string reference;
  double reference_threshold = 0.5;  ///< of the mean difference, 0 to 255
  /// Threshold for the mean over any 8x8 block: a small local change hardly affects the mean of the
  /// picture. Rounding of other drivers stays far below it.
  double reference_local_threshold = 8;
  std::string open_edges;  ///< file of the picture of neve check; empty: none
  std::string shader_dir;
  bool validate = false;
  bool resume = false;
  int checkpoint_every = 10;                    ///< frames; 0: none
  bool keeps_states = true;                     ///< of drawn frames, in DIR/states
  bool keeps_all_states = false;                ///< whatever they take
  double states_budget = 1024.0 * 1024 * 1024;  ///< bytes
  bool replaces = false;                        ///< pictures and films that are in the folder
  bool has_movies = true;
  output::MovieStyle movie;
  bool has_caption = true;
  Verbosity verbosity = Verbosity::normal;
  ProgressOptions progress;
  bool is_agreed = false;      ///< to what a picture that came alone costs and reads
  bool is_start_only = false;  ///< of a picture its scene counts, its frame is not made
  bool dry_run = false;
  bool is_json = false;
};

/// neve render
void describe(options::Command& visit, RenderOptions& options);

/// The help on SCENE in commands that look at a run.
inline constexpr const char* origin_help =
    "Scene file (TOML), - for standard input, a picture made by neve, or the folder of a run; "
    "default: a falling snowball";

/// --yes, where describe_scene() is not called
void describe_agreement(options::Command& visit, bool& is_agreed);

/// The scene and its changes, for all commands that simulate one. @param help  of SCENE
void describe_scene(options::Command& visit, RenderOptions& options,
                    const char* help =
                        "Scene file (TOML), - for standard input, a picture made by neve, to make "
                        "that frame and view again, or the folder of a run, to draw it otherwise; "
                        "default: a falling snowball");

}  // namespace neve::app::run
