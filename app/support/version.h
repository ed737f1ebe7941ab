#pragma once
/// The version that pictures and run.json carry; the build system knows it.

namespace neve::app {

inline constexpr const char* version = NEVE_VERSION;

}  // namespace neve::app
