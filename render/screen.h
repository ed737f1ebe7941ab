#pragma once
/// Contents of a window or a web page: the last picture, scaled to its place, and panels drawn with
/// Dear ImGui over it.

#include <memory>
#include <string>

#include "render/gl/context.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace neve::render {

/// Place of the picture on the screen, px from the upper left corner.
struct PicturePlace {
  int x = 0, y = 0, width = 0, height = 0;
};

class Screen {
 public:
  explicit Screen(gl::Context& context, const std::string& shader_dir = {});
  ~Screen();

  /// Makes the panels' ImGui context the current one: for input, between pictures.
  void select_panels();

  /// Starts a picture: panels are called between this and end().
  /// @param font_size of panels, px
  /// @param seconds since the last time, for ImGui
  void begin(int width, int height, int font_size, float seconds);

  /// Draws the panels over the last picture of the renderer, scaled to its place.
  void end(Renderer& renderer, const PicturePlace& place);
  /// The same over any RGB picture. @param picture  none without pixels
  void end(const Image& picture, const PicturePlace& place);

  /// The last drawing, upright RGB.
  Image pixels();

  /// Copies the last picture to the window of the context. The caller swaps its buffers.
  void present();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace neve::render
