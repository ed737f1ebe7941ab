#pragma once
/// Command line options of `neve pick`.

#include <optional>
#include <string>

#include "app/sweep/plan/sweep_options.h"

namespace neve::app::pick {

struct PickOptions {
  sweep::plan::SweepOptions runs;  ///< the scene, its axes and settings, and how runs are made
  int rounds = 8;
  std::uint64_t seed = 1;
  std::string clicks;        ///< a list of clicks to replay; "": a person is asked
  bool refines = false;      ///< the pick is made at full resolution, too
  bool is_terminal = false;  ///< asked in the terminal, though there is a screen
};

}  // namespace neve::app::pick
