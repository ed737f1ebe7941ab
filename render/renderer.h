#pragma once
/// Draws a Frame into an Image.

#include <memory>
#include <string>

#include "render/context.h"
#include "render/frame.h"
#include "render/image.h"
#include "sim/base/thread_pool.h"

namespace neve::render {

class Renderer {
 public:
  /// @param shader_dir reads shaders from there instead of the embedded ones when not empty
  /// @param pool shared worker threads for work on the CPU, may be null
  /// @throws std::runtime_error with the compiler's log when a shader does not build
  explicit Renderer(Context& context, const std::string& shader_dir = {},
                    ThreadPool* pool = nullptr);
  ~Renderer();

  /// Same frame, same driver: same bytes.
  Image draw(const Frame& frame);

  /// Largest picture side that the context can draw.
  int max_size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace neve::render
