#pragma once
/// Snow under its weight: a ball that hits the floor, a layer that is tilted, a column let go.

#include <vector>

#include "app/card/stage.h"

namespace neve::app::card {

Experiment drop(const Subject& subject);
Experiment tilt(const Subject& subject);
Experiment column(const Subject& subject);

/// How many samples of a fall, 1 to 60, an elastic swing of the snow takes.
/// @param period  s, of the swing
/// @param sample  s, from one to the next
int swing_samples(double period, double sample);

/// Of the last samples: the middle about which snow swings, and the end of what has come to rest.
double mean_of_last(const std::vector<double>& values, int samples);

}  // namespace neve::app::card
