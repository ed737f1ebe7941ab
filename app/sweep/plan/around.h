#pragma once
/// A sweep file for "what if this value were a little different?".

#include <string>
#include <vector>

#include "app/scene/flat.h"
#include "app/scene/override.h"

namespace neve::app::sweep::plan {

/// Values around one: five numbers with it in the middle where the bounds leave room, in equal
/// ratios where a parameter spans decades (a decade each way for pascals, otherwise up to four
/// times and down to a quarter), at equal distances up to half of the value away elsewhere; of a
/// choice all there is; vectors are stretched and shrunk.
/// @throws UsageError for values without neighbours: names, lists, a vector of zeros
std::vector<scene::toml::Value> values_around(const scene::FlatParam& param);

/// The text of a sweep file that reads so.
/// @param scene_file  that is swept
/// @param sweep_file  where the text will be: the scene is named relative to it
/// @param param       as it is now, see flatten()
/// @param set         what else is not as in the scene file; of the parameter itself is left out
/// @param coarsening  of the run that it comes from: a comment says how neve sweep gets it
/// @param set_later   addresses that were changed during that run: a comment says that they are
///                    start values now
/// @throws UsageError like values_around
std::string sweep_around(const std::string& scene_file, const std::string& sweep_file,
                         const scene::FlatParam& param, const std::vector<scene::Override>& set,
                         double coarsening = 1, const std::vector<std::string>& set_later = {});

/// The command that makes the runs, to paste into a shell.
std::string sweep_command(const std::string& sweep_file, double coarsening = 1);

}  // namespace neve::app::sweep::plan
