#pragma once
/// Meanings of the stages of a step and of symbols, for tips, messages and docs/mpm.md.

#include <string>

#include "sim/types/stage.h"

namespace neve::app::health {

struct StageMeaning {
  const char* sentence;  ///< in everyday words
  const char* paper;     ///< the step of the paper (section 4) and its formula
};
const StageMeaning& meaning_of(sim::Stage stage);

/// A sentence on a quantity of neve dump and the inspector, such as F_E; empty for an unknown name.
std::string meaning_of(const std::string& quantity);

}  // namespace neve::app::health
