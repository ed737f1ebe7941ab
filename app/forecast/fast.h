#pragma once
/// Settings for a look at the snow in less time: see docs/time_step.md, "Fast looks".

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace neve::app::forecast {

/// Changes of parameters that shorten a run.
struct FastLook {
  std::vector<std::string> overrides;  ///< "ADDRESS=VALUE"; none if nothing would be gained
  /// Forecasts of the work of the run, in explicit steps of packed snow; none if the coarse copy
  /// diverges.
  std::optional<double> work, work_before;
  bool is_implicit = false;
  /// Relative change of the peak force on a collider of the copy: with the overrides, and with a
  /// ceiling on hardening where it is not taken because of that.
  double force_change = 0;
  std::optional<double> force_under_cap;
  /// Why settings stay that this scene bears: other scenes that are compared with it do not.
  std::string kept;
  /// Addresses of overrides that may make other snow: semi-implicit steps and ceilings.
  std::vector<std::string> risks() const;
  /// The changes and what they gain, or why there are none; a sentence.
  std::string sentence() const;
};

/// Takes longer steps: a ceiling on hardening and a larger acoustic_cfl for the steps that the
/// scene has, or the other kind of step (semi-implicit, explicit) where a coarse copy needs less
/// than half of the work that way. Neither the ceiling nor semi-implicit steps are taken where
/// they change the copy's peak force or mean J_P by more than a tenth. The result depends on the
/// scene alone, never on the machine.
/// @param last  frame of the run
/// @param chosen  addresses that the user has set, which stay, as those with curves do
/// @param coarsening  the N of --coarsen that made the scene, and that will scale the overrides
/// @param longest_cfl  of scenes that are to have steps of the same kind
FastLook fast_look(const scene::Scene& scene, int last, const std::vector<std::string>& chosen,
                   double coarsening = 1,
                   double longest_cfl = std::numeric_limits<double>::infinity());

/// Whether a change of settings leaves the peak force and the mean J_P of a coarse copy as they
/// are, within a tenth, or the copy of the first diverges, which foretells nothing.
bool is_same_snow(const scene::Scene& before, const scene::Scene& after, int last);

/// The largest acoustic_cfl with which a fast look of a scene shows its snow.
double fast_cfl(const scene::Scene& scene);

/// The settings that take longer steps of the kind that the scene has, without a forecast. All of
/// them may change while a simulation runs.
std::vector<std::string> longer_steps(const scene::Scene& scene,
                                      const std::vector<std::string>& chosen);

}  // namespace neve::app::forecast
