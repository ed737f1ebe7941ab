#pragma once
/// run.json: the record of a run so far, in names that scripts depend on.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/output/report_json.h"
#include "app/record/bodies.h"
#include "app/record/metrics.h"
#include "app/scene/live_change.h"
#include "app/scene/scene.h"
#include "app/support/json.h"
#include "sim/checks/watch.h"
#include "sim/retry.h"
#include "sim/simulation.h"

namespace neve::app::record {

enum class RunStatus { running, ok, diverged, interrupted, failed };
const char* name(RunStatus status);

/// Snow presses on a collider: force and torque are means since the frame before.
struct ColliderForce {
  std::string collider;
  sim::Vec3d force{0, 0, 0};   ///< N
  sim::Vec3d torque{0, 0, 0};  ///< N m, about the point of the collider's shape
  double max_pressure = 0;     ///< Pa, at the end, see sim::Summary
};

struct FrameRecord {
  int frame = 0;
  double time = 0;  ///< s, frame / fps
  sim::AdvanceReport advance;
  double seconds_sim = 0, seconds_render = 0;
  sim::Summary summary;
  std::uint64_t state_hash = 0;
  Metrics metrics;
  std::vector<ColliderForce> forces;  ///< of all colliders; empty where there was no step
  std::vector<BodyRecord> bodies;     ///< at the end, those that move by themselves
};

/// The greatest that happened in a run, over all of its frames: also those that were not drawn.
struct Extremes {
  int frame = 0;     ///< number of the last frame that they know
  double steps = 0;  ///< in all
  double max_speed = 0, max_force = 0, max_pressure = 0;  ///< m/s, N, Pa
  std::optional<double> max_body_speed{};                 ///< m/s

  /// The frame after the last one.
  void add(const FrameRecord& frame);
};

/// The state that a run is measured from, where its frames begin later.
struct RunStart {
  Metrics metrics;  ///< without max_depth_cells
  std::vector<BodyRecord> bodies;
  /// The extremes of the frames before the first one that the run lists; absent if not known.
  std::optional<Extremes> before{};
};

/// True if any snow is left at the end of a frame: metrics of none are no numbers.
inline bool has_snow(const FrameRecord& frame) {
  return frame.metrics.particles > 0;
}

/// Steps of the frame times its particles.
double particle_steps(const FrameRecord& frame);

Json to_json(const ColliderForce& force);

/// Divides the impulses of a frame by its time.
/// @param summary  of the frame's end @param colliders  of the scene
std::vector<ColliderForce> forces_of(const sim::AdvanceReport& advance, const sim::Summary& summary,
                                     const std::vector<scene::Collider>& colliders);

/// Files of a run, by their path in its folder, with the hash of their bytes as hash_text.
using FileHashes = std::map<std::string, std::string>;

/// Numbers of the frames that a view has pictures of, without gaps.
struct ViewFrames {
  int first = 0, last = -1;

  bool has(int number) const { return number >= first && number <= last; }
  int count() const { return last - first + 1; }
};

/// A view, or a mosaic, of a run: several commands may have drawn views of one simulation.
struct ViewRecord {
  std::string drawing;               ///< hash of all that its pictures depend on but the states
  std::optional<ViewFrames> frames;  ///< absent: all frames of the run
  bool has_passes = false;
};

struct RunRecord {
  std::string scene;    ///< resolved, TOML
  std::string undrawn;  ///< views and mosaics that it does not draw, of scene::write_undrawn
  std::string scene_file;
  std::vector<std::string> overrides;
  std::vector<scene::LiveChange> changes;  ///< made while it ran
  double coarsening = 1;                   ///< factor of --coarsen
  Json prediction;  ///< of --predict, for full resolution, as predict::to_json; null without
  Json forked;      ///< where it left another run; null: nowhere
  std::optional<ViewFrames> asked;  ///< numbers of the frames that are to be drawn
  std::optional<RunStart> start;    ///< where frame 0 is not among the frames
  std::string simulation;           ///< hash of all that the bits of its states depend on
  std::map<std::string, std::string>
      scene_files{};                               ///< that the scene names, with the hash of each
  std::vector<std::string> views;                  ///< that this command draws
  std::vector<std::string> earlier_views;          ///< that the folder had before, in their order
  std::map<std::string, ViewRecord> view_records;  ///< of both, by name
  std::vector<std::string> passes;                 ///< of --passes
  std::vector<std::string> views_of_passes;        ///< of `views`, that have them: all but mosaics
  Json exports;  ///< of [[export]], see app/exports/exporter.h; null without
  std::string backend, gl_renderer;
  int threads = 0;
  std::string simd;
  RunStatus status = RunStatus::running;
  std::string error;  ///< of a run that failed
  std::vector<FrameRecord> frames;
  int first_number = 0;                    ///< of the frame at time 0
  std::optional<sim::Vec3d> world_offset;  ///< m, taken out of files with coordinates of a map
  std::optional<int> slate;       ///< number of the pictures of words before the first frame
  int frames_from_states = 0;     ///< drawn from kept states, without a step
  Json states;                    ///< that are kept: their frames, bytes and budget; null without
  std::string carried_status;     ///< in the place of `status`, of a run that got further before
  Json carried = Json::object();  ///< entries of an earlier run.json, where this run has none
  FileHashes files;  ///< pictures and movies; a picture that is just being written is not in it yet
  FileHashes movies;  ///< quality and speed of those in `files`, as text
  std::map<std::string, ViewFrames> movie_frames{};  ///< numbers of the pictures that they show
  std::vector<std::string> warnings;                 ///< of the start and of the steps so far
  std::vector<std::string> step_warnings;  ///< those of `warnings` that the steps so far gave
  /// Says that a frame took much longer than the first. No warning: the load of the machine must
  /// not change a run.
  std::optional<std::string> slowdown;
  std::vector<sim::checks::WatchRecord> validation;  ///< of --validate; empty without it
  std::vector<sim::Retry> retries;                   ///< times that it went back
  std::optional<sim::Divergence> divergence;
  std::string cause;  ///< of the divergence, see diagnosis.h
};

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);
/// The same of a text.
std::string hash_of(const std::string& text);

