/// A hidden GLFW window: OpenGL of the desktop, where there is a display.

#include "render/context_backends.h"

#ifdef NEVE_WITH_WINDOW
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cstdlib>

#include "render/gl.h"
#endif

namespace neve::render {

#ifdef NEVE_WITH_WINDOW
namespace {

/// GLFW is one global thing; it is started with the first window and stopped with the last.
struct GlfwSession {
  static inline int users = 0;
  bool is_started = false;
  GlfwSession() {
    is_started = users > 0 || glfwInit() == GLFW_TRUE;
    if (is_started) ++users;
  }
  GlfwSession(const GlfwSession&) = delete;
  GlfwSession& operator=(const GlfwSession&) = delete;
  ~GlfwSession() {
    if (is_started && --users == 0) glfwTerminate();
  }
};

class WindowContext final : public Context {
 public:
  ~WindowContext() override {
    if (window_) glfwDestroyWindow(window_);
  }
  void make_current() override { glfwMakeContextCurrent(window_); }
  void* get_proc(const char* name) override {
    return reinterpret_cast<void*>(glfwGetProcAddress(name));
  }

  /// @return "" or why there is no window
  std::string open() {
    backend = "window";
    if (!session_.is_started) return "GLFW does not start: " + last_error();
    for (const auto& [major, minor] : {std::array{4, 5}, std::array{4, 3}, std::array{3, 3}}) {
      glfwDefaultWindowHints();
      glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
      glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
      glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
      glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
      window_ = glfwCreateWindow(64, 64, "neve", nullptr, nullptr);
      if (window_) break;
    }
    if (!window_) return "no OpenGL 3.3 window: " + last_error();
    make_current();
    return identify(*this);
  }

 private:
  static std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
  }

  GlfwSession session_;
  GLFWwindow* window_ = nullptr;
};

}  // namespace

Opened open_window() {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
    return {nullptr, "no display (neither DISPLAY nor WAYLAND_DISPLAY is set)", {}};
  auto context = std::make_unique<WindowContext>();
  if (std::string reason = context->open(); !reason.empty()) return {nullptr, reason, {}};
  return {std::move(context), {}, {}};
}

#else

Opened open_window() {
  return {nullptr, "built without GLFW", "libglfw3-dev and build again with NEVE_WINDOW=ON"};
}

#endif

}  // namespace neve::render
