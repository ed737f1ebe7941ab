/// EGL without display: on a device (GPU or software) and on Mesa's surfaceless platform.

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include "render/gl/context_backends.h"
#include "render/gl/gl.h"
#include "render/gl/shared_library.h"

namespace neve::render::gl {
namespace {

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

/// libEGL, loaded at run time so that neve starts where it is missing: one member per function,
/// without the egl prefix.
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

/// Loaded at the first call.
const Egl& egl() {
  static const Egl instance;
  return instance;
}

/// True if a name is among extensions separated by spaces. Compares whole words, because some names
/// are prefixes of others.
bool lists(const char* extensions, std::string_view name) {
  std::string_view rest = extensions ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

/// An initialised display. EGL hands out the same handle every time a display is asked for and
/// eglTerminate ends it for everyone, so users are counted.
class Display {
 public:
  Display() = default;
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  ~Display() {
    if (handle_ == EGL_NO_DISPLAY) return;
    std::lock_guard lock(mutex());
    if (--users()[handle_] == 0) egl().Terminate(handle_);
  }
  /// @return "" or why the display cannot be used
  std::string open(EGLDisplay handle) {
    if (handle == EGL_NO_DISPLAY) return "no display (" + egl().error() + ")";
    std::lock_guard lock(mutex());
    EGLint major = 0, minor = 0;
    if (!egl().Initialize(handle, &major, &minor))
      return "eglInitialize failed (" + egl().error() + ")";
    ++users()[handle];
    handle_ = handle;
    return {};
  }
  EGLDisplay handle() const { return handle_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  static std::map<EGLDisplay, int>& users() {
    static std::map<EGLDisplay, int> instance;
    return instance;
  }
  EGLDisplay handle_ = EGL_NO_DISPLAY;
};

class EglContext final : public Context {
 public:
  explicit EglContext(const char* name) { backend = name; }
  ~EglContext() override {
    if (context_ == EGL_NO_CONTEXT) return;
    if (egl().GetCurrentContext() == context_)
      egl().MakeCurrent(display_.handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) egl().DestroySurface(display_.handle(), surface_);
    egl().DestroyContext(display_.handle(), context_);
  }

  void make_current() override {
    egl().BindAPI(EGL_OPENGL_API);  // per thread
    if (!egl().MakeCurrent(display_.handle(), surface_, surface_, context_))
      throw std::runtime_error(backend + ": cannot make the context current, " + egl().error());
  }
  void* get_proc(const char* name) override {
    return reinterpret_cast<void*>(egl().GetProcAddress(name));
  }

  /// @return "" or why there is no context
  std::string open(EGLDisplay handle) {
    if (std::string reason = display_.open(handle); !reason.empty()) return reason;
    if (!egl().BindAPI(EGL_OPENGL_API)) return "no desktop OpenGL (" + egl().error() + ")";
    const EGLConfig config = choose_config();
    if (std::string reason = create_context(config); !reason.empty()) return reason;
    if (std::string reason = bind(config); !reason.empty()) return reason;
    return identify(*this);
  }

 private:
  EGLConfig choose_config() const {
    EGLConfig config = nullptr;
    for (const EGLint surface_type : {EGL_PBUFFER_BIT, 0}) {
      const EGLint wanted[] = {EGL_SURFACE_TYPE,
                               surface_type,
                               EGL_RENDERABLE_TYPE,
                               EGL_OPENGL_BIT,
                               EGL_RED_SIZE,
                               8,
                               EGL_GREEN_SIZE,
                               8,
                               EGL_BLUE_SIZE,
                               8,
                               EGL_ALPHA_SIZE,
                               8,
                               EGL_NONE};
      EGLint count = 0;
      if (egl().ChooseConfig(display_.handle(), wanted, &config, 1, &count) && count > 0)
        return config;
    }
    return EGL_NO_CONFIG_KHR;
  }

  std::string create_context(EGLConfig config) {
    for (const auto& [major, minor] : {std::array{4, 5}, std::array{4, 3}, std::array{3, 3}}) {
      const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                               major,
                               EGL_CONTEXT_MINOR_VERSION,
                               minor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
      context_ = egl().CreateContext(display_.handle(), config, EGL_NO_CONTEXT, wanted);
      if (context_ != EGL_NO_CONTEXT) return {};
    }
    return "no OpenGL 3.3 core context (" + egl().error() + ")";
  }

  /// Makes the context current without a surface, or with a tiny one where the driver wants one.
  std::string bind(EGLConfig config) {
    const char* extensions = egl().QueryString(display_.handle(), EGL_EXTENSIONS);
    if (lists(extensions, "EGL_KHR_surfaceless_context") &&
        egl().MakeCurrent(display_.handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      return {};
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    surface_ = egl().CreatePbufferSurface(display_.handle(), config, size);
    if (surface_ == EGL_NO_SURFACE) return "no pbuffer (" + egl().error() + ")";
    if (egl().MakeCurrent(display_.handle(), surface_, surface_, context_)) return {};
    return "eglMakeCurrent failed (" + egl().error() + ")";
  }

  Display display_;  // first: destroyed last
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

constexpr const char* loader_package = "libegl1";
constexpr const char* driver_packages = "libegl-mesa0 libgl1-mesa-dri";

/// @return a filled reason when EGL itself is not usable
Opened check_library() {
  if (!egl().library) return {nullptr, "libEGL.so.1 not found", loader_package};
  if (!egl().is_complete || !egl().GetPlatformDisplay)
    return {nullptr, "libEGL is too old", loader_package};
  return {};
}

/// Devices with hardware first, software last, otherwise in the order of the driver.
std::vector<EGLDeviceEXT> list_devices() {
  EGLint count = 0;
  if (!egl().QueryDevices || !egl().QueryDeviceString || !egl().QueryDevices(0, nullptr, &count))
    return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (count == 0 || !egl().QueryDevices(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  std::stable_partition(devices.begin(), devices.end(), [](EGLDeviceEXT device) {
    return !lists(egl().QueryDeviceString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  egl().GetError();  // asking a device what it does not know leaves an error behind
  return devices;
}

}  // namespace

Opened open_egl_device() {
  if (Opened bad = check_library(); !bad.reason.empty()) return bad;
  const char* client = egl().QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!lists(client, "EGL_EXT_platform_device") && !lists(client, "EGL_EXT_platform_base"))
    return {nullptr, "EGL has no device platform", driver_packages};
  const std::vector<EGLDeviceEXT> devices = list_devices();
  std::string reasons =
      std::to_string(devices.size()) + (devices.size() == 1 ? " device" : " devices");
  for (std::size_t i = 0; i < devices.size(); ++i) {
    auto context = std::make_unique<EglContext>("egl_device");
    const EGLDisplay display =
        egl().GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    const std::string reason = context->open(display);
    if (reason.empty()) return {std::move(context), {}, {}};
    reasons += ", device " + std::to_string(i) + ": " + reason;
  }
  return {nullptr, reasons, driver_packages};
}

Opened open_egl_surfaceless() {
  if (Opened bad = check_library(); !bad.reason.empty()) return bad;
  const char* client = egl().QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!lists(client, "EGL_MESA_platform_surfaceless"))
    return {nullptr, "EGL has no surfaceless platform", driver_packages};
  auto context = std::make_unique<EglContext>("egl_surfaceless");
  const EGLDisplay display =
      egl().GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (std::string reason = context->open(display); !reason.empty())
    return {nullptr, reason, driver_packages};
  return {std::move(context), {}, {}};
}

}  // namespace neve::render::gl
