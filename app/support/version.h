#pragma once
/// The version, and the build, that pictures and run.json carry; the build system knows them.

#include <string>

#include "app/support/json.h"

namespace neve::app {

inline constexpr const char* version = NEVE_VERSION;

/// The origin of this program.
struct Build {
  std::string commit;    ///< "1a2b3c4d5e6f", "1a2b3c4d5e6f with changes", "unknown"
  std::string type;      ///< "Release"
  std::string compiler;  ///< "GCC 12.2.0"
  /// Fingerprint of the sources that change results: states, pictures and numbers. Other sources,
  /// tests and documentation are no part of it.
  std::string sources;
};
const Build& build();

/// "commit 1a2b3c4d5e6f, Release, GCC 12.2.0, avx2"
/// @param simd  instruction set in use
std::string build_text(const std::string& simd);
Json build_json();

}  // namespace neve::app
