#include "render/image/jpeg.h"

#include <memory>
#include <string>

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

}  // namespace

/// By libturbojpeg: stb_image of Debian 12 reads outside of its tables where codes are damaged.
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
  return image;
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
