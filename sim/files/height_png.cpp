// zlib and the five filters of PNG rather than stb_image, which render has: sim knows no pictures,
// and what a stranger's file unpacks to is bounded here by what its header says.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "sim/files/height_grid.h"
#include "sim/files/height_reader.h"
#include "sim/files/input_file.h"
#include "sim/types/number_text.h"

namespace neve::sim::files {
namespace {

constexpr std::size_t signature = 8, header_end = 33;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t k = at; k < at + 4; ++k)
    number = number << 8 | static_cast<unsigned char>(bytes[k]);
  return number;
}

/// @throws ShapeError for pictures that are no heights
void read_header(std::string_view bytes, const std::string& name, HeightGrid& grid) {
  if (bytes.size() < header_end || bytes.substr(12, 4) != "IHDR")
    refuse_input(name, "the PNG is damaged: it does not begin with its size");
  grid.columns = number_at(bytes, 16);
  grid.rows = number_at(bytes, 20);
  const auto byte_at = [&](std::size_t at) -> int { return static_cast<unsigned char>(bytes[at]); };
  const int bits = byte_at(24), colour = byte_at(25), interlace = byte_at(28);
  const double posts = static_cast<double>(grid.columns) * static_cast<double>(grid.rows);
  if (grid.columns < 2 || grid.rows < 2 || posts > max_posts)
    refuse_input(name, std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                           " pixels; expected 2 or more a side, and at most 1e8 in all");
  if (bits != 16 || colour != 0)
    refuse_input(name, std::string("a PNG of ") + std::to_string(bits) + " bits" +
                           (colour == 0 ? "" : ", not grey") +
                           "; expected grey with 16 bits, whose steps are fine enough for ground. "
                           "Save it so, or make an ESRI ASCII grid: gdal_translate -of AAIGrid");
  if (interlace != 0) refuse_input(name, "the PNG is interlaced; save it without interlacing");
}

/// All of the packed data, unpacked to exactly the bytes that the header names.
std::vector<std::uint8_t> unpacked(std::string_view bytes, const std::string& name,
                                   std::size_t expected) {
  std::size_t packed = 0;
  std::vector<std::string_view> parts;
  for (std::size_t at = signature; at + 12 <= bytes.size();) {
    const std::size_t length = number_at(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - 12) break;
    if (type == "IDAT") parts.push_back(bytes.substr(at + 8, length));
    if (type == "IDAT") packed += length;
    if (type == "IEND") break;
    at += length + 12;
  }
  constexpr std::size_t best_deflate = 1032;  // bytes that one byte of deflate can become
  const auto refuse_short = [&] {
    refuse_input(name, "the PNG is damaged: its data end before the last pixel");
  };
  if (expected / best_deflate > packed) refuse_short();
  std::vector<std::uint8_t> out(expected);
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  int state = Z_OK;
  for (const std::string_view part : parts) {
    if (state != Z_OK) break;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
    stream.avail_in = static_cast<uInt>(part.size());
    while (stream.avail_in > 0 && state == Z_OK) state = inflate(&stream, Z_NO_FLUSH);
  }
  const bool is_whole = stream.avail_out == 0;
  inflateEnd(&stream);
  if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
    refuse_input(name, "the PNG is damaged: its data cannot be unpacked");
  if (!is_whole) refuse_short();
  return out;
}

/// The predictor that is nearest to left + up - corner. Source: PNG specification, 9.4.
int paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left), to_up = std::abs(guess - up),
            to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return left;
  return to_up <= to_corner ? up : corner;
}

/// Undoes the filter of a row in place. @param before  the row above; null: the first one
bool undo_filter(int filter, std::uint8_t* row, const std::uint8_t* before, std::size_t length) {
  constexpr std::size_t pixel = 2;
  if (filter > 4) return false;
  for (std::size_t k = 0; k < length; ++k) {
    const int left = k < pixel ? 0 : row[k - pixel], up = before ? before[k] : 0;
    const int corner = before && k >= pixel ? before[k - pixel] : 0;
    const int guess = filter == 1   ? left
                      : filter == 2 ? up
                      : filter == 3 ? (left + up) / 2
                      : filter == 4 ? paeth(left, up, corner)
                                    : 0;
    row[k] = static_cast<std::uint8_t>(row[k] + guess);
  }
  return true;
}

}  // namespace

HeightGrid parse_height_png(std::string_view bytes, const std::string& name,
                            const HeightScale& scale) {
  HeightGrid grid;
  read_header(bytes, name, grid);
  if (!(scale.spacing > 0))
    refuse_input(name, "a PNG does not say how far its pixels are apart; give spacing, in metres");
  if (!(scale.high != scale.low))
    refuse_input(name,
                 "a PNG does not say how high its pixels are; give low and high, the heights in "
                 "metres of black and white");
  grid.spacing = scale.spacing;
  grid.west = -0.5 * scale.spacing * static_cast<double>(grid.columns - 1);
  grid.north = 0.5 * scale.spacing * static_cast<double>(grid.rows - 1);
  const std::size_t length = 2 * grid.columns, stride = length + 1;
  std::vector<std::uint8_t> rows = unpacked(bytes, name, stride * grid.rows);
  grid.datum = std::round(0.5 * (scale.low + scale.high));
  const auto height = [&](double value) {
    return scale.low - grid.datum + (scale.high - scale.low) * value / 65535;
  };
  grid.height.resize(grid.columns * grid.rows);
  grid.lowest = INFINITY;
  grid.highest = -INFINITY;
  for (std::size_t r = 0; r < grid.rows; ++r) {
    std::uint8_t* row = rows.data() + r * stride + 1;
    if (!undo_filter(row[-1], row, r > 0 ? row - stride : nullptr, length))
      refuse_input(name, "the PNG is damaged: row " + std::to_string(r + 1) + " has no filter");
    for (std::size_t c = 0; c < grid.columns; ++c) {
      const double above = height(256.0 * row[2 * c] + row[2 * c + 1]);
      grid.height[r * grid.columns + c] = static_cast<float>(above);
      grid.lowest = std::min(grid.lowest, above);
      grid.highest = std::max(grid.highest, above);
    }
  }
  return grid;
}

}  // namespace neve::sim::files
