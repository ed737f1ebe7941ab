#include "render/image/image.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>

#include "render/image/png_chunks.h"

namespace neve::render {
namespace {

/// libdeflate's fastest level instead of stb's own compressor: half of the time that zlib's fastest
/// takes, and smaller files (docs/performance.md).
unsigned char* compress_for_stb(unsigned char* data, int length, int* out_length, int) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(1), libdeflate_free_compressor);
  if (!compressor) return nullptr;
  const auto count = static_cast<std::size_t>(length);
  const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), count);
  auto* out = static_cast<unsigned char*>(std::malloc(bound));
  const std::size_t size =
      out ? libdeflate_zlib_compress(compressor.get(), data, count, out, bound) : 0;
  if (size > 0 && size <= INT_MAX) {
    *out_length = static_cast<int>(size);
    return out;
  }
  std::free(out);
  return nullptr;
}

/// stb does not always say that this was the reason.
thread_local bool has_stb_no_memory = false;

void* note_of_stb(void* memory) {
  if (!memory) has_stb_no_memory = true;
  return memory;
}

/// Bytes that a picture of its size can need at once: data that unpack to more belong to no pixel.
thread_local std::size_t max_of_stb = 0;
thread_local bool has_stb_too_much = false;

void* grown_by_stb(void* memory, std::size_t size) {
  if (size > max_of_stb) {
    has_stb_too_much = true;
    return nullptr;
  }
  return note_of_stb(std::realloc(memory, size));
}

}  // namespace
}  // namespace neve::render

#define STBIW_ZLIB_COMPRESS neve::render::compress_for_stb
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#define STBI_MALLOC(size) neve::render::note_of_stb(std::malloc(size))
#define STBI_REALLOC(memory, size) neve::render::grown_by_stb(memory, size)
#define STBI_FREE(memory) std::free(memory)
#include <stb/stb_image.h>

namespace neve::render {
namespace {

constexpr std::size_t ihdr_end = 33;  // signature and the IHDR chunk

void check_pixels(const Image& image) {
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4)
    throw ImageError("picture of " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + " pixels and " +
                     std::to_string(image.channels) + " channels");
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels;
  if (image.pixels.size() != row * image.height)
    throw ImageError("picture has " + std::to_string(image.pixels.size()) + " bytes, expected " +
                     std::to_string(row * image.height));
  // The encoder counts bytes in an int.
  if ((row + 1) * image.height > INT_MAX / 2) throw ImageError("picture is too large for a PNG");
}

std::string latin1_to_utf8(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t c : bytes) {
    if (c < 0x80) {
      text += static_cast<char>(c);
    } else {
      text += static_cast<char>(0xc0 | c >> 6);
      text += static_cast<char>(0x80 | (c & 0x3f));
    }
  }
  return text;
}

/// Cuts the bytes before the next zero off the front of rest, and the zero with them.
std::span<const std::uint8_t> take_field(std::span<const std::uint8_t>& rest, const char* chunk) {
  const auto zero = std::find(rest.begin(), rest.end(), std::uint8_t{0});
  if (zero == rest.end())
    throw ImageError(std::string("PNG is damaged: ") + chunk + " without end of field");
  const auto length = static_cast<std::size_t>(zero - rest.begin());
  const auto field = rest.first(length);
  rest = rest.subspan(length + 1);
  return field;
}

void read_itxt(std::span<const std::uint8_t> rest, PngText& text) {
  const auto keyword = take_field(rest, "iTXt");
  if (rest.size() < 2) throw ImageError("PNG is damaged: iTXt without compression flag");
  const bool is_compressed = rest[0] != 0;
  rest = rest.subspan(2);
  take_field(rest, "iTXt");   // language
  take_field(rest, "iTXt");   // translated keyword
  if (is_compressed) return;  // never written by us
  text[std::string(keyword.begin(), keyword.end())] = std::string(rest.begin(), rest.end());
}

/// Bytes of a PNG while it is decoded.
struct DecodedSize {
  double unpacked = 0;  ///< rows as they were packed
  double pixels = 0;    ///< as they are handed over
};

