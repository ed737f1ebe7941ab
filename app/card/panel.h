#pragma once
/// An experiment on a card: a small picture, a curve, and words.

#include <array>
#include <cstdint>
#include <vector>

#include "app/card/experiment.h"
#include "render/frame/compose.h"
#include "render/renderer.h"

namespace neve::app::card {

inline constexpr int panel_width = 500, panel_height = 316;  ///< px
inline constexpr int card_font = 16;                         ///< px
inline constexpr std::array<std::uint8_t, 3> card_ground{30, 33, 39}, card_bright{240, 244, 250},
    card_soft{175, 184, 198};  ///< sRGB

/// The axes of a kind of experiment, the same on all cards.
struct Axes {
  double x_end = 1, low = 0, high = 1;  ///< in shown units
  double y_scale = 1;                   ///< shown units per SI unit
  const char* y_unit = "";
};
Axes axes_of(const std::vector<const Experiment*>& experiments);

/// Adds its pictures to the tiles and its words to those of the whole.
/// @param x, y    px, upper left corner
/// @param others  of the same kind on other cards: their curves lie faintly behind its own
void add_panel(const Experiment& experiment, const std::vector<const Experiment*>& others,
               const Axes& axes, int x, int y, render::Renderer& renderer,
               std::vector<render::Tile>& tiles, render::Frame& words);

}  // namespace neve::app::card
