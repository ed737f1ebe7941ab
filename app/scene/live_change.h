#pragma once
/// A parameter that was changed while a simulation ran.

#include <cstddef>
#include <string>
#include <vector>

#include "app/support/json.h"

namespace neve::app::scene {

struct LiveChange {
  std::size_t step = 0;  ///< steps that had been taken
  std::string address;
  std::string value;  ///< as --set takes it: TOML, a word, or "none"

  bool operator==(const LiveChange&) const = default;
};

Json to_json(const std::vector<LiveChange>& changes);
/// @throws std::runtime_error that names the error in the list: no list of step, address and
///         value, steps that go back, or addresses that cannot change while a simulation runs
std::vector<LiveChange> live_changes(const Json& json);

/// "step 120: material.snow.hardening = 5"
std::string text_of(const LiveChange& change);

/// Adds a change that was made now. A slider makes many changes at one step to one address while a
/// run is paused. Only the first and the last are kept, because those in between leave no trace in
/// the state. (The first too: a value that came back leaves one in the last bits of the stress.)
void note_change(std::vector<LiveChange>& changes, LiveChange change);

/// Forgets the changes made after a step: for a run that continues from an earlier state.
void forget_changes_after(std::vector<LiveChange>& changes, std::size_t step);

}  // namespace neve::app::scene
