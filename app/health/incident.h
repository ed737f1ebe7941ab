#pragma once
/// Report of a diverged run, and a view of the place where it happened.

#include <optional>

#include "app/health/diagnosis.h"
#include "app/scene/scene.h"
#include "app/support/json.h"
#include "sim/simulation.h"

namespace neve::app::health {

/// Speed and velocity on the plane through the culprit that the camera of a view faces most, a few
/// cells around it; empty if the culprit's place is no number.
/// @param scene resolved
std::optional<scene::View> culprit_slice(const scene::Scene& scene,
                                         const sim::Divergence& divergence,
                                         const sim::ParticleArrays& particles);

/// Everything about the step, the culprit, the last steps and the cause. Null for numbers that are
/// not finite.
/// @param scene resolved, TOML
Json incident_json(const sim::Divergence& divergence, const Diagnosis& diagnosis,
                   const std::string& scene, double cell_size);

}  // namespace neve::app::health
