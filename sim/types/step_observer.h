#pragma once
/// Observer of a simulation while it advances.

#include <functional>

namespace neve::sim {

/// Called after each step, in the thread that advances. Returns true to stop there; an empty one
/// never stops.
using StepObserver = std::function<bool()>;

}  // namespace neve::sim
