#pragma once
/// Finished pictures from the context to memory.

#include <cstdint>
#include <deque>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/image/image.h"

namespace neve::render::gl {

class ReadBack {
 public:
  /// @param is_buffered through pixel buffers, which a GPU fills while the CPU works; otherwise at
  /// once, which saves a copy where OpenGL itself runs on the CPU
  ReadBack(const Gl& gl, bool is_buffered) : gl_(gl), is_buffered_(is_buffered) {}

  /// Begins to read colour attachment 0 of the framebuffer that is bound.
  void begin(int width, int height, bool has_alpha);

  std::size_t pending() const { return copies_.size(); }

  /// The one that was begun first; waits for it. Upright, with straight alpha or none.
  /// @throws std::logic_error when none is pending
  Image finish_oldest();
  /// The one that was begun last.
  Image finish_newest();

 private:
  struct Copy {
    int width = 0, height = 0;
    bool has_alpha = false;
    Buffer buffer;                   ///< buffered
    std::vector<std::uint8_t> rgba;  ///< at once
  };
  Image finish(Copy copy);

  const Gl& gl_;
  bool is_buffered_;
  std::deque<Copy> copies_;
  std::vector<Buffer> spare_;  ///< that were read, to be filled again
};

}  // namespace neve::render::gl
