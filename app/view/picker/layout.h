#pragma once
/// Places of the parts of the screen: on a desk the words are beside the tiles, on a phone held
/// upright below them.

#include "app/view/picker/tile_movies.h"

namespace neve::app::view::picker {

struct Box {
  float x = 0, y = 0, width = 0, height = 0;  ///< px
};

struct Layout {
  bool is_stacked = false;
  Box bar, axes, words;
  Box buttons;  ///< of a phone; on a desk they are in the bar
  Grid grid;
};

/// @param em    text size, px
/// @param axes  rows for the values of tiles
/// @param tile_width, tile_height of the pictures, for their shape
Layout lay_out(int width, int height, float em, int axes, int tile_width, int tile_height);

}  // namespace neve::app::view::picker
