#pragma once
/// Pictures as pixels and as PNG bytes with text in them.

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace neve::render {

struct ImageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A picture that needs more memory than it may take. what() says which: "a picture of 9x9 pixels"
struct ImageSizeError : ImageError {
  ImageSizeError(const std::string& picture, double needed) : ImageError(picture), bytes(needed) {}
  double bytes;
};

/// 8-bit sRGB, top row first; a fourth channel is straight alpha.
struct Image {
  int width = 0, height = 0, channels = 3;
  std::vector<std::uint8_t> pixels;
};

/// Text stored in a PNG, keyword to UTF-8 text (iTXt). Keywords are 1 to 79 Latin-1 characters.
using PngText = std::map<std::string, std::string>;

std::vector<std::uint8_t> encode_png(const Image& image, const PngText& text = {});

/// @param room  bytes of memory that it may take meanwhile
/// @throws ImageError when the bytes are no whole PNG, ImageSizeError before more than `room` is
/// taken
Image decode_png(std::span<const std::uint8_t> bytes,
                 double room = std::numeric_limits<double>::infinity());
PngText read_png_text(std::span<const std::uint8_t> bytes);
/// Exponent that made the samples of light, 1 for samples in linear light; 0 where the PNG says
/// sRGB, another profile, or nothing. @throws ImageError when the bytes are no whole PNG
double read_png_gamma(std::span<const std::uint8_t> bytes);
/// Absolute difference over all channels, 0 to 255. Colours count by the alpha of their pixel: one
/// that covers a two hundredth has any of three values, and is not seen.
struct Difference {
  double max = 0, mean = 0;
  /// The largest mean over a square of 8x8 pixels: high where a part of the picture is another one,
  /// though the mean of all is not; low where single pixels at edges differ.
  double local = 0;
};
/// @throws ImageError when the sizes differ
Difference compare(const Image& a, const Image& b);
/// |a - b| amplified so that small differences can be seen; opaque, with the alpha in all colours.
Image difference_image(const Image& a, const Image& b);

}  // namespace neve::render
