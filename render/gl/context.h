#pragma once
/// OpenGL contexts: one backend per file, chosen at run time, every failure explained.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace neve::render::gl {

/// A current context of GL 3.3 core or newer. Destroying it releases everything.
class Context {
 public:
  virtual ~Context() = default;
  virtual void make_current() = 0;
  virtual void* get_proc(const char* name) = 0;

  std::string backend;   ///< egl_device, egl_surfaceless, osmesa, window
  std::string version;   ///< GL_VERSION
  std::string renderer;  ///< GL_RENDERER
  bool is_software = false;
};

/// Result of trying one backend.
struct Attempt {
  std::string backend;
  bool available = false;
  std::string version, renderer;
  bool is_software = false;
  std::string reason;   ///< why it is not available
  std::string install;  ///< packages that would help
};

/// No backend worked; what() lists the attempts and why each failed. Exit code 4.
struct ContextError : std::runtime_error {
  ContextError(const std::string& message, std::vector<Attempt> all)
      : std::runtime_error(message), attempts(std::move(all)) {}
  std::vector<Attempt> attempts;
};

/// Names that `--backend` takes: auto, egl, egl_device, egl_surfaceless, osmesa, window.
const std::vector<std::string>& backend_names();

/// Opens the first backend of the choice that works and makes it current.
/// @param choice one of backend_names(); auto never opens a window
/// @throws ContextError; std::invalid_argument for an unknown name
std::unique_ptr<Context> open_context(const std::string& choice);

/// Tries every backend, for doctor.
std::vector<Attempt> try_all_backends();

}  // namespace neve::render::gl
