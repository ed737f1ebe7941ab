#pragma once
/// The key below a sheet: each mark of its tiles, drawn as there, and what it means.

#include <string>
#include <vector>

#include "render/frame/frame.h"

namespace neve::app::sweep::sheet {

struct KeyLine {
  enum class Mark {
    none,
    apart,         ///< two letters
    together,      ///< twice the same letter
    whisker,       ///< white
    grey_whisker,  ///< of noise
    coarse,        ///< blue whisker
    full,          ///< the mark of tiles at full resolution
    doubt          ///< yellow words
  };
  Mark mark = Mark::none;
  std::string text;
};

/// The same in lines that fit: further ones have no mark.
/// @param width  of the sheet, px @param size  of its font, px
std::vector<KeyLine> wrapped_key(const std::vector<KeyLine>& key, int width, int size);

/// px, of so many lines with the space around them.
int key_height(std::size_t lines, int size);

/// @param lines  that fit @param top  px
void draw_key(const std::vector<KeyLine>& lines, float top, float width, float size,
              render::Frame& words);

}  // namespace neve::app::sweep::sheet
