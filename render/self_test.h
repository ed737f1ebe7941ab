#pragma once
/// Draws a picture whose content is known and looks at it: a driver can open a context and still
/// draw nothing.

#include <string>

#include "render/gl/context.h"

namespace neve::render {

/// @return "" or the defect of the picture; never throws
std::string self_test(gl::Context& context);

}  // namespace neve::render
