#pragma once
/// Tests that need another program or library: without it they are skipped, and fail where
/// NEVE_REQUIRE_ALL=1 says that everything is installed, as ./neve test does.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string_view>

namespace neve::test {

inline bool is_everything_required() {
  const char* const required = std::getenv("NEVE_REQUIRE_ALL");
  return required && std::string_view(required) == "1";
}

}  // namespace neve::test

/// Ends the test because something is missing. @param reason says what, and what to install
#define SKIP_OR_FAIL(reason)                                                       \
  do {                                                                             \
    if (neve::test::is_everything_required())                                      \
      FAIL() << (reason)                                                           \
             << "\nNEVE_REQUIRE_ALL=1 forbids to skip: ./neve test installs what " \
                "tests need; unset it where that is impossible";                   \
    GTEST_SKIP() << (reason);                                                      \
  } while (false)
