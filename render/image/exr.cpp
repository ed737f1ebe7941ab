#include "render/image/exr.h"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfChromaticitiesAttribute.h>
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
#include <ImfTimeCode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

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

/// Reads "HH:MM:SS:FF", or with ";" before FF where numbers are dropped.
Imf::TimeCode time_code(const std::string& text) {
  const auto two_digits = [&](std::size_t at) { return std::stoi(text.substr(at, 2)); };
  return {two_digits(0), two_digits(3), two_digits(6), two_digits(9), text.at(8) == ';'};
}

Imf::Header header_of(const ExrPicture& picture, const ExrHeader& from) {
  Imf::Header header(picture.width, picture.height);
  header.screenWindowWidth() = from.screen_width;
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
  if (!from.time_code.empty()) Imf::addTimeCode(header, time_code(from.time_code));
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

double width_of(const Imath::Box2i& window) {
  return 1.0 + window.max.x - window.min.x;
}

double height_of(const Imath::Box2i& window) {
  return 1.0 + window.max.y - window.min.y;
}

/// Bytes of the numbers of all channels.
double bytes_of(const Imf::ChannelList& channels, const Imath::Box2i& window) {
  double pixel = 0;
  for (auto c = channels.begin(); c != channels.end(); ++c)
    pixel += c.channel().type == Imf::HALF ? 2 : 4;
  return width_of(window) * height_of(window) * pixel;
}

void check_windows(const Imf::Header& header, std::size_t packed, double room) {
  constexpr double best_deflate = 1032;  // bytes that one byte of it can become
  const double count = bytes_of(header.channels(), header.dataWindow());
  if (!(count <= best_deflate * static_cast<double>(packed)))
    throw ImageError("the picture has more numbers than its bytes can hold");
  const Imath::Box2i& display = header.displayWindow();
  constexpr double largest_side = 1 << 20;
  const double width = width_of(display), height = height_of(display);
  if (!(width >= 1 && height >= 1 && width <= largest_side && height <= largest_side))
    throw ImageError("no OpenEXR file: its display window is none");
  const double needed =
      display == header.dataWindow() ? count : count + bytes_of(header.channels(), display);
  if (needed > room)
    throw ImageSizeError("a picture of " + std::to_string(static_cast<std::int64_t>(width)) + "x" +
                             std::to_string(static_cast<std::int64_t>(height)) + " pixels",
                         needed);
}

/// Channels of whole numbers are read in single precision.
ExrPicture empty_picture(const Imf::ChannelList& channels, const Imath::Box2i& window) {
  ExrPicture picture{static_cast<int>(width_of(window)), static_cast<int>(height_of(window)), {}};
  const auto pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    if (c.channel().type == Imf::HALF)
      picture.channels.push_back({c.name(), HalfNumbers(pixels)});
    else
      picture.channels.push_back({c.name(), std::vector<float>(pixels)});
  }
  return picture;
}

/// The numbers of the data window at their place in the display window.
ExrPicture placed(const ExrPicture& data, const Imf::Header& header) {
  const Imath::Box2i& from = header.dataWindow();
  const Imath::Box2i& to = header.displayWindow();
  ExrPicture picture = empty_picture(header.channels(), to);
  const int left = std::max(from.min.x, to.min.x), right = std::min(from.max.x, to.max.x);
  if (left > right) return picture;
  const auto at = [](const Imath::Box2i& window, int x, int y) {
    return (std::ptrdiff_t{y} - window.min.y) * static_cast<std::ptrdiff_t>(width_of(window)) +
           (std::ptrdiff_t{x} - window.min.x);
  };
  for (std::size_t c = 0; c < picture.channels.size(); ++c)
    std::visit(
        [&](auto& numbers) {
          const auto& all = std::get<std::decay_t<decltype(numbers)>>(data.channels[c].numbers);
          for (int y = std::max(from.min.y, to.min.y); y <= std::min(from.max.y, to.max.y); ++y)
            std::copy_n(all.begin() + at(from, left, y), std::ptrdiff_t{right} - left + 1,
                        numbers.begin() + at(to, left, y));
        },
        picture.channels[c].numbers);
  return picture;
}

/// Linear light of other primaries as that of BT.709. White stays white: cones see it as they see
/// the other white. Source: Lam 1985, the matrix of Bradford, here for colours as rows.
Imath::M44f to_rec709(const Imf::Chromaticities& from) {
  const Imf::Chromaticities to;
  const Imath::M44f cones(0.8951f, -0.7502f, 0.0389f, 0, 0.2664f, 1.7135f, -0.0685f, 0, -0.1614f,
                          0.0367f, 1.0296f, 0, 0, 0, 0, 1);
  const auto white = [&](const Imath::V2f& w) {
    return Imath::V3f(w.x / w.y, 1, (1 - w.x - w.y) / w.y) * cones;
  };
  Imath::M44f adapt;
  adapt.setScale(white(to.white) / white(from.white));
  return Imf::RGBtoXYZ(from, 1) * cones * adapt * cones.inverse() * Imf::XYZtoRGB(to, 1);
}

/// Files that name no primaries have those of BT.709.
void read_primaries(const Imf::Header& header, ExrPicture& picture) {
  if (!Imf::hasChromaticities(header)) return;
  const Imf::Chromaticities& from = Imf::chromaticities(header);
  constexpr float same = 1e-4f;
  const Imf::Chromaticities own;
  const auto is_own = [&](const Imath::V2f Imf::Chromaticities::*of) {
    return (from.*of).equalWithAbsError(own.*of, same);
  };
  if (is_own(&Imf::Chromaticities::red) && is_own(&Imf::Chromaticities::green) &&
      is_own(&Imf::Chromaticities::blue) && is_own(&Imf::Chromaticities::white))
    return;
  const Imath::M44f matrix = to_rec709(from);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      const float number = matrix[static_cast<int>(column)][static_cast<int>(row)];
      constexpr float largest = 1e3f;
      if (!(std::abs(number) <= largest))
        throw ImageError("an OpenEXR file with chromaticities that no colours have");
      picture.to_rec709[row][column] = number;
    }
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
    const Imf::Header& header = file.header();
    check_windows(header, bytes.size(), room);
    ExrPicture picture = empty_picture(header.channels(), header.dataWindow());
    const Imath::V2i corner = header.dataWindow().min;
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
    if (header.displayWindow() != header.dataWindow()) picture = placed(picture, header);
    read_primaries(header, picture);
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
