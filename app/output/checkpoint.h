#pragma once
/// Checkpoints of a run: DIR/checkpoint/NNNN-steps.ckpt, the newest two, whole or not at all.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/support/json.h"

namespace neve::app::output {

struct Checkpoint {
  /// Hash of everything that must be equal to resume a run: version, resolved scene, quality,
  /// contents of files.
  std::string identity;
  std::string simd;                 ///< instruction set that the bits belong to
  std::string sources;              ///< Build::sources of the program; "" of earlier versions
  int frame = 0;                    ///< the last one that is drawn
  std::size_t steps = 0;            ///< since the start of the run
  Json progress;                    ///< further data of the run
  std::vector<std::uint8_t> state;  ///< sim::Simulation::save
  std::filesystem::path file{};     ///< that it was read from
};

/// Removes what killed processes left unfinished among the checkpoints.
/// @throws IoError when something that is no folder has their place
void tidy_checkpoint_folder(const std::filesystem::path& folder);

/// The bytes of a file.
std::vector<std::uint8_t> encode_checkpoint(const Checkpoint& checkpoint);

/// @throws std::runtime_error for bytes that are no whole checkpoint
Checkpoint parse_checkpoint(std::vector<std::uint8_t> bytes);

/// Writes one and removes all but the newest two, in this order. It is on the disk when this
/// returns. @throws IoError
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Frames of the checkpoints in a folder with their steps, by their names.
std::map<int, std::size_t> checkpoint_steps(const std::filesystem::path& folder);

struct FoundCheckpoint {
  std::optional<Checkpoint> checkpoint;  ///< the newest whole one
  std::vector<std::string> damaged;      ///< those that were passed over: "FILE: why"
};

/// Empty if the folder has none. Damaged checkpoints are skipped and named.
/// @param before  frame that the checkpoint is to be before
/// @throws UnreadableError for one that the machine does not give
FoundCheckpoint find_checkpoint(const std::filesystem::path& folder,
                                int before = std::numeric_limits<int>::max());

/// Writes the state of a frame that is kept: DIR/states/NNNNNN.ckpt, beside those of other frames.
/// @return bytes of the file @throws IoError
std::uint64_t write_state(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Bytes of the file; 0 without one.
std::uint64_t state_bytes(const std::filesystem::path& folder, int frame);

/// Removes what killed processes left unfinished among the states.
void tidy_states_folder(const std::filesystem::path& folder);

/// Frames with a kept state, in order.
std::vector<int> kept_states(const std::filesystem::path& folder);

/// Empty if the frame has none. @throws UnreadableError likewise
FoundCheckpoint read_state(const std::filesystem::path& folder, int frame);

/// The kept states and the checkpoints of a run, each read whole and held to its checksum.
struct KeptFiles {
  std::size_t count = 0;    ///< that were read
  bool has_states = false;  ///< DIR/states exists: who wants the disk back removes it
  std::vector<int> states;  ///< frames, in order, of damaged ones too
  std::map<std::string, std::string> damaged;  ///< "states/000005.ckpt": "is truncated"
};
KeptFiles check_kept(const std::filesystem::path& folder);

/// "states/000005.ckpt"
std::string state_name(int frame);

void remove_state(const std::filesystem::path& folder, int frame);
/// Removes all kept states of a folder. Other files stay.
void remove_states(const std::filesystem::path& folder);

/// Removes the checkpoints before a new run. Other files stay, also one called `checkpoint`.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace neve::app::output
