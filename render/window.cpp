#include "render/window.h"

#ifdef NEVE_WITH_WINDOW
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "render/gl/glfw_context.h"
#endif

namespace neve::render {

namespace {

[[noreturn]] void refuse(const std::string& reason, const std::string& install) {
  gl::Attempt attempt;
  attempt.backend = "window";
  attempt.reason = reason;
  attempt.install = install;
  throw gl::ContextError("no window: " + reason + ". " +
                             (install.empty() ? "--web needs none" : "Install " + install) +
                             ", or see neve doctor",
                         {attempt});
}

}  // namespace

#ifdef NEVE_WITH_WINDOW

namespace {

std::string utf8(unsigned code_point) {
  const auto byte = [](unsigned bits) { return static_cast<char>(bits); };
  if (code_point < 0x80) return {byte(code_point)};
  if (code_point < 0x800) return {byte(0xc0 | (code_point >> 6)), byte(0x80 | (code_point & 0x3f))};
  if (code_point < 0x10000)
    return {byte(0xe0 | (code_point >> 12)), byte(0x80 | ((code_point >> 6) & 0x3f)),
            byte(0x80 | (code_point & 0x3f))};
  return {byte(0xf0 | (code_point >> 18)), byte(0x80 | ((code_point >> 12) & 0x3f)),
          byte(0x80 | ((code_point >> 6) & 0x3f)), byte(0x80 | (code_point & 0x3f))};
}

/// The right ones of a pair count as the left ones, the number pad as the keys that print the same.
int without_twins(int key) {
  if (key >= GLFW_KEY_RIGHT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER)
    return key - GLFW_KEY_RIGHT_SHIFT + GLFW_KEY_LEFT_SHIFT;
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return '0' + key - GLFW_KEY_KP_0;
  switch (key) {
    case GLFW_KEY_KP_DECIMAL:
      return '.';
    case GLFW_KEY_KP_DIVIDE:
      return '/';
    case GLFW_KEY_KP_MULTIPLY:
      return '*';
    case GLFW_KEY_KP_SUBTRACT:
      return '-';
    case GLFW_KEY_KP_ADD:
      return '+';
    case GLFW_KEY_KP_ENTER:
      return GLFW_KEY_ENTER;
    case GLFW_KEY_KP_EQUAL:
      return '=';
    default:
      return key;
  }
}

/// GLFW's codes say where a key is; shortcuts go by the character it prints.
int printed_key(int key, int scancode) {
  if (key > GLFW_KEY_SPACE && key < GLFW_KEY_ESCAPE) {
    const char* name = glfwGetKeyName(key, scancode);
    if (name && name[0] > ' ' && name[0] < 127 && name[1] == 0)
      return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0];
  }
  return without_twins(key);
}

int standard_cursor(CursorShape shape) {
  switch (shape) {
    case CursorShape::text:
      return GLFW_IBEAM_CURSOR;
    case CursorShape::cross:
      return GLFW_CROSSHAIR_CURSOR;
    case CursorShape::hand:
      return GLFW_HAND_CURSOR;
    case CursorShape::resize_x:
      return GLFW_HRESIZE_CURSOR;
    case CursorShape::resize_y:
      return GLFW_VRESIZE_CURSOR;
#ifdef GLFW_RESIZE_ALL_CURSOR
    case CursorShape::resize_both:
      return GLFW_RESIZE_ALL_CURSOR;
#else
    case CursorShape::resize_both:
      return GLFW_CROSSHAIR_CURSOR;
#endif
    default:
      return GLFW_ARROW_CURSOR;
  }
}

constexpr std::size_t cursor_count = 8;

}  // namespace

struct Window::Impl {
  gl::GlfwContext context;
  GLFWwindow* window = nullptr;
  std::vector<WindowEvent> events;
  int width = 1, height = 1;
  bool is_damaged = true;
  std::optional<CursorShape> cursor;  ///< none: the desktop's
  std::array<GLFWcursor*, cursor_count> cursors{};

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (GLFWcursor* each : cursors)
      if (each) glfwDestroyCursor(each);
  }

  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
  }

  void open(const Options& options) {
    if (const std::string reason = gl::missing_display(); !reason.empty()) refuse(reason, {});
    if (const std::string reason = context.open(options.title, options.width, options.height, true);
        !reason.empty())
      refuse(reason, {});
    window = context.window();
    glfwSetWindowUserPointer(window, this);
    glfwSetWindowSizeLimits(window, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    fit_to_monitor();
    glfwSwapInterval(1);
    measure();
    listen();
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    add_move(x, y);
  }

  /// Nobody should have to look for the lower edge first.
  void fit_to_monitor() const {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (!monitor) return;
    int x = 0, y = 0, room_x = 0, room_y = 0, w = 0, h = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &room_x, &room_y);
    glfwGetWindowSize(window, &w, &h);
    if (room_x <= 0 || room_y <= 0 || (w <= room_x && h <= room_y)) return;
    glfwSetWindowSize(window, std::min(w, room_x * 9 / 10), std::min(h, room_y * 9 / 10));
    glfwSetWindowPos(window, x + room_x / 20, y + room_y / 20);
  }

  void measure() {
    int w = 0, h = 0;
    glfwGetFramebufferSize(window, &w, &h);
    if (w <= 0 || h <= 0) return;  // an icon has no size
    width = w;
    height = h;
  }

  /// px per unit of window coordinates
  std::pair<double, double> pixels() const {
    int w = 0, h = 0;
    glfwGetWindowSize(window, &w, &h);
    if (w <= 0 || h <= 0) return {1, 1};
    return {static_cast<double>(width) / w, static_cast<double>(height) / h};
  }

  bool is_held(int left, int right) const {
    return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
  }

  /// GLFW reports the modifiers from before a modifier's own event on some desktops.
  void add(WindowEvent event) {
    event.ctrl = is_held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    event.shift = is_held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    event.alt = is_held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    event.super = is_held(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
    events.push_back(std::move(event));
  }

  void add_move(double x, double y) {
    const auto [px, py] = pixels();
    add({.kind = WindowEvent::Kind::move,
         .x = static_cast<float>(x * px),
         .y = static_cast<float>(y * py)});
  }

  bool is_button_down() const {
    for (int button = 0; button <= GLFW_MOUSE_BUTTON_LAST; ++button)
      if (glfwGetMouseButton(window, button) == GLFW_PRESS) return true;
    return false;
  }

  void listen();
  void listen_to_keys();
};

