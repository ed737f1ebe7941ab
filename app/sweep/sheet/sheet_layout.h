#pragma once
/// Layout of the tiles and words of a contact sheet; the same in every frame.

#include <string>
#include <vector>

#include "app/sweep/sheet/seals.h"
#include "app/sweep/sheet/tile_words.h"
#include "app/sweep/store/manifest.h"
#include "render/frame/frame.h"

namespace neve::app::sweep::sheet {

/// Width of a letter, as a share of the height of its line, about.
inline constexpr double letter_width = 0.56;

/// Words that a sheet needs room for beside its pictures and their values.
struct SheetWords {
  Seals seals{};          ///< below the picture of each tile, and their key below all
  std::string heading{};  ///< below the title
};

/// Letters of a font, px, that fit side by side on a tile or a sheet of a width, px.
std::size_t letters_in(double width, double font_size);

/// px, of the rows below a picture.
int rows_height(int rows, int font_size);

struct SheetTile {
  std::size_t run = 0;
  int x = 0, y = 0;  ///< px, of its upper left corner
};

struct SheetLayout {
  int width = 0, height = 0;            ///< px
  int tile_width = 0, tile_height = 0;  ///< px, of a picture
  int label_height = 0;                 ///< px, above each picture; 0: words of a line are on it
  int seal_height = 0;                  ///< px, below each picture; 0 without noise
  int font_size = 16;                   ///< px
  int header = 0;                       ///< px, above the labels
  std::vector<KeyLine> key;             ///< lines below the tiles that explain noise
  int key_height = 0;                   ///< px
  bool has_edges = false;               ///< the axes are along the edges
  WordRoom words;                       ///< on a tile
  std::vector<SheetTile> tiles;
  std::vector<render::Note> labels;     ///< along the edges
  std::vector<render::Patch> brackets;  ///< beside rows that share an outer value
};

/// Two axes go down and across; further ones are put around them, outermost first, on whichever
/// side is shorter, and set apart by wider gaps. Sheets of one axis with many values and of runs
/// without axes are wrapped. Tiles shrink until the sheet fits.
/// @param has_legend keeps room for it on the right
/// @param largest side of a picture, px
SheetLayout layout_sheet(const store::Manifest& manifest, bool has_legend, int largest,
                         const SheetWords& words = {});

/// Runs that share a picture.
struct SheetPage {
  std::size_t first = 0, count = 0;  ///< runs of the manifest
  SheetLayout layout;                ///< its tiles name runs of the manifest
};

/// Lays out one page if all runs fit into a picture, otherwise as many as it takes: without axes
/// along their edges, so that each tile names its own values.
std::vector<SheetPage> layout_pages(const store::Manifest& manifest, bool has_legend, int largest,
                                    const SheetWords& words = {});

/// True if a sheet of this layout can be a picture.
bool fits(const SheetLayout& layout, int largest);

}  // namespace neve::app::sweep::sheet
