#pragma once
/// The values of an axis, from a list, a rule or the command line.

#include <string>
#include <vector>

#include "app/scene/leaf.h"
#include "app/sweep/sweep.h"

namespace neve::app {

/// Entries whose keys are addresses; tables of `a.b = 1`, written without quotes, become "a.b".
std::vector<Entry> addresses_in(const Table& table);

/// @param source the sweep file
/// @throws SceneError
Axis::Parameter read_axis(const Source& source, const Entry& entry);

/// "-p ADDRESS=5,10,20" or "-p ADDRESS={ linspace = [1, 2], num = 3 }". @throws UsageError
Axis::Parameter parse_axis(const std::string& argument);

/// One parameter set to one value, as the sweep file has it.
Override setting_of(const Source& source, const Entry& entry);

}  // namespace neve::app
