#pragma once
/// The first yield of a law, and the stress before it: the formulas beside the measures.

#include <functional>
#include <optional>

#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::app::card {

/// F of a strain, from rest.
using Path = std::function<sim::Mat3d(double strain)>;
/// The distance between the plates is longer by the strain, the sides stay.
sim::Mat3d stretched(double strain);

/// Cauchy stress of the law where it does not yield, Pa.
sim::Mat3d elastic_stress(const sim::Material& material, const sim::Mat3d& F);

/// The smallest strain at which the law yields; nothing if it does not up to the largest.
std::optional<double> first_yield(const sim::Material& material, const Path& path, double largest);

}  // namespace neve::app::card
