#pragma once
/// The state of a run as bytes, and back: exact, in the order of storage.

#include <cstdint>
#include <span>
#include <vector>

#include "sim/engine/snow_flow.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

template <class Real>
std::vector<std::uint8_t> save(const State<Real>& state, const SnowFlow<Real>& flow);

/// A state's snow, and its dust: empty where it has none.
struct SplitState {
  std::span<const std::uint8_t> snow, dust;
};
/// The two as one, and back. @throws SavedStateError
std::vector<std::uint8_t> joined(std::vector<std::uint8_t> snow,
                                 const std::vector<std::uint8_t>& dust);
SplitState split(std::span<const std::uint8_t> bytes);

/// True if the bytes begin as those that this program saves: another build may lay them out
/// otherwise.
bool has_this_layout(std::span<const std::uint8_t> bytes);

/// @throws SavedStateError; state and flow are then as they were
template <class Real>
void restore(std::span<const std::uint8_t> bytes, State<Real>& state, SnowFlow<Real>& flow);

/// Refuses numbers that restore() takes and a healthy run never has. For bytes from a file.
/// @throws SavedStateError that names the number
template <class Real>
void require_healthy(std::span<const std::uint8_t> bytes, const State<Real>& state,
                     const SnowFlow<Real>& flow);

}  // namespace neve::sim::engine
