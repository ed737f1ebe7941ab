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

constexpr std::size_t cursor_count = 7;

static_assert(key::escape == GLFW_KEY_ESCAPE && key::f1 == GLFW_KEY_F1 &&
              key::last == GLFW_KEY_LAST);

class GlfwWindow final : public Window {
 public:
  explicit GlfwWindow(const Options& options) {
    if (const std::string reason = gl::missing_display(); !reason.empty()) refuse(reason, {});
    if (const std::string reason =
            context_.open(options.title, options.width, options.height, true);
        !reason.empty())
      refuse(reason, {});
    window_ = context_.window();
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    fit_to_monitor();
    glfwSwapInterval(1);
    measure();
    listen();
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    add_move(x, y);
  }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;
  ~GlfwWindow() override {
    for (GLFWcursor* each : cursors_)
      if (each) glfwDestroyCursor(each);
  }

  gl::Context& context() override { return context_; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  float scale() const override {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    // Some desktops enlarge by their coordinates, others leave all of it to the program.
    return std::clamp(std::max(x, static_cast<float>(pixels().first)), 0.5f, 4.0f);
  }

  bool is_shown() const override {
    return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_FALSE &&
           glfwGetWindowAttrib(window_, GLFW_VISIBLE) == GLFW_TRUE;
  }
  bool is_damaged() const override { return is_damaged_; }

  std::vector<InputEvent> wait(double seconds) override {
    if (!events_.empty() || !(seconds > 0)) {
      glfwPollEvents();
    } else {
      // GLFW takes no longer times than a float of milliseconds holds.
      glfwWaitEventsTimeout(std::min(seconds, 3600.0));
    }
    return std::exchange(events_, {});
  }
  void wake() override { glfwPostEmptyEvent(); }

  void swap() override {
    is_damaged_ = false;
    glfwSwapBuffers(window_);
  }

  void set_title(const std::string& title) override { glfwSetWindowTitle(window_, title.c_str()); }

  void set_cursor(CursorShape shape) override {
    if (shape == cursor_) return;
    cursor_ = shape;
    glfwSetInputMode(window_, GLFW_CURSOR,
                     shape == CursorShape::hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
    GLFWcursor*& cursor = cursors_[static_cast<std::size_t>(shape)];
    if (!cursor) cursor = glfwCreateStandardCursor(standard_cursor(shape));
    glfwSetCursor(window_, cursor);  // without one it is the arrow
  }

  void set_clipboard(const std::string& text) override {
    glfwSetClipboardString(window_, text.c_str());
  }
  std::string clipboard() const override {
    const char* text = glfwGetClipboardString(window_);
    return text ? text : "";
  }

 private:
  static GlfwWindow& of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
  }

  /// Nobody should have to look for the lower edge first.
  void fit_to_monitor() const {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (!monitor) return;
    int x = 0, y = 0, room_x = 0, room_y = 0, w = 0, h = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &room_x, &room_y);
    glfwGetWindowSize(window_, &w, &h);
    if (room_x <= 0 || room_y <= 0 || (w <= room_x && h <= room_y)) return;
    glfwSetWindowSize(window_, std::min(w, room_x * 9 / 10), std::min(h, room_y * 9 / 10));
    glfwSetWindowPos(window_, x + room_x / 20, y + room_y / 20);
  }

  void measure() {
    int w = 0, h = 0;
    glfwGetFramebufferSize(window_, &w, &h);
    if (w <= 0 || h <= 0) return;  // an icon has no size
    width_ = w;
    height_ = h;
  }

  /// Returns px per unit of window coordinates.
  std::pair<double, double> pixels() const {
    int w = 0, h = 0;
    glfwGetWindowSize(window_, &w, &h);
    if (w <= 0 || h <= 0) return {1, 1};
    return {static_cast<double>(width_) / w, static_cast<double>(height_) / h};
  }

  bool is_held(int left, int right) const {
    return glfwGetKey(window_, left) == GLFW_PRESS || glfwGetKey(window_, right) == GLFW_PRESS;
  }

  /// GLFW reports the modifiers from before a modifier's own event on some desktops.
  void add(InputEvent event) {
    event.held = {is_held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL),
                  is_held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
                  is_held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT),
                  is_held(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER)};
    events_.push_back(std::move(event));
  }

  void add_move(double x, double y) {
    const auto [px, py] = pixels();
    add({.kind = InputEvent::Kind::move,
         .x = static_cast<float>(x * px),
         .y = static_cast<float>(y * py)});
  }

  bool is_button_down() const {
    for (int button = 0; button <= GLFW_MOUSE_BUTTON_LAST; ++button)
      if (glfwGetMouseButton(window_, button) == GLFW_PRESS) return true;
    return false;
  }

  void listen();
  void listen_to_keys();

  gl::GlfwContext context_;
  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  int width_ = 1, height_ = 1;
  bool is_damaged_ = true;
  std::optional<CursorShape> cursor_;  ///< none: the desktop's
  std::array<GLFWcursor*, cursor_count> cursors_{};
};

void GlfwWindow::listen() {
  glfwSetCursorPosCallback(window_,
                           [](GLFWwindow* w, double x, double y) { of(w).add_move(x, y); });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int has_entered) {
    GlfwWindow& self = of(w);
    // A drag continues outside.
    if (!has_entered && !self.is_button_down())
      self.add({.kind = InputEvent::Kind::move, .x = off_picture, .y = off_picture});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    // The press happened at the last mouse position of the events; asking GLFW now would give a
    // later position.
    of(w).add(
        {.kind = InputEvent::Kind::button, .button = button, .is_down = action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    // GLFW counts to the left.
    of(w).add(
        {.kind = InputEvent::Kind::wheel, .x = static_cast<float>(-x), .y = static_cast<float>(y)});
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) {
    GlfwWindow& self = of(w);
    self.measure();
    self.is_damaged_ = true;
    self.add({.kind = InputEvent::Kind::resize,
              .x = static_cast<float>(self.width_),
              .y = static_cast<float>(self.height_)});
  });
  glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) {
    GlfwWindow& self = of(w);
    self.is_damaged_ = true;
    self.add({.kind = InputEvent::Kind::resize,
              .x = static_cast<float>(self.width_),
              .y = static_cast<float>(self.height_)});
  });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w).is_damaged_ = true; });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int is_icon) {
    if (!is_icon) of(w).is_damaged_ = true;
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    for (int k = 0; k < count; ++k) of(w).add({.kind = InputEvent::Kind::drop, .text = paths[k]});
  });
  glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) {
    glfwSetWindowShouldClose(w, GLFW_FALSE);
    of(w).add({.kind = InputEvent::Kind::close});
  });
  listen_to_keys();
}

void GlfwWindow::listen_to_keys() {
  // GLFW lets go of held keys by itself when the window loses the focus.
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int) {
    if (action == GLFW_REPEAT) return;  // who needs repeats makes them
    const int printed = printed_key(key, scancode);
    if (printed <= 0) return;
    of(w).add({.kind = InputEvent::Kind::key, .key = printed, .is_down = action == GLFW_PRESS});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code_point) {
    of(w).add({.kind = InputEvent::Kind::text, .text = utf8(code_point)});
  });
}

}  // namespace

std::unique_ptr<Window> Window::open(const Options& options) {
  return std::make_unique<GlfwWindow>(options);
}

#else

std::unique_ptr<Window> Window::open(const Options&) {
  refuse("built without GLFW", "libglfw3-dev and build again with NEVE_WINDOW=ON");
}

#endif

}  // namespace neve::render
