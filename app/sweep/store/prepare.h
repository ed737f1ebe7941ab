#pragma once
/// Puts a sweep on disk, ready to be run by anybody who can see the folder.

#include <vector>

#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::store {

/// Numbers of runs whose simulations the folder has, with other pictures.
struct Redrawn {
  std::vector<int> from_states;
  std::vector<int> made_again;  ///< without states
};

/// DIR/manifest.json, DIR/sweep.toml, and for each run a folder with scene.toml and status.json.
/// A run that the folder knows by its key keeps its folder and its state.
/// One of the same simulation that was drawn otherwise gives its folder, if it has states.
/// @param plan with the shared camera and ranges
/// @param redrawn  is told which runs are drawn otherwise than before; may be null
/// @throws IoError
Manifest prepare_sweep(const plan::SweepPlan& plan, Redrawn* redrawn = nullptr);

/// Hash of the resolved scene, the files it names, the version, the sources that change results,
/// and the frames.
std::string key_of(const plan::PlannedRun& item);

/// The same for a run of a sweep: with its beginning, where it has one in common with others.
std::string key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item);

/// Key of a common beginning, with the changes of the run that it was taken from.
std::string key_of_beginning(const plan::SweepPlan& plan, const plan::PlannedRun& beginning);

/// Hash of all that the states of a run depend on.
std::string simulation_key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item);

}  // namespace neve::app::sweep::store
