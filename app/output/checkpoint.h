#pragma once
/// Checkpoints of a run: DIR/checkpoint/NNNN-steps.ckpt, the newest two, whole or not at all.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/support/json.h"

namespace neve::app::output {

struct Checkpoint {
  /// Hash of everything that must be equal to resume a run: version, resolved scene, quality,
  /// contents of files.
  std::string identity;
  std::string simd;                 ///< instruction set that the bits belong to
  int frame = 0;                    ///< the last one that is drawn
  std::size_t steps = 0;            ///< since the start of the run
  Json progress;                    ///< further data of the run
  std::vector<std::uint8_t> state;  ///< sim::Simulation::save
};

/// Writes one and removes all but the newest two, in this order. @throws IoError
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

struct FoundCheckpoint {
  std::optional<Checkpoint> checkpoint;  ///< the newest whole one
  std::vector<std::string> damaged;      ///< newer ones: "FILE: why"
};

/// Nothing where the folder has none. Damaged ones are passed over and named.
FoundCheckpoint find_checkpoint(const std::filesystem::path& folder);

/// Removes the checkpoints before a new run. Other files stay.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace neve::app::output
