#pragma once
/// The header of an OpenEXR file as it lies in the file, read before the library sees it: the
/// library allocates whatever a header says.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

struct ExrAttribute {
  std::string name, type;
  std::span<const std::uint8_t> bytes;
};

/// Reads attributes of the first part. @throws ImageError when the bytes begin as no whole header
std::vector<ExrAttribute> read_exr_attributes(std::span<const std::uint8_t> bytes);

/// Compares the numbers of a header with the length of its file and with the room.
/// @param room  bytes of memory that rows, tiles and tables of one chunk may take
/// @throws ImageError for a header whose picture cannot be in these bytes, or which neve does not
/// read; ImageSizeError before more than `room` would be taken
void check_exr_header(std::span<const std::uint8_t> bytes, double room);

}  // namespace neve::render