/// A few bytes that say they are a large picture are refused before there is memory for it.
DecodedSize check_size(const std::vector<PngChunk>& chunks, double room) {
  constexpr std::size_t best_deflate = 1032;  // bytes that one byte of deflate can become
  std::size_t packed = 0;
  for (const PngChunk& chunk : chunks)
    if (chunk.type == "IDAT") packed += chunk.data.size();
  const std::span<const std::uint8_t> header = chunks.front().data;
  if (header.size() < 13) return {};  // decoding says why
  const auto number_at = [&](std::size_t at) {
    return std::size_t{header[at]} << 24 | std::size_t{header[at + 1]} << 16 |
           std::size_t{header[at + 2]} << 8 | std::size_t{header[at + 3]};
  };
  const std::size_t width = number_at(0), height = number_at(4), kind = header[9];
  const std::size_t samples = kind == 2 ? 3 : kind == 4 ? 2 : kind == 6 ? 4 : 1;
  const std::size_t row = (width * samples * header[8] + 7) / 8;
  if (row * height > best_deflate * packed)
    throw ImageError("PNG is damaged: " + std::to_string(packed) +
                     " bytes of data are too few for " + std::to_string(width) + "x" +
                     std::to_string(height) + " pixels");
  // An interlaced picture has up to 7 bytes more a row and pass.
  const double rows = static_cast<double>(height) * static_cast<double>(row + 1) +
                      (header[12] ? 16.0 * static_cast<double>(height) + 64 : 0);
  // Palettes become colours; samples of 16 bits are halved at the end.
  const double channels = kind == 3 ? 4 : static_cast<double>(samples) + (samples % 2 ? 1 : 0),
               pixels = static_cast<double>(width) * static_cast<double>(height) * channels *
                        (header[8] == 16 ? 2 : 1);
  const double needed = rows + 2.25 * pixels;
  if (needed > room)
    throw ImageSizeError(
        "a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels", needed);
  return {rows, pixels};
}

void check_comparable(const Image& a, const Image& b) {
  check_pixels(a);
  check_pixels(b);
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw ImageError("pictures differ in size: " + std::to_string(a.width) + "x" +
                     std::to_string(a.height) + "x" + std::to_string(a.channels) + " and " +
                     std::to_string(b.width) + "x" + std::to_string(b.height) + "x" +
                     std::to_string(b.channels));
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image, const PngText& text) {
  check_pixels(image);
  stbi_write_force_png_filter = 1;  // sub: mostly smaller than any other, and none is tried
  int length = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(image.pixels.data(), image.width * image.channels, image.width,
                            image.height, image.channels, &length),
      std::free);
  if (!png || length < static_cast<int>(ihdr_end)) throw std::bad_alloc();

  std::vector<std::uint8_t> bytes(png.get(), png.get() + ihdr_end);
  const auto add = [&](const std::vector<std::uint8_t>& chunk) {
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
  };
  // sRGB, and the same for programs that know only its curve and its primaries (PNG, 11.3.3.5).
  constexpr std::array<std::uint8_t, 1> perceptual = {0};
  constexpr std::array<std::uint8_t, 4> gamma = {0, 0, 0xb1, 0x8f};  // 45455: 1 / 2.2
  constexpr std::array<std::uint8_t, 32> primaries = {
      0, 0, 0x7a, 0x26, 0, 0, 0x80, 0x84, 0, 0, 0xfa, 0x00, 0, 0, 0x80, 0xe8,
      0, 0, 0x75, 0x30, 0, 0, 0xea, 0x60, 0, 0, 0x3a, 0x98, 0, 0, 0x17, 0x70};
  add(make_png_chunk("sRGB", perceptual));
  add(make_png_chunk("gAMA", gamma));
  add(make_png_chunk("cHRM", primaries));
  for (const auto& [keyword, value] : text) add(make_itxt_chunk(keyword, value));
  bytes.insert(bytes.end(), png.get() + ihdr_end, png.get() + length);
  return bytes;
}

namespace {

/// @param format    for messages
/// @param unpacked  bytes that its data may unpack to
Image decode_by_stb(std::span<const std::uint8_t> bytes, const std::string& format,
                    std::size_t unpacked) {
  Image image;
  has_stb_no_memory = has_stb_too_much = false;
  // It doubles what it unpacks into, and what it collects of the packed bytes.
  max_of_stb = 4096 + 2 * std::max(unpacked, bytes.size());
  const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &image.width,
                            &image.height, &image.channels, 0),
      stbi_image_free);
  if (!pixels && has_stb_too_much)
    throw ImageError(format + " is damaged: its data unpack to more than its pixels");
  if (!pixels && has_stb_no_memory) throw std::bad_alloc();
  if (!pixels) {
    const char* reason = stbi_failure_reason();  // none for a block of an unknown type
    throw ImageError(format + " is damaged: " + (reason ? reason : "cannot be unpacked"));
  }
  const std::size_t count = static_cast<std::size_t>(image.width) * image.height * image.channels;
  image.pixels.assign(pixels.get(), pixels.get() + count);
  return image;
}

