#include "render/image/png_chunks.h"

#include <zlib.h>

#include <algorithm>
#include <array>

#include "render/image/image.h"

namespace neve::render {
namespace {

constexpr std::array<std::uint8_t, 8> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t chunk_overhead = 12;  // length, type, checksum

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

void append_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), bytes.data(), bytes.size()));
}

void check_keyword(const std::string& keyword) {
  const auto is_printable = [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return (u >= 32 && u <= 126) || u >= 161;
  };
  if (keyword.empty() || keyword.size() > 79 || keyword.front() == ' ' || keyword.back() == ' ' ||
      !std::all_of(keyword.begin(), keyword.end(), is_printable))
    throw ImageError("PNG text: keyword \"" + keyword +
                     "\" is not 1 to 79 printable Latin-1 characters");
}

}  // namespace

std::vector<PngChunk> read_png_chunks(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < signature.size() ||
      !std::equal(signature.begin(), signature.end(), bytes.begin()))
    throw ImageError("not a PNG: the signature is missing");
  std::vector<PngChunk> chunks;
  std::size_t at = signature.size();
  while (bytes.size() - at >= chunk_overhead) {
    const std::size_t length = read_u32(bytes, at);
    if (length > bytes.size() - at - chunk_overhead)
      throw ImageError("PNG is cut off: a chunk of " + std::to_string(length) +
                       " bytes starts at byte " + std::to_string(at) + " of " +
                       std::to_string(bytes.size()));
    const auto typed = bytes.subspan(at + 4, 4 + length);
    if (checksum(typed) != read_u32(bytes, at + 8 + length))
      throw ImageError("PNG is damaged: wrong checksum in the chunk at byte " + std::to_string(at));
    at += chunk_overhead + length;
    chunks.push_back({std::string(typed.begin(), typed.begin() + 4), typed.subspan(4), at});
    if (chunks.front().type != "IHDR") throw ImageError("PNG is damaged: IHDR is not first");
    if (chunks.back().type == "IEND") return chunks;
  }
  throw ImageError("PNG is cut off: IEND is missing");
}

std::vector<std::uint8_t> make_png_chunk(const std::string& type,
                                         std::span<const std::uint8_t> data) {
  std::vector<std::uint8_t> chunk;
  append_u32(chunk, static_cast<std::uint32_t>(data.size()));
  chunk.insert(chunk.end(), type.begin(), type.end());
  chunk.insert(chunk.end(), data.begin(), data.end());
  append_u32(chunk, checksum(std::span(chunk).subspan(4)));
  return chunk;
}

std::vector<std::uint8_t> make_itxt_chunk(const std::string& keyword, const std::string& text) {
  check_keyword(keyword);
  if (text.find('\0') != std::string::npos)
    throw ImageError("PNG text: \"" + keyword + "\" holds a zero byte");
  std::vector<std::uint8_t> data(keyword.begin(), keyword.end());
  // End of keyword; not compressed, method 0; no language, no translated keyword.
  data.insert(data.end(), {0, 0, 0, 0, 0});
  data.insert(data.end(), text.begin(), text.end());
  if (data.size() > 0x7fffffffu) throw ImageError("PNG text: \"" + keyword + "\" is too long");
  return make_png_chunk("iTXt", data);
}

}  // namespace neve::render