Json to_json(const FrameRecord& frame);
Json to_json(const sim::DustTotals& dust);
/// Reads the output of to_json; the rest of advance and summary has its defaults.
/// @throws nlohmann::json::exception
FrameRecord frame_record(const Json& json);

/// The start that a run has, or its first frame where that is frame 0; nothing in a run of an
/// earlier version.
std::optional<RunStart> start_of(const Json& run);

/// Adds a frame in the order of frames, or in the place of an earlier record of the same frame.
void add_frame(std::vector<FrameRecord>& frames, const FrameRecord& frame);

/// "particles/0003.png"
std::string picture_name(const std::string& view, int frame);
/// "particles/0003.exr"
std::string channels_name(const std::string& view, int frame);

/// Reads a file; null if it does not exist or cannot be read.
Json read_json(const std::filesystem::path& file);

/// DIR/run.json; null if there is no such file or it cannot be read.
Json read_run_json(const std::filesystem::path& folder);

/// The frames that it lists; none if they cannot be read.
std::vector<FrameRecord> frame_records(const Json& run);

/// The frames that are to be drawn; absent in runs of earlier versions.
std::optional<ViewFrames> frames_asked(const Json& run);

/// The files that it lists; none if they cannot be read.
FileHashes file_hashes(const Json& run);

/// JSON as text, with a last entry `hash`, the hash of the rest.
std::string with_own_hash(const Json& json);

/// True if a file is as with_own_hash() wrote it: run.json, export.json, the manifest of a sweep,
/// the status of a run. Files of earlier versions have no hash and pass.
bool is_untouched(Json run);

/// The frames that DIR/run.json lists.
std::vector<FrameRecord> read_frame_records(const std::filesystem::path& folder);

Json to_json(const RunRecord& run);

/// The frames of a view: its own, or all of the run's. @throws std::out_of_range where the run has
/// none of the name
ViewFrames frames_of(const RunRecord& run, const std::string& view);

/// Movies that do not show all pictures of their view, by their files, with the numbers of those
/// that they show: a command without movies has drawn others.
std::map<std::string, ViewFrames> short_movies(const RunRecord& run);
/// The same, of a run.json.
std::map<std::string, ViewFrames> short_movies(const Json& run);
/// " shows frames 0 to 3, and its view has others; a command that ... makes it whole"
std::string short_movie_text(const ViewFrames& shown);

/// @throws IoError
void write_run_json(const std::filesystem::path& folder, const RunRecord& run);

Json to_json(const Extremes& extremes);
/// @throws nlohmann::json::exception
Extremes extremes_of(const Json& json);

/// Returns the extremes of a run from its start to a frame, or to its last one if it has fewer.
/// Returns nothing if its frames begin later and it does not know what was before.
std::optional<Extremes> extremes_until(const Json& run, int last);
/// The same to the last one, of a run whose frames and start are read already.
std::optional<Extremes> extremes_of_run(const Json& run, const std::vector<FrameRecord>& frames,
                                        const std::optional<RunStart>& start,
                                        int last = std::numeric_limits<int>::max());

}  // namespace neve::app::record
