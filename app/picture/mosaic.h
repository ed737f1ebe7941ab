#pragma once
/// Several views in one picture, under one caption.

#include <functional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/setup/mosaic_layout.h"
#include "render/renderer.h"

namespace neve::app::picture {

/// Builds the frame of a view; with rings, cause and remedy if the run diverged.
using BuildFrame = std::function<render::Frame(const scene::View& view)>;

/// Draws the frame of a view.
using DrawFrame = std::function<render::Image(const scene::View& view, const render::Frame& frame)>;

/// @param caption  of all views; empty: there is none, and views have no names
/// @param caption_lines  that have room, see setup::caption_lines
/// @param draw  draws each tile
render::Image draw_mosaic(const scene::Scene& scene, const scene::Mosaic& mosaic,
                          const BuildFrame& build, const std::vector<std::string>& caption,
                          int caption_lines, render::Renderer& renderer,
                          const DrawFrame& draw = {});

}  // namespace neve::app::picture
