#include "render/gl/gl.h"

#include <cstdio>
#include <stdexcept>

namespace neve::render::gl {
namespace {

// dlsym and its relatives return void*, and C++ has no portable cast from there to a function.
template <class Function>
Function as_function(void* address) {
  static_assert(sizeof(Function) == sizeof(void*));
  return reinterpret_cast<Function>(address);
}

bool draws_on_cpu(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SWR"}) {
    if (renderer.find(name) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

Gl load_gl(Context& context) {
  Gl gl;
#define NEVE_GL_LOAD(type, name)                             \
  gl.name = as_function<type>(context.get_proc("gl" #name)); \
  if (!gl.name) throw std::runtime_error("OpenGL driver has no gl" #name);
  NEVE_GL_FUNCTIONS(NEVE_GL_LOAD)
#undef NEVE_GL_LOAD
  return gl;
}

std::string identify(Context& context) {
  const auto get_string = as_function<PFNGLGETSTRINGPROC>(context.get_proc("glGetString"));
  if (!get_string) return "the driver has no glGetString";
  const auto* version = reinterpret_cast<const char*>(get_string(GL_VERSION));
  const auto* renderer = reinterpret_cast<const char*>(get_string(GL_RENDERER));
  if (!version || !renderer) return "the context answers no query";
  context.version = version;
  context.renderer = renderer;
  context.is_software = draws_on_cpu(context.renderer);
  int major = 0, minor = 0;
  if (std::sscanf(version, "%d.%d", &major, &minor) != 2 || major * 10 + minor < 33) {
    return "OpenGL " + context.version + " is older than 3.3";
  }
  return {};
}

}  // namespace neve::render::gl
