#pragma once
/// Files of a search: the sweep of each round, and the scene and sweep of the result.

#include <filesystem>
#include <string>
#include <vector>

#include "app/pick/axes.h"

namespace neve::app::pick {

/// The scene, the settings and the axes that all runs of a search share.
struct SearchScene {
  std::string file;                    ///< of the scene, as the shell's folder sees it
  std::vector<scene::Override> fixed;  ///< --set
  std::vector<PickAxis> axes;
};

/// A sweep file with one run for each tile, numbered from 1.
/// @param folder  that the text will be in: the scene is named relative to it
/// @param round   from 1
std::string round_sweep(const SearchScene& scene, const std::filesystem::path& folder, int round,
                        const std::vector<search::Point>& tiles);

/// The scene with the values of a place, in its own resolution, and with the comments of its file.
/// @param out  file that the text is for
std::string picked_scene(const SearchScene& scene, const search::Point& place,
                         const std::filesystem::path& out);

/// A sweep file around a place: the two axes that tell most with three values each, or the only
/// one with five.
/// @param scene_name  file of picked_scene, in the same folder
/// @param order       axes, the most telling one first
std::string picked_sweep(const SearchScene& scene, const std::string& scene_name,
                         const search::Point& place, const std::vector<std::size_t>& order);

/// A sweep file with two runs of the pick: as coarse as the tiles were, and at full resolution.
/// @param scene_name  file of picked_scene, in the same folder @param picked  its scene
std::string picked_pair(const std::string& scene_name, const scene::Scene& picked,
                        double coarsening);

}  // namespace neve::app::pick
