#pragma once
/// Pictures beside each other or wiped into one, under a strip of words.

#include <array>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "render/renderer.h"

namespace neve::app::compare {

/// Words about one of the two runs.
struct StripWords {
  std::string title;   ///< "A   out/soft"
  std::string values;  ///< "hardening = 5"
};

/// Of the picture that with_strip() makes of so many images of this size.
scene::PictureSize size_with_strip(const scene::PictureSize& image, int count);

/// @param images  of one size: two beside each other, or one that shows both
/// @param line    below them
/// @param colors  of the titles
render::Image with_strip(const std::vector<render::Image>& images,
                         const std::array<StripWords, 2>& words, const std::string& line,
                         render::Renderer& renderer);

/// A picture of the left part of one and the right part of another of its size.
/// @param share  of the width that is from the left one, 0 to 1
render::Image wiped(const render::Image& left, const render::Image& right, double share);

/// Without alpha: over a plain colour.
render::Image opaque(render::Image image);

}  // namespace neve::app::compare
