/// OSMesa: software rendering without EGL, display or device. The library exports every gl* symbol
/// and would shadow libGL if it were linked, so it is only ever opened at run time.

#include <array>

#include "render/gl/context_backends.h"
#include "render/gl/gl.h"
#include "render/gl/shared_library.h"

namespace neve::render::gl {

#ifdef NEVE_WITH_OSMESA
namespace {

// The library is optional at build time too: these are the declarations of GL/osmesa.h in use.
using OsmesaHandle = struct osmesa_context*;
constexpr int osmesa_format = 0x22, osmesa_depth_bits = 0x30, osmesa_stencil_bits = 0x31,
              osmesa_accum_bits = 0x32, osmesa_profile = 0x33, osmesa_core_profile = 0x34,
              osmesa_major_version = 0x36, osmesa_minor_version = 0x37;

struct Osmesa {
  SharedLibrary library{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  OsmesaHandle (*create)(const int*, OsmesaHandle) = nullptr;
  GLboolean (*make_current)(OsmesaHandle, void*, GLenum, GLsizei, GLsizei) = nullptr;
  void (*destroy)(OsmesaHandle) = nullptr;
  OsmesaHandle (*current)() = nullptr;
  void (*(*get_proc)(const char*))() = nullptr;

  Osmesa() {
    if (!library) return;
    create = library.find<decltype(create)>("OSMesaCreateContextAttribs");
    make_current = library.find<decltype(make_current)>("OSMesaMakeCurrent");
    destroy = library.find<decltype(destroy)>("OSMesaDestroyContext");
    current = library.find<decltype(current)>("OSMesaGetCurrentContext");
    get_proc = library.find<decltype(get_proc)>("OSMesaGetProcAddress");
  }
  bool is_complete() const { return create && make_current && destroy && current && get_proc; }
};

const Osmesa& osmesa() {
  static const Osmesa instance;
  return instance;
}

class OsmesaContext final : public Context {
 public:
  explicit OsmesaContext(OsmesaHandle handle) : handle_(handle) { backend = "osmesa"; }
  ~OsmesaContext() override {
    if (osmesa().current() == handle_) osmesa().make_current(nullptr, nullptr, 0, 0, 0);
    osmesa().destroy(handle_);
  }
  void make_current() override {
    if (!try_make_current()) throw std::runtime_error("osmesa: cannot make the context current");
  }
  void* get_proc(const char* name) override {
    return reinterpret_cast<void*>(osmesa().get_proc(name));
  }
  bool try_make_current() {
    return osmesa().make_current(handle_, dummy_.data(), GL_UNSIGNED_BYTE, dummy_side, dummy_side);
  }

 private:
  // OSMesa insists on a target in memory; neve draws into a framebuffer of its own.
  static constexpr int dummy_side = 16;
  std::array<unsigned char, dummy_side * dummy_side * 4> dummy_{};
  OsmesaHandle handle_;
};

OsmesaHandle create_newest() {
  for (const auto& [major, minor] : {std::array{4, 5}, std::array{4, 3}, std::array{3, 3}}) {
    const int attributes[] = {osmesa_format,
                              GL_RGBA,
                              osmesa_depth_bits,
                              0,
                              osmesa_stencil_bits,
                              0,
                              osmesa_accum_bits,
                              0,
                              osmesa_profile,
                              osmesa_core_profile,
                              osmesa_major_version,
                              major,
                              osmesa_minor_version,
                              minor,
                              0};
    if (OsmesaHandle handle = osmesa().create(attributes, nullptr)) return handle;
  }
  return nullptr;
}

}  // namespace

Opened open_osmesa() {
  const std::string package = "libosmesa6";
  if (!osmesa().library) return {nullptr, "libOSMesa.so.8 not found", package};
  if (!osmesa().is_complete()) return {nullptr, "libOSMesa is too old", package};
  OsmesaHandle handle = create_newest();
  if (!handle) return {nullptr, "no OpenGL 3.3 core context", package};
  auto context = std::make_unique<OsmesaContext>(handle);
  if (!context->try_make_current()) return {nullptr, "OSMesaMakeCurrent failed", {}};
  if (std::string reason = identify(*context); !reason.empty()) return {nullptr, reason, package};
  return {std::move(context), {}, {}};
}

#else

Opened open_osmesa() {
  return {nullptr, "built without (NEVE_OSMESA=OFF)", {}};
}

#endif

}  // namespace neve::render::gl
