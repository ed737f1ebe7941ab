#pragma once
/// The slate of shot.slate: a picture of words before the first picture of a view.

#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "render/renderer.h"

namespace neve::app::run {

/// Words of a slate besides those of the scene.
struct SlateWords {
  int number = 0;                       ///< of the slate
  std::string view;                     ///< or mosaic
  std::vector<std::string> parameters;  ///< lines, see picture::FrameBuilder::slate
};

/// @param like  a picture of the view: its size and channels
render::Image draw_slate(const scene::Scene& scene, const SlateWords& words,
                         const render::Image& like, render::Renderer& renderer);

}  // namespace neve::app::run
