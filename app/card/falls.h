#pragma once
/// Snow under its weight: a ball that hits the floor, a layer that is tilted, a column let go.

#include <vector>

#include "app/card/stage.h"

namespace neve::app::card {

Experiment drop(const Subject& subject);
Experiment tilt(const Subject& subject);
Experiment column(const Subject& subject);

/// Returns the number of samples of a fall, 1 to 60, that an elastic swing of the snow takes.
/// @param period  s, of the swing
/// @param sample  s, from one to the next
int swing_samples(double period, double sample);

/// Returns the mean of the last samples: the middle of a swing, or the place of snow at rest.
double mean_of_last(const std::vector<double>& values, int samples);

}  // namespace neve::app::card
