#pragma once
/// The OpenGL context of a GLFW window, hidden or not. Only for files that GLFW was found for.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <string>

#include "render/gl/context.h"

namespace neve::render::gl {

/// GLFW is one global thing; it is started with the first window and stopped with the last.
class GlfwSession {
 public:
  GlfwSession();
  ~GlfwSession();
  GlfwSession(const GlfwSession&) = delete;
  GlfwSession& operator=(const GlfwSession&) = delete;
  bool is_started() const { return is_started_; }

 private:
  bool is_started_;
};

class GlfwContext final : public Context {
 public:
  GlfwContext() = default;
  ~GlfwContext() override;
  GlfwContext(const GlfwContext&) = delete;
  GlfwContext& operator=(const GlfwContext&) = delete;

  void make_current() override { glfwMakeContextCurrent(window_); }
  void* get_proc(const char* name) override {
    return reinterpret_cast<void*>(glfwGetProcAddress(name));
  }

  /// Opens a window with the newest OpenGL that there is.
  /// @param width, height points
  /// @return "" or why there is no window
  std::string open(const std::string& title, int width, int height, bool is_visible);

  GLFWwindow* window() const { return window_; }

 private:
  GlfwSession session_;
  GLFWwindow* window_ = nullptr;
};

/// "" if there is a display to open a window on.
std::string missing_display();

}  // namespace neve::render::gl
