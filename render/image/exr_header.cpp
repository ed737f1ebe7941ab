#include "render/image/exr_header.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace neve::render {
namespace {

constexpr std::size_t head_size = 8;  // magic number and version
constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t is_deep = 0x800, has_parts = 0x1000;  // flags of the version

[[noreturn]] void fail(const std::string& what) {
  throw ImageError("no OpenEXR file: " + what);
}

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t number = 0;
  if (bytes.size() < sizeof number || at > bytes.size() - sizeof number)
    fail("its header has no end");
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// Takes a word up to the zero that ends it.
std::string take_word(std::span<const std::uint8_t>& bytes) {
  constexpr std::size_t longest = 255;
  const auto within = bytes.first(std::min(bytes.size(), longest + 1));
  const auto end = std::ranges::find(within, std::uint8_t{0});
  if (end == within.end()) fail("its header has no end");
  std::string word(within.begin(), end);
  bytes = bytes.subspan(word.size() + 1);
  return word;
}

/// Bytes of a pixel in all channels. Source: OpenEXR File Layout, "chlist".
double bytes_of_pixel(std::span<const std::uint8_t> channels) {
  constexpr std::size_t rest = 16;  // type, pLinear, sampling in x and y
  double bytes = 0;
  while (!take_word(channels).empty()) {
    const std::uint32_t type = number_at(channels, 0);
    if (channels.size() < rest) fail("its list of channels has no end");
    if (number_at(channels, 8) != 1 || number_at(channels, 12) != 1)
      throw ImageError(
          "an OpenEXR file with channels of fewer pixels; expected one number a pixel");
    channels = channels.subspan(rest);
    constexpr std::uint32_t half = 1;
    bytes += type == half ? 2 : 4;
  }
  if (!channels.empty()) fail("its list of channels ends before its attribute");
  return bytes;
}

/// Rows that are compressed together. Source: OpenEXR File Layout, "compression".
double rows_of_chunk(std::uint8_t compression) {
  constexpr double rows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  if (compression >= std::size(rows)) fail("its compression is none of OpenEXR's");
  return rows[compression];
}

struct Header {
  double width = 0, height = 0, pixel = 0, rows = 1;
  double tile_width = 0, tile_height = 0;
  double chunk_count = 0;  // as files of several parts say it

  void add(const ExrAttribute& attribute) {
    const auto& bytes = attribute.bytes;
    if (attribute.name == "dataWindow") {
      const auto side = [&](std::size_t low, std::size_t high) {
        return 1.0 + static_cast<std::int32_t>(number_at(bytes, high)) -
               static_cast<std::int32_t>(number_at(bytes, low));
      };
      width = side(0, 8);
      height = side(4, 12);
    } else if (attribute.name == "channels") {
      pixel = bytes_of_pixel(bytes);
    } else if (attribute.name == "compression") {
      rows = rows_of_chunk(bytes.empty() ? 0xff : bytes[0]);
    } else if (attribute.name == "tiles") {
      tile_width = number_at(bytes, 0);
      tile_height = number_at(bytes, 4);
    } else if (attribute.name == "chunkCount") {
      chunk_count = number_at(bytes, 0);
    }
  }

