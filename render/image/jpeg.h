#pragma once
/// Pictures as JPEG bytes: for looking at them over a network, and the plates of cameras.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

/// True if this build has libturbojpeg; without it the functions throw.
bool can_encode_jpeg();

/// Packages and options for a build with JPEG.
extern const char* const jpeg_advice;

/// @param image three or four channels; the fourth is ignored
/// @param quality 1 to 100
/// @param has_full_colour 4:4:4: thin coloured lines and small text stay sharp, a third more bytes.
///        Otherwise colour at half the resolution (4:2:0).
/// @throws ImageError
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality, bool has_full_colour);

/// Baseline and progressive, of one or three channels; turned as Exif says that its camera was
/// held. @throws as decode_png
Image decode_jpeg(std::span<const std::uint8_t> bytes,
                  double room = std::numeric_limits<double>::infinity());

}  // namespace neve::render
