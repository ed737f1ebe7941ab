#pragma once
/// Time of one phase of a picture.

namespace neve::render {

/// Time of one phase of a picture.
struct PhaseTime {
  const char* phase;  ///< light, particles, solids, slices, smoke, shade, overlay, read_back
  double seconds;
};

}  // namespace neve::render
