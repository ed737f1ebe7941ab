#pragma once
/// Snow under its weight: a ball that hits the floor, a layer that is tilted, a column let go.

#include "app/card/stage.h"

namespace neve::app::card {

Experiment drop(const Subject& subject);
Experiment tilt(const Subject& subject);
Experiment column(const Subject& subject);

}  // namespace neve::app::card
