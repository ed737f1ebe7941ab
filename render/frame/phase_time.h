#pragma once
/// How long a phase of a picture took.

namespace neve::render {

/// How long a phase of a picture took.
struct PhaseTime {
  const char* phase;  ///< light, particles, solids, slices, smoke, shade, overlay, read_back
  double seconds;
};

}  // namespace neve::render
