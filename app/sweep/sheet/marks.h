#pragma once
/// Marks of noise on sheets: whiskers on a rail and letters of groups, on tiles and in the key that
/// explains them.

#include <array>
#include <cstdint>
#include <string>

#include "render/frame/frame.h"

namespace neve::app::sweep::sheet {

/// sRGB of groups, of equal lightness, again and again.
inline constexpr std::array<std::array<std::uint8_t, 3>, 6> group_colours{
    {{46, 117, 182}, {178, 92, 32}, {58, 132, 80}, {148, 84, 158}, {128, 116, 40}, {170, 70, 96}}};

/// sRGB of words on tiles.
inline constexpr std::array<std::uint8_t, 3> seal_ink{240, 244, 250}, seal_grey{190, 199, 212},
    seal_caution{255, 205, 96};

/// sRGB and alpha of whiskers.
inline constexpr std::array<std::uint8_t, 4> white_whisker{240, 244, 250, 255},
    grey_whisker{142, 150, 162, 255}, coarse_whisker{108, 172, 228, 255};

/// Width of a square with a letter, in sizes of the font.
inline constexpr float square_width = 1.5f;

/// Places on a scale, 0 to 1.
struct WhiskerSpan {
  double min = 0, mean = 0, max = 0;
};

/// A rail with a bar from min to max and a square at the mean.
/// @param y  upper edge of the line of text that it is in, px @param size  of the font, px
void draw_whisker_mark(const WhiskerSpan& span, float left, float length, float y, float size,
                       const std::array<std::uint8_t, 4>& color, render::Frame& words);

/// A square in the colour of a group. @param width  px
void draw_square(const std::string& letters, int group, float left, float y, float width,
                 float size, render::Frame& words);

}  // namespace neve::app::sweep::sheet
