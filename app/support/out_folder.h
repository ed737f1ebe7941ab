#pragma once
/// The folder that outputs go into where no --out names one.

#include <cstdlib>
#include <filesystem>

namespace neve::app {

/// NEVE_OUT, or "out" in the current folder.
inline std::filesystem::path out_folder() {
  const char* chosen = std::getenv("NEVE_OUT");
  return chosen && *chosen ? std::filesystem::path(chosen) : std::filesystem::path("out");
}

}  // namespace neve::app
