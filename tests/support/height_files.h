#pragma once
/// Files of height fields.

#include <zlib.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace neve::test {

inline std::string png_number(std::uint32_t n) {
  return {static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8),
          static_cast<char>(n)};
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto crc =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return png_number(static_cast<std::uint32_t>(data.size())) + body +
         png_number(static_cast<std::uint32_t>(crc));
}

/// A grey PNG of 16 bits whose rows use the five filters in turns.
/// @param value  of a column and a row, 0 to 65535
template <class Value>
std::string height_png(int columns, int rows, const Value& value) {
  const auto byte = [&](int k, int row) {
    if (k < 0 || row < 0) return 0;
    const int v = value(k / 2, row);
    return k % 2 == 0 ? v >> 8 : v & 255;
  };
  std::string plain;
  for (int row = 0; row < rows; ++row) {
    const int filter = row % 5;
    plain += static_cast<char>(filter);
    for (int k = 0; k < 2 * columns; ++k) {
      const int left = byte(k - 2, row), up = byte(k, row - 1), corner = byte(k - 2, row - 1);
      const int guess = left + up - corner;
      const int a = std::abs(guess - left), b = std::abs(guess - up), c = std::abs(guess - corner);
      const int paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      const int guesses[] = {0, left, up, (left + up) / 2, paeth};
      plain += static_cast<char>(byte(k, row) - guesses[filter]);
    }
  }
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(plain.data()), static_cast<uLong>(plain.size()));
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", png_number(static_cast<std::uint32_t>(columns)) +
                               png_number(static_cast<std::uint32_t>(rows)) +
                               std::string("\x10\0\0\0\0", 5)) +
         png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

/// An ESRI ASCII grid whose north-west post is at the coordinates 0, 0.
/// @param height  m, of x (east) and z (south)
template <class Height>
std::string height_grid(int columns, int rows, double spacing, const Height& height) {
  std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                     "\nxllcenter 0\nyllcenter " + std::to_string(-spacing * (rows - 1)) +
                     "\ncellsize " + std::to_string(spacing) + "\n";
  char number[32];
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      std::snprintf(number, sizeof number, "%.9g", height(spacing * c, spacing * r));
      text += number;
      text += c + 1 < columns ? ' ' : '\n';
    }
  return text;
}

}  // namespace neve::test
