#pragma once
/// A run as it is at one moment: the only shape of it, in memory, in DIR/checkpoint and in
/// DIR/states.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/output/checkpoint.h"
#include "app/picture/plots.h"
#include "app/record/run_json.h"
#include "app/scene/scene.h"
#include "sim/retry.h"
#include "sim/simulation.h"

namespace neve::app::timeline {

/// Files that a run has made until a moment: a damaged run.json loses none of them.
struct Made {
  std::vector<record::FrameRecord> frames;
  record::FileHashes files;
  Json exports = Json::array();  ///< as run.json lists them
  int first_number = 0;          ///< of frame 0, in these lists
};

struct Moment {
  int frame = 0;                   ///< the last one that was passed
  std::size_t steps = 0;           ///< since the start of the run
  std::size_t steps_of_frame = 0;  ///< that the run had at the end of that frame
  /// Steps of the frame that ends here; between two frames, those since the last one.
  sim::AdvanceReport advance;
  std::vector<picture::PlotSample> history;  ///< of frames 0 to this one
  std::vector<sim::Retry> retries;           ///< so far
  /// The scene with the changes so far. Null in a moment that was read: its run knows the changes.
  std::shared_ptr<const scene::Scene> scene{};
  std::vector<std::uint8_t> state{};  ///< sim::Simulation::save
  Made made{};
  std::filesystem::path file{};  ///< that it was read from; empty: it is of this process

  bool is_frame_end() const { return steps == steps_of_frame; }
  /// s, since the start of the run.
  double time(double fps) const { return frame / fps + (is_frame_end() ? 0 : advance.seconds); }
};

/// The file of a moment of this program. @param identity, simd  see output::Checkpoint
output::Checkpoint to_checkpoint(Moment moment, const std::string& identity,
                                 const std::string& simd);

/// Reads one with every number checked: a right checksum only says that nobody changed the file by
/// accident. @throws IoError that names the value that no run has written
Moment to_moment(output::Checkpoint checkpoint);

/// @param file  that cannot be used, whatever its checksum says
[[noreturn]] void refuse_moment(const std::filesystem::path& file, const std::exception& why);

}  // namespace neve::app::timeline
