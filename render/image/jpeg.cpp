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

#else

bool can_encode_jpeg() {
  return false;
}

std::vector<std::uint8_t> encode_jpeg(const Image&, int, bool) {
  throw ImageError(std::string("built without JPEG: ") + jpeg_advice);
}

#endif

}  // namespace neve::render
