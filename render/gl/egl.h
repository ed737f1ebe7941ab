#pragma once
/// libEGL, loaded at run time so that neve starts where it is missing.

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <string_view>

#include "render/gl/shared_library.h"

namespace neve::render::gl {

// NOLINTBEGIN(bugprone-macro-parentheses): names cannot be put in parentheses
#define NEVE_EGL_FUNCTIONS(X) \
  X(BindAPI)                  \
  X(ChooseConfig)             \
  X(CreateContext)            \
  X(CreatePbufferSurface)     \
  X(DestroyContext)           \
  X(DestroySurface)           \
  X(GetCurrentContext)        \
  X(GetError)                 \
  X(GetProcAddress)           \
  X(Initialize)               \
  X(MakeCurrent)              \
  X(QueryString)              \
  X(Terminate)

/// One member per function, without the egl prefix.
struct Egl {
  SharedLibrary library{"libEGL.so.1", "libEGL.so"};
#define NEVE_EGL_MEMBER(name) decltype(&egl##name) name = nullptr;
  NEVE_EGL_FUNCTIONS(NEVE_EGL_MEMBER)
#undef NEVE_EGL_MEMBER
  // NOLINTEND(bugprone-macro-parentheses)
  // Extensions; null if the library does not have them.
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
  bool is_complete = false;  ///< all but the extensions are there

  Egl();
  /// The last error of this thread, for messages.
  std::string error() const;
};

/// Loaded at the first call.
const Egl& egl();

/// True if a name is among extensions separated by spaces. Compares whole words, because some names
/// are prefixes of others.
bool lists(const char* extensions, std::string_view name);

}  // namespace neve::render::gl
