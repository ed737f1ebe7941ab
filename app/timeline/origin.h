#pragma once
/// The beginning of a command: a scene, a picture, or the folder of a run.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/forecast/fast.h"
#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/scene/scene.h"
#include "app/setup/plan.h"
#include "app/support/progress.h"
#include "app/timeline/agreement.h"
#include "app/timeline/timeline.h"

namespace neve::app::timeline {

/// Edits of the command line to a scene.
struct Edits {
  std::vector<std::string> overrides;
  std::optional<double> coarsening{};
  bool is_fast = false;             ///< with the settings of forecast::fast_look
  std::optional<int> last_frame{};  ///< number of it that is wanted, for that look
  Agreement agreement =
      Agreement::asked;        ///< to the cost and the files of a picture that came alone
  bool is_start_only = false;  ///< a picture's frame is not made, its scene is looked at
  bool takes_cards = false;    ///< pictures of cards, whose scene is a stand-in
  bool continues_run = false;  ///< all frames that a run is to have are wanted
  double coarsened = 1;        ///< a scene file was coarsened by that before
};

struct Origin {
  scene::Scene scene;      ///< of the start; cameras and ranges of a scene file not yet resolved
  std::string scene_file;  ///< as named by the user: a scene, a picture or a folder
  std::vector<std::string> overrides;      ///< for the caption; those of a picture come first
  std::optional<forecast::FastLook> fast;  ///< of Edits::is_fast; overrides has its settings
  std::vector<scene::LiveChange> changes;  ///< made while the run ran
  double coarsening = 1;                   ///< done to the scene, a picture's included
  std::optional<scene::Scene> finer;       ///< the scene before --coarsen of the edits
  int first = 0;             ///< frame of its own: those before a fork are of the run that it left
  setup::FrameRange frames;  ///< that it shows, counted from 0: of a picture one
  std::optional<record::PictureRecord> picture;  ///< the origin is this picture
  std::filesystem::path run;                     ///< the origin is the run in this folder
  Json prediction;  ///< of that run, for full resolution; null: it has none
  Json forked;      ///< where that run left another one; null: nowhere
  std::vector<record::FrameRecord> run_frames;  ///< that the run lists, counted from 0

  /// @param named  a scene file, a picture made by neve, the folder of a run; empty: the default
  /// @throws SceneError, UsageError, IoError, Error
  static Origin of(const std::string& named, const Edits& edits);

  /// "snowball_drop" for scenes/snowball_drop.toml and out/snowball_drop.
  std::string name() const;
  /// The last one that it has pictures of, or that is in its scene.
  int last_frame() const;
};

/// A moment of --at lies in the film: nothing is simulated on behind its back.
/// @param flag  with the time: "--at" @throws UsageError for a time after the last frame
void require_before_end(const char* flag, double time, const Origin& origin);

/// Warns where --frames continues after the last frame, which is simulated.
/// @param time  of its last
void warn_of_late_frame(double time, const Origin& origin, Progress& progress);

/// True for the path of a folder that exists.
bool is_folder(const std::string& path);

/// Makes a moment the folder of a run, for Origin::of: run.json with the scene and the changes so
/// far, and one checkpoint. Checkpoints that the folder had are removed. @throws IoError
void write_origin(const std::filesystem::path& folder, record::RunRecord run, Moment moment);

/// The run of an origin, with the moments that are kept of it, and its snow in a simulation.
/// @throws IoError, sim::ShapeError
Timeline open(const Origin& origin, int threads, Progress& progress);
/// The same with its snow at hand.
Timeline open(const Origin& origin, std::shared_ptr<const setup::SeededScene> seeded, int threads,
              Progress& progress);

/// Why a state is another one than a run or a picture has.
inline constexpr const char* other_bits =
    ": its bits came from another version or other instructions, or files that the scene names "
    "have "
    "changed";

/// The warning that the picture of an origin shows another state at a time, s; "" where it shows no
/// state of that time, and of an origin that was changed since.
std::string difference_from_picture(const Origin& origin, double time, std::uint64_t hash);

/// Warns where the run of an origin lists a frame with another state than the same frame made now.
void compare_with_run(const Origin& origin, int frame, std::uint64_t hash, Progress& progress);

}  // namespace neve::app::timeline
