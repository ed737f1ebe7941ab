#pragma once
/// Draws a Frame into an Image.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/channels/channels.h"
#include "render/frame/frame.h"
#include "render/frame/phase_time.h"
#include "render/gl/context.h"
#include "render/image/exr.h"
#include "render/image/image.h"
#include "sim/base/thread_pool.h"

namespace neve::render {

/// Renderer of particles, ground, smoke and the light on them: OpenGL, or the CPU (surfaces.h),
/// which is several times faster if OpenGL itself runs on the CPU. Automatic: the faster one for
/// each frame here, or the one named by the environment variable NEVE_PARTICLES: gl or cpu.
enum class ParticlePath { automatic, gl, cpu };

/// Way to read pictures back: through pixel buffers while the CPU works, or at once. Automatic:
/// buffered on a GPU.
enum class ReadBackWay { automatic, buffered, at_once };

/// NEVE_PARTICLES names no path.
struct ParticlePathError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Renderer {
 public:
  /// @param shader_dir reads shaders from there instead of the embedded ones when not empty
  /// @param pool shared worker threads for work on the CPU, may be null
  /// @throws std::runtime_error with the compiler's log when a shader does not build;
  /// ParticlePathError
  explicit Renderer(gl::Context& context, const std::string& shader_dir = {},
                    ThreadPool* pool = nullptr, ParticlePath path = ParticlePath::automatic,
                    ReadBackWay read_back = ReadBackWay::automatic);
  ~Renderer();

  /// Draws a frame: the same frame and driver give the same bytes.
  /// @param times if not null, takes the phases; then the driver has to finish each before the next
  Image draw(const Frame& frame, std::vector<PhaseTime>* times = nullptr);

  /// Draws a picture as channels of numbers, on the CPU whatever the path: without ghosts, lines,
  /// words and plots. The channels R, G, B and A, linear light before the tone mapping, are always
  /// there.
  /// @throws std::invalid_argument for a request that does not fit the frame
  ExrPicture draw_channels(const Frame& frame, const channels::Request& request);

  /// Draws over a picture in place of a background, on the CPU whatever the path: its grounds are
  /// seen only where a shadow falls on them. Without ghosts and lines.
  /// @param plate RGB, of the size of the frame
  Image draw_on_plate(const Frame& frame, const Image& plate);

  /// Draws without waiting for the picture: a GPU works on it while the next frame is prepared.
  void submit(const Frame& frame);
  /// Pictures submitted and not fetched.
  std::size_t pending() const;
  /// The oldest of them. @throws std::logic_error if there is no picture
  Image fetch();

  /// Draws without reading back: the picture stays where copy_picture finds it.
  void paint(const Frame& frame);
  /// Copies the finished picture into a framebuffer of the same context, scaled to its place.
  /// @param framebuffer its OpenGL name
  /// @param x, y  px, lower left corner of the place
  void copy_picture(unsigned framebuffer, int x, int y, int width, int height);

  /// Returns the path of particles drawn as spheres, which is never automatic.
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
