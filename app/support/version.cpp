#include "app/support/version.h"

namespace neve::app {

// Written at each build, see cmake/BuildOrigin.cmake.
extern const char* const build_commit;
extern const char* const build_sources;

namespace {

std::string compiler_text() {
#if defined(__clang__)
  return "Clang " + std::string(__clang_version__);
#else
  return "GCC " + std::string(__VERSION__);
#endif
}

}  // namespace

const Build& build() {
  static const Build here{build_commit, NEVE_BUILD_TYPE, compiler_text(), build_sources};
  return here;
}

std::string build_text(const std::string& simd) {
  const Build& b = build();
  return "commit " + b.commit + ", " + b.type + ", " + b.compiler + ", " + simd;
}

Json build_json() {
  const Build& b = build();
  return {{"commit", b.commit}, {"type", b.type}, {"compiler", b.compiler}, {"sources", b.sources}};
}

}  // namespace neve::app
