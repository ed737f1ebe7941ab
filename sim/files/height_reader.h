#pragma once
/// Height fields from files: ESRI ASCII grids and PNG pictures of 16 bits, told apart by what is in
/// them.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace neve::sim::files {

/// Heights of posts on a square grid, seen on a map: rows from north to south, in each from west to
/// east.
struct HeightGrid {
  std::size_t columns = 0, rows = 0;  ///< at least 2
  double spacing = 0;                 ///< m, from post to post
  double west = 0, north = 0;         ///< m, coordinates of the first post
  double datum = 0;                   ///< m, the middle of the heights
  std::vector<float> height;          ///< m above datum; NaN: there is no data
  double lowest = 0, highest = 0;     ///< m above datum

  float at(std::size_t column, std::size_t row) const { return height[row * columns + column]; }
};

/// Measures that a picture does not have in itself.
struct HeightScale {
  double spacing = 0;        ///< m, from post to post; 0: not given
  double low = 0, high = 0;  ///< m, of the values 0 and 65535; equal: not given
};

/// Refusals of neither kind; a GeoTIFF is told by its first bytes.
/// @param name of the file in messages
/// @throws ShapeError
HeightGrid parse_heights(std::string_view bytes, const std::string& name, const HeightScale& scale);

/// Keys ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize and, if wanted,
/// NODATA_value, in any order and case; then ncols * nrows numbers between blanks, however they are
/// broken into lines. A corner is that of a cell, whose post is in its middle. Independent of the
/// locale.
/// @throws ShapeError NAME:LINE: ... for a header that is incomplete or out of range, too few or
/// too
///         many numbers, numbers that are none, and where no post has data. Counts are compared
///         with the length of the text before anything is allocated
HeightGrid parse_ascii_grid(std::string_view text, const std::string& name);

/// Grey, 16 bits, not interlaced; the middle of the picture has the coordinates 0, 0.
/// @throws ShapeError for other pictures, damaged ones, and a scale that is not given
HeightGrid parse_height_png(std::string_view bytes, const std::string& name,
                            const HeightScale& scale);

/// @throws ShapeError also when the file cannot be read or is larger than 1 GiB
HeightGrid read_heights(const std::string& path, const HeightScale& scale);

/// True if a file is read by a scale; a grid has its own, and takes none.
bool takes_scale(const std::string& path);

/// Bytes that reading a file takes at most, of which a third or less stays: from its size and its
/// first bytes. 0: it cannot be read.
double memory_of_heights(const std::string& path);

}  // namespace neve::sim::files
