#include "render/image/jpeg.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#ifdef NEVE_WITH_JPEG
#include <turbojpeg.h>
#endif

namespace neve::render {

const char* const jpeg_advice =
    "install libturbojpeg0-dev (Debian) and build again with NEVE_WEB=AUTO or ON";

#ifdef NEVE_WITH_JPEG

bool can_encode_jpeg() {
  return true;
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality, bool has_full_colour) {
  const std::size_t expected = std::size_t(image.width) * image.height * image.channels;
  if (image.width < 1 || image.height < 1 || (image.channels != 3 && image.channels != 4) ||
      image.pixels.size() != expected)
    throw ImageError("cannot encode " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + " pixels of " + std::to_string(image.channels) +
                     " channels as JPEG");
  const std::unique_ptr<void, int (*)(void*)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) throw ImageError(std::string("JPEG: ") + tjGetErrorStr2(nullptr));
  const int sampling = has_full_colour ? TJSAMP_444 : TJSAMP_420;
  std::vector<std::uint8_t> bytes(tjBufSize(image.width, image.height, sampling));
  unsigned char* data = bytes.data();
  unsigned long size = static_cast<unsigned long>(bytes.size());
  if (tjCompress2(encoder.get(), image.pixels.data(), image.width, 0, image.height,
                  image.channels == 3 ? TJPF_RGB : TJPF_RGBX, &data, &size, sampling, quality,
                  TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0)
    throw ImageError(std::string("JPEG: ") + tjGetErrorStr2(encoder.get()));
  bytes.resize(size);
  return bytes;
}

namespace {

/// Each scan of a progressive one goes over all its pixels; encoders write about ten.
void check_scans(std::span<const std::uint8_t> bytes) {
  constexpr std::ptrdiff_t max_scans = 100;
  std::ptrdiff_t scans = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i)
    scans += bytes[i] == 0xff && bytes[i + 1] == 0xda;
  if (scans > max_scans)
    throw ImageError("a JPEG of " + std::to_string(scans) + " scans; expected at most " +
                     std::to_string(max_scans));
}

/// Numbers of a TIFF header, in its order of bytes; 0 beyond its end.
struct Tiff {
  std::span<const std::uint8_t> bytes;
  bool is_little = !bytes.empty() && bytes[0] == 'I';

  std::size_t number(std::size_t at, std::size_t size) const {
    std::size_t value = 0;
    if (bytes.size() < size || at > bytes.size() - size) return 0;
    for (std::size_t k = 0; k < size; ++k)
      value = value << 8 | bytes[at + (is_little ? size - 1 - k : k)];
    return value;
  }
};

/// Returns the attitude of the camera, 1 to 8; 1: as the picture is stored, or nothing is said.
/// Source: Exif 2.32 (CIPA DC-008-2019), tag 0x0112.
int orientation_of(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 6> exif{'E', 'x', 'i', 'f', 0, 0};
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == 0xff && bytes[at + 1] != 0xda) {
    const std::size_t length = std::size_t{bytes[at + 2]} << 8 | bytes[at + 3];
    if (length < 2 || at + 2 + length > bytes.size()) break;
    const auto part = bytes.subspan(at + 4, length - 2);
    if (bytes[at + 1] == 0xe1 && part.size() > exif.size() &&
        std::equal(exif.begin(), exif.end(), part.begin())) {
      const Tiff tiff{part.subspan(exif.size())};
      const std::size_t table = tiff.number(4, 4), count = tiff.number(table, 2);
      for (std::size_t entry = table + 2; entry < table + 2 + 12 * count; entry += 12) {
        const std::size_t held = tiff.number(entry + 8, 2);
        if (tiff.number(entry, 2) == 0x0112 && held >= 1 && held <= 8)
          return static_cast<int>(held);
      }
      break;
    }
    at += 2 + length;
  }
  return 1;
}

/// The picture as the camera saw it.
Image upright(Image stored, int orientation) {
  if (orientation == 1) return stored;
  const auto is_one_of = [&](std::initializer_list<int> list) {
    return std::ranges::find(list, orientation) != list.end();
  };
  const bool is_turned = orientation >= 5, is_flipped_x = is_one_of({2, 3, 7, 8}),
             is_flipped_y = is_one_of({3, 4, 6, 7});
  Image image = stored;
  if (is_turned) std::swap(image.width, image.height);
  auto to = image.pixels.begin();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int u = is_turned ? y : x, v = is_turned ? x : y;
      const int column = is_flipped_x ? stored.width - 1 - u : u,
                row = is_flipped_y ? stored.height - 1 - v : v;
      const std::ptrdiff_t from = std::ptrdiff_t{row} * stored.width + column;
      to = std::copy_n(stored.pixels.begin() + from * stored.channels, stored.channels, to);
    }
  return image;
}

}  // namespace

/// Uses libturbojpeg: stb_image of Debian 12 reads outside of its tables if codes are damaged.
Image decode_jpeg(std::span<const std::uint8_t> bytes, double room) {
  if (bytes.size() < 3 || bytes[0] != 0xff || bytes[1] != 0xd8 || bytes[2] != 0xff)
    throw ImageError("not a JPEG: it does not begin as one");
  check_scans(bytes);
  const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
  if (!decoder) throw ImageError(std::string("JPEG: ") + tjGetErrorStr2(nullptr));
  const auto fail = [&] {
    throw ImageError(std::string("JPEG is damaged: ") + tjGetErrorStr2(decoder.get()));
  };
  int width = 0, height = 0, sampling = 0, colours = 0;
  const auto size = static_cast<unsigned long>(bytes.size());
  if (tjDecompressHeader3(decoder.get(), bytes.data(), size, &width, &height, &sampling,
                          &colours) != 0)
    fail();
  if (colours == TJCS_CMYK || colours == TJCS_YCCK)
    throw ImageError("a JPEG of four inks; save it as RGB");
  const bool is_grey = colours == TJCS_GRAY;
  // Planes of coefficients (progressive), of samples, and the pixels.
  const double needed = 24.0 * width * height;
  if (needed > room)
    throw ImageSizeError(
        "a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels", needed);
  Image image{width, height, is_grey ? 1 : 3, {}};
  image.pixels.resize(std::size_t(width) * height * image.channels);
  // Bytes between its parts are no gap, and cameras leave some; all other warnings are of one.
  if (tjDecompress2(decoder.get(), bytes.data(), size, image.pixels.data(), width, 0, height,
                    is_grey ? TJPF_GRAY : TJPF_RGB, TJFLAG_ACCURATEDCT) != 0 &&
      (tjGetErrorCode(decoder.get()) == TJERR_FATAL ||
       std::string(tjGetErrorStr2(decoder.get())).find("extraneous bytes") == std::string::npos))
    fail();
  return upright(std::move(image), orientation_of(bytes));
}

#else

bool can_encode_jpeg() {
  return false;
}

std::vector<std::uint8_t> encode_jpeg(const Image&, int, bool) {
  throw ImageError(std::string("built without JPEG: ") + jpeg_advice);
}

Image decode_jpeg(std::span<const std::uint8_t>, double) {
  throw ImageError(std::string("built without JPEG: ") + jpeg_advice);
}

#endif

}  // namespace neve::render
