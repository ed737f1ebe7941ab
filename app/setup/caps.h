#pragma once
/// Upper bounds that the user sets and no scene can raise: NEVE_MAX_MEMORY and NEVE_MAX_PARTICLES.
/// Runs of a sweep inherit them.

#include <limits>
#include <string>

namespace neve::app::setup {

struct Caps {
  double memory = std::numeric_limits<double>::infinity();  ///< bytes
  double particles = std::numeric_limits<double>::infinity();
};

/// @throws UsageError for a variable that is no number
Caps caps();

/// Caps as they are typed; empty: none.
struct CapTexts {
  std::string memory, particles;
};

/// The variables, for commands that are written down to be started elsewhere.
CapTexts cap_texts();
/// Sets the variables, for this process and those that it starts. It only lowers a cap that is set.
/// @throws UsageError for a variable that is no number
void hold_caps(const CapTexts& texts);

/// "8GiB" in bytes; "2e6". @param where  the flag or variable that has the text @throws UsageError
double memory_cap(const std::string& text, const std::string& where);
double particle_cap(const std::string& text, const std::string& where);

}  // namespace neve::app::setup