  void check(std::size_t packed, double room) const {
    constexpr double largest_side = 1 << 20;
    if (!(width >= 1 && height >= 1 && pixel > 0)) fail("it has no pixels");
    if (!(width <= largest_side && height <= largest_side))
      throw ImageError("an OpenEXR file with a side of more than a million pixels");
    const bool is_tiled = tile_width > 0 || tile_height > 0;
    if (is_tiled && !(tile_width >= 1 && tile_height >= 1)) fail("its tiles have no pixels");
    const double chunks = std::max(
        chunk_count, is_tiled ? width / tile_width * (height / tile_height) : height / rows);
    // Each chunk has a place in a table, of eight bytes.
    if (chunks * 8 > static_cast<double>(packed))
      throw ImageError("the picture has more numbers than its bytes can hold");
    const double numbers = is_tiled ? tile_width * tile_height : width * rows;
    // The numbers, packed and unpacked, and what a compressor needs beside them.
    const double needed = 4 * numbers * pixel;
    if (needed > room)
      throw ImageSizeError("an OpenEXR file with parts of " +
                               std::to_string(static_cast<std::int64_t>(std::min(numbers, 1e18))) +
                               " pixels",
                           needed);
  }
};

/// One header, up to the empty name that ends it.
std::vector<ExrAttribute> take_attributes(std::span<const std::uint8_t>& rest) {
  std::vector<ExrAttribute> attributes;
  for (std::string name = take_word(rest); !name.empty(); name = take_word(rest)) {
    std::string type = take_word(rest);
    const std::uint32_t size = number_at(rest, 0);
    rest = rest.subspan(sizeof size);
    if (size > rest.size())
      fail("an attribute of " + std::to_string(size) + " bytes is larger than the file");
    attributes.push_back({std::move(name), std::move(type), rest.first(size)});
    rest = rest.subspan(size);
  }
  return attributes;
}

/// The library reads as many bytes as a type has, whatever the file says: what follows would be
/// read from another place than here. Source: OpenEXR File Layout, "Attribute types".
void check_type_size(const ExrAttribute& attribute) {
  static constexpr std::pair<std::string_view, std::size_t> sizes[] = {
      {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
      {"compression", 1}, {"double", 8},   {"envmap", 1},
      {"float", 4},       {"int", 4},      {"keycode", 28},
      {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
      {"m44d", 128},      {"m44f", 64},    {"rational", 8},
      {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
      {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
      {"v3f", 12},        {"v3i", 12}};
  // It is read up to its end, under whatever name.
  if (attribute.type == "chlist") bytes_of_pixel(attribute.bytes);
  for (const auto& [type, size] : sizes)
    if (attribute.type == type && attribute.bytes.size() != size)
      fail("an attribute of the type " + attribute.type + " has " +
           std::to_string(attribute.bytes.size()) + " bytes; expected " + std::to_string(size));
}

void check_attributes(const std::vector<ExrAttribute>& attributes, std::size_t packed,
                      double room) {
  Header header;
  std::vector<std::string> names;
  for (const ExrAttribute& attribute : attributes) {
    // Attributes that hold sizes of their own inside.
    for (const char* other : {"preview", "stringvector", "floatvector", "deepImageState"})
      if (attribute.type == other)
        throw ImageError("an OpenEXR file with a " + attribute.type + ", which neve never writes");
    check_type_size(attribute);
    header.add(attribute);
    names.push_back(attribute.name);
  }
  std::ranges::sort(names);
  if (std::ranges::adjacent_find(names) != names.end()) fail("an attribute is written twice");
  header.check(packed, room);
}

/// The flags of the version. @param rest  becomes what follows it
std::uint32_t take_version(std::span<const std::uint8_t>& rest) {
  if (rest.size() < head_size || number_at(rest, 0) != magic) fail("it does not begin as one");
  const std::uint32_t version = number_at(rest, 4);
  rest = rest.subspan(head_size);
  return version;
}

}  // namespace

std::vector<ExrAttribute> read_exr_attributes(std::span<const std::uint8_t> bytes) {
  take_version(bytes);
  return take_attributes(bytes);
}

void check_exr_header(std::span<const std::uint8_t> bytes, double room) {
  std::span<const std::uint8_t> rest = bytes;
  const std::uint32_t version = take_version(rest);
  if (version & is_deep) throw ImageError("an OpenEXR file of deep pixels; expected flat ones");
  std::vector<ExrAttribute> attributes = take_attributes(rest);
  check_attributes(attributes, bytes.size(), room);
  if (!(version & has_parts)) return;
  // Parts end with a header of nothing.
  while (!(attributes = take_attributes(rest)).empty())
    check_attributes(attributes, bytes.size(), room);
}

}  // namespace neve::render
