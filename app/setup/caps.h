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

/// Sets a cap for this process and those that it starts. It only lowers one that is set already.
/// @throws UsageError naming the flag
void set_memory_cap(const std::string& text);
void set_particle_cap(const std::string& text);

/// The flags that set the present caps, each with a space before it: commands that are written down
/// to be started elsewhere keep them. Empty without caps.
std::string cap_flags();

}  // namespace neve::app::setup
