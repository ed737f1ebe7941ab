#pragma once
/// The chunk structure of a PNG file: walking it with every length and checksum checked, and
/// writing text chunks.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace neve::render {

struct PngChunk {
  std::string type;  ///< four letters
  std::span<const std::uint8_t> data;
  std::size_t end = 0;  ///< offset of the first byte after the chunk
};

/// All chunks from IHDR to IEND; bytes after IEND are ignored.
/// @throws ImageError when the signature, a length or a checksum is wrong or IEND is missing
std::vector<PngChunk> read_png_chunks(std::span<const std::uint8_t> bytes);

/// A chunk, length and checksum included. @param type four letters
std::vector<std::uint8_t> make_png_chunk(const std::string& type,
                                         std::span<const std::uint8_t> data);

/// An uncompressed iTXt chunk, length and checksum included.
/// @throws ImageError when the keyword is not allowed or the text holds a zero byte
std::vector<std::uint8_t> make_itxt_chunk(const std::string& keyword, const std::string& text);

}  // namespace neve::render