/// A channel as it is seen: colours by how much of the pixel they cover.
int seen(const Image& image, std::size_t pixel, int channel) {
  const std::uint8_t* at = &image.pixels[pixel * static_cast<std::size_t>(image.channels)];
  if (image.channels < 4 || channel == 3) return at[channel];
  return (int{at[channel]} * at[3] + 127) / 255;
}

}  // namespace

Image decode_png(std::span<const std::uint8_t> bytes, double room) {
  if (bytes.size() > INT_MAX) throw ImageError("PNG is too large");
  // stb checks no checksums and forgives missing ends.
  const DecodedSize size = check_size(read_png_chunks(bytes), room);
  return decode_by_stb(bytes, "PNG", static_cast<std::size_t>(size.unpacked));
}

double read_png_gamma(std::span<const std::uint8_t> bytes) {
  double gamma = 0;
  for (const PngChunk& chunk : read_png_chunks(bytes)) {
    if (chunk.type == "sRGB" || chunk.type == "iCCP") return 0;
    if (chunk.type != "gAMA" || chunk.data.size() != 4) continue;
    gamma = 0;
    for (const std::uint8_t byte : chunk.data) gamma = 256 * gamma + byte;
  }
  return gamma / 100000;
}

PngText read_png_text(std::span<const std::uint8_t> bytes) {
  PngText text;
  for (const PngChunk& chunk : read_png_chunks(bytes)) {
    if (chunk.type == "iTXt") read_itxt(chunk.data, text);
    if (chunk.type == "tEXt") {
      std::span<const std::uint8_t> rest = chunk.data;
      const auto keyword = take_field(rest, "tEXt");
      text[std::string(keyword.begin(), keyword.end())] = latin1_to_utf8(rest);
    }
  }
  return text;
}

Difference compare(const Image& a, const Image& b) {
  check_comparable(a, b);
  constexpr int square = 8;
  const int across = (a.width + square - 1) / square, down = (a.height + square - 1) / square;
  std::vector<std::uint64_t> sums(static_cast<std::size_t>(across) *
                                  static_cast<std::size_t>(down));
  std::uint64_t sum = 0;
  int largest = 0;
  std::size_t i = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x, ++i) {
      std::uint64_t of_pixel = 0;
      for (int c = 0; c < a.channels; ++c) {
        const int difference = std::abs(seen(a, i, c) - seen(b, i, c));
        largest = std::max(largest, difference);
        of_pixel += static_cast<std::uint64_t>(difference);
      }
      sums[static_cast<std::size_t>(y / square * across + x / square)] += of_pixel;
      sum += of_pixel;
    }
  Difference out;
  out.max = static_cast<double>(largest);
  out.mean = static_cast<double>(sum) / static_cast<double>(a.pixels.size());
  for (int row = 0; row < down; ++row)
    for (int column = 0; column < across; ++column) {
      const int width = std::min(square, a.width - column * square);
      const int height = std::min(square, a.height - row * square);
      out.local = std::max(
          out.local, static_cast<double>(sums[static_cast<std::size_t>(row * across + column)]) /
                         (width * height * a.channels));
    }
  return out;
}

Image difference_image(const Image& a, const Image& b) {
  check_comparable(a, b);
  constexpr int gain = 8;
  const int channels = std::min(a.channels, 3);
  Image out{a.width, a.height, channels, {}};
  const std::size_t pixels = a.pixels.size() / static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const int cover = a.channels < 4 ? 0 : std::abs(seen(a, i, 3) - seen(b, i, 3));
    for (int c = 0; c < channels; ++c) {
      const int difference = std::max(cover, std::abs(seen(a, i, c) - seen(b, i, c)));
      out.pixels.push_back(static_cast<std::uint8_t>(std::min(255, gain * difference)));
    }
  }
  return out;
}

}  // namespace neve::render
