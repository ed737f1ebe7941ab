#pragma once
/// Functions of each backend file for context.cpp.

#include <memory>
#include <string>

#include "render/gl/context.h"

namespace neve::render::gl {

/// A context, or the reason for its absence.
struct Opened {
  std::unique_ptr<Context> context;
  std::string reason;   ///< set when context is null
  std::string install;  ///< packages that would help
};

Opened open_egl_device();
Opened open_egl_surfaceless();
Opened open_osmesa();
Opened open_window();

}  // namespace neve::render::gl
