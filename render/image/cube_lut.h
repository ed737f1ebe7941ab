#pragma once
/// Looks of a house: tables of colours in .cube files.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

/// Colours from colours, 0 to 1 as a picture displays them, by linear interpolation.
struct CubeLut {
  int size = 0;                                      ///< entries along each axis
  bool is_3d = false;                                ///< false: one curve for each channel
  std::array<float, 3> low{0, 0, 0}, high{1, 1, 1};  ///< colours of the first and the last entry
  std::vector<std::array<float, 3>> entries;         ///< red changes fastest
};

/// Keywords are those of Adobe (Cube LUT Specification 1.0), and LUT_1D_INPUT_RANGE and
/// LUT_3D_INPUT_RANGE of Resolve; independent of the locale.
/// @param name of the file in messages
/// @throws ImageError naming the line
CubeLut parse_cube(std::string_view text, const std::string& name);

/// Replaces the colours of a picture of three or four channels; alpha stays.
void apply(const CubeLut& lut, Image& image);

}  // namespace neve::render
