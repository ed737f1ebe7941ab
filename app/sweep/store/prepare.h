#pragma once
/// Puts a sweep on disk, ready to be run by anybody who can see the folder.

#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::store {

/// DIR/manifest.json, DIR/sweep.toml, and for each run a folder with scene.toml and status.json.
/// A run that the folder knows by its key keeps its folder and its state.
/// @param plan with the shared camera and ranges
/// @throws IoError
Manifest prepare_sweep(const plan::SweepPlan& plan);

/// Hash of the resolved scene, the files it names, the version, the sources that change results,
/// and the frames.
std::string key_of(const plan::PlannedRun& item);

/// The same for a run of a sweep: with its beginning, where it has one in common with others.
std::string key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item);

}  // namespace neve::app::sweep::store
