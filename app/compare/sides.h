#pragma once
/// The two runs that are compared.

#include <optional>
#include <string>
#include <vector>

#include "app/compare/pair_options.h"
#include "app/run/render_job.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "sim/simulation.h"

namespace neve::app::compare {

/// A run, or the moment that a picture shows.
struct Side {
  run::RenderJob job;    ///< its frames are those that there are
  std::string values{};  ///< of the parameters in which it differs from the other one
};

struct Pair {
  Side a, b;
  setup::FrameRange frames;            ///< to compare: in both
  std::vector<std::string> differing;  ///< addresses
  std::vector<std::string> warnings;
};

/// Reads both runs. @throws UsageError when they cannot be compared: at other times, without frames
/// in common; Error for a picture or run.json that is not of neve
Pair read_pair(const PairOptions& options);

/// Why an id does not mean the same piece of snow in both runs; empty if it does.
std::optional<UsageError> id_problem(const Pair& pair, const setup::SeededScene& a,
                                     const setup::SeededScene& b);

/// Why the number of a birth does not mean the same snow in both runs as they are now; empty if it
/// does: nothing was in the way of their emitters.
std::optional<UsageError> birth_problem(const Pair& pair, const sim::Simulation& a,
                                        const sim::Simulation& b);

/// Why the nodes of both grids lie in other places; empty if they do not.
std::optional<UsageError> grid_problem(const Pair& pair);

}  // namespace neve::app::compare
