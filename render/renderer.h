#pragma once
/// Draws a Frame into an Image.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/context.h"
#include "render/frame.h"
#include "render/image.h"
#include "sim/base/thread_pool.h"

namespace neve::render {

/// What draws the particles: OpenGL, or the CPU (splat.h), which is several times faster where
/// OpenGL itself runs on the CPU. Automatic: whichever is faster here, or what the environment
/// variable NEVE_PARTICLES names: gl or cpu.
enum class ParticlePath { automatic, gl, cpu };

/// NEVE_PARTICLES names no path.
struct ParticlePathError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How long a phase of a picture took.
struct PhaseTime {
  const char* phase;  ///< light, particles, solids, slices, smoke, shade, overlay, read_back
  double seconds;
};

class Renderer {
 public:
  /// @param shader_dir reads shaders from there instead of the embedded ones when not empty
  /// @param pool shared worker threads for work on the CPU, may be null
  /// @throws std::runtime_error with the compiler's log when a shader does not build;
  /// ParticlePathError
  explicit Renderer(Context& context, const std::string& shader_dir = {},
                    ThreadPool* pool = nullptr, ParticlePath path = ParticlePath::automatic);
  ~Renderer();

  /// Same frame, same driver: same bytes.
  /// @param times if not null, takes the phases; then the driver has to finish each before the next
  Image draw(const Frame& frame, std::vector<PhaseTime>* times = nullptr);

  /// Never automatic.
  ParticlePath particle_path() const;

  /// Lays only caption, legends, plots and marks of the frame over an RGB picture of its size.
  Image draw_over(const Image& picture, const Frame& frame);

  /// Largest picture side that the context can draw.
  int max_size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace neve::render
