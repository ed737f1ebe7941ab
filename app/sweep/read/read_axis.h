#pragma once
/// The values of an axis, from a list, a rule or the command line.

#include <string>
#include <vector>

#include "app/scene/leaf.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::read {

/// Entries whose keys are addresses; tables of `a.b = 1`, written without quotes, become "a.b".
/// @param has_rules  the table has axes: values may be given by rules, which are tables themselves
std::vector<scene::toml::Entry> addresses_in(const scene::toml::Table& table, bool has_rules);

/// @param source the sweep file
/// @throws SceneError
Axis::Parameter read_axis(const scene::Source& source, const scene::toml::Entry& entry);

/// "-p ADDRESS=5,10,20" or "-p ADDRESS={ linspace = [1, 2], num = 3 }". @throws UsageError
Axis::Parameter parse_axis(const std::string& argument);

/// One parameter set to one value, as the sweep file has it.
scene::Override setting_of(const scene::Source& source, const scene::toml::Entry& entry);

}  // namespace neve::app::sweep::read
