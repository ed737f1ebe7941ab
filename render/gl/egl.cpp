#include "render/gl/egl.h"

#include <algorithm>
#include <cstdio>

namespace neve::render::gl {

Egl::Egl() {
  if (!library) return;
  is_complete = true;
#define NEVE_EGL_LOAD(name)                         \
  name = library.find<decltype(name)>("egl" #name); \
  is_complete = is_complete && name != nullptr;
  NEVE_EGL_FUNCTIONS(NEVE_EGL_LOAD)
#undef NEVE_EGL_LOAD
  if (!is_complete) return;
  GetPlatformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(GetProcAddress("eglGetPlatformDisplayEXT"));
  QueryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(GetProcAddress("eglQueryDevicesEXT"));
  QueryDeviceString =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(GetProcAddress("eglQueryDeviceStringEXT"));
}

std::string Egl::error() const {
  char text[32];
  std::snprintf(text, sizeof text, "error 0x%x", static_cast<unsigned>(GetError()));
  return text;
}

const Egl& egl() {
  static const Egl instance;
  return instance;
}

bool lists(const char* extensions, std::string_view name) {
  std::string_view rest = extensions ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

}  // namespace neve::render::gl
