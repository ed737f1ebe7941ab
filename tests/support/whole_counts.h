#pragma once
/// Numbers of repetitions of what may go wrong by chance.

#include <cstdlib>

namespace neve::test {

/// @param whole  what docs/developers.md promises, with NEVE_WHOLE=1 in the environment
inline int count_or_whole(int count, int whole) {
  const char* value = std::getenv("NEVE_WHOLE");
  return value && *value == '1' ? whole : count;
}

}  // namespace neve::test
