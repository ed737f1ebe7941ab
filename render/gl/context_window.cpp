/// A hidden GLFW window: OpenGL of the desktop, where there is a display.

#include "render/gl/context_backends.h"

#ifdef NEVE_WITH_WINDOW
#include "render/gl/glfw_context.h"
#endif

namespace neve::render::gl {

#ifdef NEVE_WITH_WINDOW

Opened open_window() {
  if (std::string reason = missing_display(); !reason.empty()) return {nullptr, reason, {}};
  auto context = std::make_unique<GlfwContext>();
  if (std::string reason = context->open("neve", 64, 64, false); !reason.empty())
    return {nullptr, reason, {}};
  return {std::move(context), {}, {}};
}

#else

Opened open_window() {
  return {nullptr, "built without GLFW", "libglfw3-dev and build again with NEVE_WINDOW=ON"};
}

#endif

}  // namespace neve::render::gl
