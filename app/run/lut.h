#pragma once
/// The look of --lut.

#include <string>

#include "render/image/cube_lut.h"

namespace neve::app::run {

/// @throws IoError; Error when it is no .cube file
render::CubeLut read_lut(const std::string& file);

}  // namespace neve::app::run
