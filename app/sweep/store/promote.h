#pragma once
/// `neve sweep promote DIR N`: the scene of a tile in its own resolution, as a person would write
/// it.

#include <string>

#include "app/options/option.h"

namespace neve::app::sweep::store {

struct PromoteOptions {
  std::string folder;  ///< of a sweep
  int run = -1;
  std::string out;  ///< "": beside the scene of the sweep
  bool is_json = false;
};

void describe(options::Command& visit, PromoteOptions& options);

/// @return exit code @throws UsageError, IoError, SceneError
int run_promote(const PromoteOptions& options);

}  // namespace neve::app::sweep::store
