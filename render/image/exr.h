#pragma once
/// OpenEXR files: many channels of half or single precision, with text and the camera in the
/// header.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

/// Bits of half floats, as IEEE 754 has them.
using HalfNumbers = std::vector<std::uint16_t>;

/// One number a pixel, top row first.
struct ExrChannel {
  std::string name;  ///< "R", "normal.X"
  std::variant<HalfNumbers, std::vector<float>> numbers;
};

struct ExrPicture {
  int width = 0, height = 0;  ///< of the display window; numbers beside the data window are 0
  std::vector<ExrChannel> channels;
  /// Rows of the matrix that makes the linear light R, G, B that of the primaries of BT.709.
  std::array<std::array<float, 3>, 3> to_rec709{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  /// Returns the channel of a name; null if there is none.
  const ExrChannel* find(const std::string& name) const;
};

/// Header of a file besides its channels. Matrices as OpenEXR stores them: for points as rows, row
/// by row.
struct ExrHeader {
  PngText text;                                                ///< string attributes
  double fps = 0;                                              ///< framesPerSecond; 0: none
  std::string time_code{};                                     ///< "01:00:00:00"; empty: none
  std::optional<std::array<float, 16>> to_camera{}, to_ndc{};  ///< worldToCamera, worldToNDC
  float screen_width = 1;  ///< screenWindowWidth: of the picture, at a distance of 1
};

/// Rounds to the nearest half float; beyond 65504 it becomes infinite.
HalfNumbers to_half(std::span<const float> numbers);
/// All numbers of a channel in single precision.
std::vector<float> numbers_of(const ExrChannel& channel);

/// Compresses without loss (ZIP, blocks of 16 rows).
std::vector<std::uint8_t> encode_exr(const ExrPicture& picture, const ExrHeader& header = {});

/// @param room  bytes of memory that its numbers may take
/// @throws ImageError when the bytes are no whole OpenEXR file
ExrPicture decode_exr(std::span<const std::uint8_t> bytes,
                      double room = std::numeric_limits<double>::infinity());
/// The string attributes of the header. @throws ImageError
PngText read_exr_text(std::span<const std::uint8_t> bytes);

}  // namespace neve::render
