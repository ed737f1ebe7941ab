#pragma once
/// The USD stage that shows the layers of an export in their time, with all that moves beside them.

#include <string>
#include <vector>

#include "app/exports/series.h"

namespace neve::app::exports {

/// A USD stage: the particles, or their surface, as value clips of the layers, colliders as meshes
/// that move or deform, the camera of the scene if it has a place, and its light. Source: OpenUSD,
/// UsdClipsAPI.
/// Places of colliders and camera are those of every frame from the first file to the last one.
/// @param between  frames without a file, where the scene alone does not say where things are
/// @param colliders  that there were at any sample; one that came or went is seen while it existed
std::string encode_stage(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                         const scene::Export& spec, const Table& columns,
                         const std::vector<Sample>& files, const std::vector<Sample>& between);

/// The layer that tells the stage the names and types of the properties in the clips.
std::string encode_manifest(const scene::Scene& scene, const scene::Export& spec,
                            const Table& columns);

}  // namespace neve::app::exports
