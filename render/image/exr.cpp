#include "render/image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfFramesPerSecond.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRational.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>

#include "render/image/exr_header.h"

namespace neve::render {
namespace {

/// Favours speed: level 4 saves a tenth of the bytes and takes twice the time.
constexpr int zip_level = 1;

class BytesOut : public Imf::OStream {
 public:
  BytesOut() : OStream("memory") {}
  void write(const char from[], int count) override {
    const auto end = at_ + static_cast<std::size_t>(count);
    if (bytes.size() < end) bytes.resize(end);
    std::memcpy(bytes.data() + at_, from, static_cast<std::size_t>(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }

  std::vector<std::uint8_t> bytes;

 private:
  std::size_t at_ = 0;
};

class BytesIn : public Imf::IStream {
 public:
  explicit BytesIn(std::span<const std::uint8_t> bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || wanted > bytes_.size() - at_)
      throw ImageError("the file ends too early");
    std::memcpy(to, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t to) override { at_ = to; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

Imath::M44f matrix(const std::array<float, 16>& rows) {
  float table[4][4];
  std::memcpy(table, rows.data(), sizeof table);
  return Imath::M44f(table);
}

Imf::PixelType type_of(const ExrChannel& channel) {
  return channel.numbers.index() == 0 ? Imf::HALF : Imf::FLOAT;
}

/// Numbers lie row by row without gaps.
Imf::Slice slice(Imf::PixelType type, const void* numbers, int width) {
  const std::size_t size = type == Imf::HALF ? 2 : 4;
  return Imf::Slice(type, static_cast<char*>(const_cast<void*>(numbers)), size,
                    size * static_cast<std::size_t>(width));
}

const void* data_of(const ExrChannel& channel) {
  return std::visit([](const auto& numbers) -> const void* { return numbers.data(); },
                    channel.numbers);
}

Imf::Header header_of(const ExrPicture& picture, const ExrHeader& from) {
  Imf::Header header(picture.width, picture.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = zip_level;
  for (const ExrChannel& channel : picture.channels)
    header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  for (const auto& [name, text] : from.text) header.insert(name, Imf::StringAttribute(text));
  // Linear light of the primaries of sRGB and BT.709; the name is that of OCIO's ACES
  // configurations.
  Imf::addChromaticities(header, Imf::Chromaticities());
  header.insert("oiio:ColorSpace", Imf::StringAttribute("lin_rec709"));
  if (from.fps > 0) Imf::addFramesPerSecond(header, Imf::guessExactFps(from.fps));
  if (from.to_camera) Imf::addWorldToCamera(header, matrix(*from.to_camera));
  if (from.to_ndc) Imf::addWorldToNDC(header, matrix(*from.to_ndc));
  return header;
}

/// Reads with the errors of the library as ours.
template <class Read>
auto reading(std::span<const std::uint8_t> bytes, double room, const Read& read) {
  check_exr_header(bytes, room);
  try {
    BytesIn stream(bytes);
    Imf::InputFile file(stream);
    return read(file);
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImageError(std::string("no OpenEXR file: ") + error.what());
  }
}

/// Channels of whole numbers are read in single precision.
ExrPicture empty_picture(const Imf::Header& header, std::size_t packed, double room) {
  const Imath::Box2i& window = header.dataWindow();
  const double width = 1.0 + window.max.x - window.min.x;
  const double height = 1.0 + window.max.y - window.min.y;
  constexpr double best_deflate = 1032;  // bytes that one byte of it can become
  double count = 0;
  const Imf::ChannelList& channels = header.channels();
  for (auto c = channels.begin(); c != channels.end(); ++c)
    count += width * height * (c.channel().type == Imf::HALF ? 2 : 4);
  if (!(count <= best_deflate * static_cast<double>(packed)))
    throw ImageError("the picture has more numbers than its bytes can hold");
  if (count > room)
    throw ImageSizeError("a picture of " + std::to_string(static_cast<std::int64_t>(width)) + "x" +
                             std::to_string(static_cast<std::int64_t>(height)) + " pixels",
                         count);
  ExrPicture picture{static_cast<int>(width), static_cast<int>(height), {}};
  const auto pixels = static_cast<std::size_t>(width * height);
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    if (c.channel().type == Imf::HALF)
      picture.channels.push_back({c.name(), HalfNumbers(pixels)});
    else
      picture.channels.push_back({c.name(), std::vector<float>(pixels)});
  }
  return picture;
}

}  // namespace

const ExrChannel* ExrPicture::find(const std::string& name) const {
  const auto found = std::ranges::find(channels, name, &ExrChannel::name);
  return found == channels.end() ? nullptr : &*found;
}

HalfNumbers to_half(std::span<const float> numbers) {
  HalfNumbers halves;
  halves.reserve(numbers.size());
  for (const float number : numbers) halves.push_back(Imath::half(number).bits());
  return halves;
}

std::vector<float> numbers_of(const ExrChannel& channel) {
  if (const auto* numbers = std::get_if<std::vector<float>>(&channel.numbers)) return *numbers;
  std::vector<float> numbers;
  for (const std::uint16_t bits : std::get<HalfNumbers>(channel.numbers)) {
    Imath::half half;
    half.setBits(bits);
    numbers.push_back(half);
  }
  return numbers;
}

std::vector<std::uint8_t> encode_exr(const ExrPicture& picture, const ExrHeader& header) {
  Imf::FrameBuffer buffer;
  for (const ExrChannel& channel : picture.channels)
    buffer.insert(channel.name, slice(type_of(channel), data_of(channel), picture.width));
  BytesOut stream;
  {
    Imf::OutputFile file(stream, header_of(picture, header));
    file.setFrameBuffer(buffer);
    file.writePixels(picture.height);
  }
  return std::move(stream.bytes);
}

ExrPicture decode_exr(std::span<const std::uint8_t> bytes, double room) {
  return reading(bytes, room, [&](Imf::InputFile& file) {
    ExrPicture picture = empty_picture(file.header(), bytes.size(), room);
    const Imath::V2i corner = file.header().dataWindow().min;
    Imf::FrameBuffer buffer;
    for (const ExrChannel& channel : picture.channels) {
      const std::ptrdiff_t size = channel.numbers.index() == 0 ? 2 : 4;
      const std::ptrdiff_t before =
          (static_cast<std::ptrdiff_t>(corner.y) * picture.width + corner.x) * size;
      const auto* first = static_cast<const char*>(data_of(channel));
      buffer.insert(channel.name, slice(type_of(channel), first - before, picture.width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(corner.y, corner.y + picture.height - 1);
    return picture;
  });
}

PngText read_exr_text(std::span<const std::uint8_t> bytes) {
  PngText text;
  for (const ExrAttribute& attribute : read_exr_attributes(bytes))
    if (attribute.type == "string")
      text[attribute.name] = {attribute.bytes.begin(), attribute.bytes.end()};
  return text;
}

}  // namespace neve::render
