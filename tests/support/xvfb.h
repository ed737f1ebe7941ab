#pragma once
/// A virtual display, with functions that move its mouse, type, and read its pixels.

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

extern "C" char** environ;

namespace neve::test {

/// Starts Xvfb on a free display and points DISPLAY to it, as long as it lives.
class Xvfb {
 public:
  Xvfb() {
    const std::string program = find_program("Xvfb");
    if (program.empty()) {
      reason_ = "Xvfb is not installed (Debian: xvfb)";
      return;
    }
    start(program);
    if (display_.empty()) {
      reason_ = "Xvfb does not start";
      return;
    }
    if (const char* before = std::getenv("DISPLAY")) display_before_ = before;
    setenv("DISPLAY", display_.c_str(), 1);
  }
  ~Xvfb() {
    if (!display_before_.empty()) setenv("DISPLAY", display_before_.c_str(), 1);
    if (display_before_.empty()) unsetenv("DISPLAY");
    if (process_ <= 0) return;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  Xvfb(const Xvfb&) = delete;
  Xvfb& operator=(const Xvfb&) = delete;

  /// "" or why there is no display.
  const std::string& reason() const { return reason_; }

 private:
  static std::string find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string rest = path ? path : "";
    while (!rest.empty()) {
      const std::size_t colon = rest.find(':');
      const std::string file = rest.substr(0, colon) + "/" + name;
      if (::access(file.c_str(), X_OK) == 0) return file;
      rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
    }
    return {};
  }

  void start(const std::string& program) {
    int pipe_ends[2] = {-1, -1};
    if (::pipe(pipe_ends) != 0) return;
    const std::string number = std::to_string(pipe_ends[1]);
    std::vector<std::string> words = {program,        "-displayfd", number, "-screen", "0",
                                      "1280x1024x24", "-nolisten",  "tcp",  "-noreset"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addclose(&actions, pipe_ends[0]);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&process_, program.c_str(), &actions, nullptr, argv.data(), environ) != 0)
      process_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe_ends[1]);
    // Its number and a new line, as soon as it listens; nothing when it ends before.
    std::string text;
    char c = 0;
    while (process_ > 0 && ::read(pipe_ends[0], &c, 1) == 1 && c != '\n') text += c;
    ::close(pipe_ends[0]);
    if (!text.empty()) display_ = ":" + text;
  }

  pid_t process_ = -1;
  std::string display_, display_before_, reason_;
};

/// Uses the display as hardware would, through libXtst, which is loaded if it is installed.
class XHand {
 public:
  XHand() {
    x11_ = dlopen("libX11.so.6", RTLD_NOW);
    xtst_ = dlopen("libXtst.so.6", RTLD_NOW);
    if (!x11_ || !xtst_) {
      reason_ = "libXtst.so.6 is not installed (Debian: libxtst6)";
      return;
    }
    display_ = call<void*(const char*)>(x11_, "XOpenDisplay")(nullptr);
    if (!display_) reason_ = "no X display";
  }
  ~XHand() {
    if (display_) call<int(void*)>(x11_, "XCloseDisplay")(display_);
  }
  XHand(const XHand&) = delete;
  XHand& operator=(const XHand&) = delete;

  const std::string& reason() const { return reason_; }

  void move(int x, int y) {
    call<int(void*, int, int, int, unsigned long)>(xtst_, "XTestFakeMotionEvent")(display_, -1, x,
                                                                                  y, 0);
    flush();
  }
  /// @param button of X: 1 left, 2 middle, 3 right, 4 and 5 wheel up and down, 6 and 7 left, right
  void button(int button, bool is_down) {
    call<int(void*, unsigned, int, unsigned long)>(xtst_, "XTestFakeButtonEvent")(
        display_, static_cast<unsigned>(button), is_down, 0);
    flush();
  }
  /// @param symbol of X, such as 'a' or 0xff1b for escape
  void key(unsigned long symbol, bool is_down) {
    const auto code =
        call<unsigned char(void*, unsigned long)>(x11_, "XKeysymToKeycode")(display_, symbol);
    call<int(void*, unsigned, int, unsigned long)>(xtst_, "XTestFakeKeyEvent")(display_, code,
                                                                               is_down, 0);
    flush();
  }
  void tap(unsigned long symbol) {
    key(symbol, true);
    key(symbol, false);
  }

  /// Resizes it as a window manager does when its border is dragged.
  void resize_newest_window(int width, int height) {
    const unsigned long window = newest_window();
    call<int(void*, unsigned long, unsigned, unsigned)>(x11_, "XResizeWindow")(
        display_, window, static_cast<unsigned>(width), static_cast<unsigned>(height));
    flush();
  }

  /// Pixels of the whole display, 0xrrggbb.
  unsigned long pixel(int x, int y) {
    using GetImage = void*(void*, unsigned long, int, int, unsigned, unsigned, unsigned long, int);
    constexpr int z_pixmap = 2;
    void* image = call<GetImage>(x11_, "XGetImage")(display_, root(), x, y, 1, 1, ~0ul, z_pixmap);
    if (!image) return ~0ul;
    const auto found = call<unsigned long(void*, int, int)>(x11_, "XGetPixel")(image, 0, 0);
    call<int(void*)>(x11_, "XDestroyImage")(image);
    return found & 0xffffff;
  }

 private:
  template <class F>
  static F* call(void* library, const char* name) {
    return reinterpret_cast<F*>(dlsym(library, name));
  }
  void flush() { call<int(void*, int)>(x11_, "XSync")(display_, 0); }
  unsigned long root() { return call<unsigned long(void*)>(x11_, "XDefaultRootWindow")(display_); }

  unsigned long newest_window() {
    unsigned long root_of = 0, parent = 0, *children = nullptr, newest = 0;
    unsigned count = 0;
    using Query =
        int(void*, unsigned long, unsigned long*, unsigned long*, unsigned long**, unsigned*);
    call<Query>(x11_, "XQueryTree")(display_, root(), &root_of, &parent, &children, &count);
    if (count > 0) newest = children[count - 1];
    if (children) call<int(void*)>(x11_, "XFree")(children);
    return newest;
  }

  void *x11_ = nullptr, *xtst_ = nullptr, *display_ = nullptr;
  std::string reason_;
};

}  // namespace neve::test
