#pragma once
/// Sweep files and the command line to a Sweep, every complaint located.

#include <string>
#include <vector>

#include "app/scene/params.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::read {

/// Additions of the command line to a sweep or scene file.
struct SweepChanges {
  std::vector<std::string> axes;  ///< -p ADDRESS=LIST; in place of an axis of the same address
  std::vector<std::string> sets;  ///< --set ADDRESS=VALUE
  bool is_forked = false;         ///< with --fork
  int seeds = 0;                  ///< --seeds; 0: those of the file
};

/// @param text  of the file
Sweep parse_sweep(const std::string& text, const std::string& file, const SweepChanges& changes);

/// @param file  with a table [sweep] it is a sweep file, otherwise a scene
/// @throws SceneError for the file, UsageError for the changes
Sweep read_sweep(const std::string& file, const SweepChanges& changes);

/// "ADDRESS = VALUE" of the values that a list has twice, so that a run is shown twice.
std::vector<std::string> repeated_values(const Sweep& sweep);

/// Parameters of sweep files, for `neve params --sweep`.
std::vector<scene::ParamInfo> sweep_params();

}  // namespace neve::app::sweep::read