void Window::Impl::listen() {
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).add_move(x, y); });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int has_entered) {
    Impl& self = of(w);
    // A drag continues outside.
    if (!has_entered && !self.is_button_down()) self.add({.kind = WindowEvent::Kind::leave});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    // The press happened at the last mouse position of the events; asking GLFW now would give a
    // later position.
    of(w).add(
        {.kind = WindowEvent::Kind::button, .button = button, .is_down = action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    // GLFW counts to the left.
    of(w).add({.kind = WindowEvent::Kind::wheel,
               .x = static_cast<float>(-x),
               .y = static_cast<float>(y)});
  });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) {
    Impl& self = of(w);
    self.measure();
    self.is_damaged = true;
    self.add({.kind = WindowEvent::Kind::resize,
              .x = static_cast<float>(self.width),
              .y = static_cast<float>(self.height)});
  });
  glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) {
    Impl& self = of(w);
    self.is_damaged = true;
    self.add({.kind = WindowEvent::Kind::resize,
              .x = static_cast<float>(self.width),
              .y = static_cast<float>(self.height)});
  });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).is_damaged = true; });
  glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int is_icon) {
    if (!is_icon) of(w).is_damaged = true;
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    for (int k = 0; k < count; ++k) of(w).add({.kind = WindowEvent::Kind::drop, .text = paths[k]});
  });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) {
    glfwSetWindowShouldClose(w, GLFW_FALSE);
    of(w).add({.kind = WindowEvent::Kind::close});
  });
  listen_to_keys();
}

void Window::Impl::listen_to_keys() {
  // When the window loses the focus, GLFW lets go of what is held by itself.
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int) {
    if (action == GLFW_REPEAT) return;  // who needs repeats makes them
    const int printed = printed_key(key, scancode);
    if (printed <= 0) return;
    of(w).add({.kind = WindowEvent::Kind::key, .key = printed, .is_down = action == GLFW_PRESS});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code_point) {
    of(w).add({.kind = WindowEvent::Kind::text, .text = utf8(code_point)});
  });
}

Window::Window(const Options& options) : impl_(std::make_unique<Impl>()) {
  impl_->open(options);
}

Window::~Window() = default;

gl::Context& Window::context() {
  return impl_->context;
}
int Window::width() const {
  return impl_->width;
}
int Window::height() const {
  return impl_->height;
}

float Window::scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(impl_->window, &x, &y);
  // Some desktops enlarge by their coordinates, others leave all of it to the program.
  return std::clamp(std::max(x, static_cast<float>(impl_->pixels().first)), 0.5f, 4.0f);
}

bool Window::is_shown() const {
  return glfwGetWindowAttrib(impl_->window, GLFW_ICONIFIED) == GLFW_FALSE &&
         glfwGetWindowAttrib(impl_->window, GLFW_VISIBLE) == GLFW_TRUE;
}
bool Window::is_damaged() const {
  return impl_->is_damaged;
}

std::vector<WindowEvent> Window::wait(double seconds) {
  if (!impl_->events.empty() || !(seconds > 0)) {
    glfwPollEvents();
  } else {
    // GLFW takes no longer times than a float of milliseconds holds.
    glfwWaitEventsTimeout(std::min(seconds, 3600.0));
  }
  return std::exchange(impl_->events, {});
}

void Window::wake() {
  glfwPostEmptyEvent();
}

void Window::swap() {
  impl_->is_damaged = false;
  glfwSwapBuffers(impl_->window);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(impl_->window, title.c_str());
}

void Window::set_cursor(CursorShape shape) {
  if (shape == impl_->cursor) return;
  impl_->cursor = shape;
  glfwSetInputMode(impl_->window, GLFW_CURSOR,
                   shape == CursorShape::hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
  GLFWcursor*& cursor = impl_->cursors[static_cast<std::size_t>(shape)];
  if (!cursor) cursor = glfwCreateStandardCursor(standard_cursor(shape));
  glfwSetCursor(impl_->window, cursor);  // without one it is the arrow
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(impl_->window, text.c_str());
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(impl_->window);
  return text ? text : "";
}

#else

struct Window::Impl {};

Window::Window(const Options&) {
  refuse("built without GLFW", "libglfw3-dev and build again with NEVE_WINDOW=ON");
}
Window::~Window() = default;
gl::Context& Window::context() {
  refuse("built without GLFW", {});
}
int Window::width() const {
  return 1;
}
int Window::height() const {
  return 1;
}
float Window::scale() const {
  return 1;
}
bool Window::is_shown() const {
  return false;
}
bool Window::is_damaged() const {
  return false;
}
std::vector<WindowEvent> Window::wait(double) {
  return {};
}
void Window::wake() {}
void Window::swap() {}
void Window::set_title(const std::string&) {}
void Window::set_cursor(CursorShape) {}
void Window::set_clipboard(const std::string&) {}
std::string Window::clipboard() const {
  return {};
}

#endif

}  // namespace neve::render
