#pragma once
/// Input that the solver cannot use. Numerical trouble is data, see Divergence.

#include <stdexcept>

namespace neve::sim {

/// Bytes that are no saved state; what() says why.
struct SavedStateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown when a shape cannot be filled; what() says which file and why.
struct ShapeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace neve::sim
