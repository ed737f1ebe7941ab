#ifdef NEVE_WITH_WINDOW

#include "render/gl/glfw_context.h"

#include <array>
#include <cstdlib>

#include "render/gl/gl.h"

namespace neve::render::gl {

namespace {

int session_count = 0;

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

}  // namespace

GlfwSession::GlfwSession() : is_started_(session_count > 0 || glfwInit() == GLFW_TRUE) {
  if (is_started_) ++session_count;
}

GlfwSession::~GlfwSession() {
  if (is_started_ && --session_count == 0) glfwTerminate();
}

GlfwContext::~GlfwContext() {
  if (window_) glfwDestroyWindow(window_);
}

std::string GlfwContext::open(const std::string& title, int width, int height, bool is_visible) {
  backend = "window";
  if (!session_.is_started()) return "GLFW does not start: " + last_error();
  for (const auto& [major, minor] : {std::array{4, 5}, std::array{4, 3}, std::array{3, 3}}) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, is_visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, is_visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    // Everything is drawn into framebuffers of neve's own; the window only gets the result.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "neve");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "neve");
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_) break;
  }
  if (!window_) return "no OpenGL 3.3 window: " + last_error();
  make_current();
  return identify(*this);
}

std::string missing_display() {
  if (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY")) return {};
  return "no display (neither DISPLAY nor WAYLAND_DISPLAY is set)";
}

}  // namespace neve::render::gl

#endif
