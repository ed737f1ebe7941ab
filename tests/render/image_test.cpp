#include "render/image/image.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <thread>

#include "render/image/png_chunks.h"

namespace neve::render {
namespace {

Image noise(int width, int height, int channels) {
  Image image{width, height, channels, {}};
  std::mt19937 random(7);
  for (int i = 0; i < width * height * channels; ++i)
    image.pixels.push_back(static_cast<std::uint8_t>(random() & 255u));
  return image;
}

/// A chunk with a valid length and checksum around any content.
std::vector<std::uint8_t> chunk(const std::string& type, const std::string& data) {
  const std::string typed = type + data;
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(typed.data()), static_cast<uInt>(typed.size())));
  const auto big_endian = [](std::size_t v) {
    std::string four;
    for (const int s : {24, 16, 8, 0}) four += static_cast<char>(v >> s & 255u);
    return four;
  };
  const std::string all = big_endian(data.size()) + typed + big_endian(sum);
  return {all.begin(), all.end()};
}

std::vector<std::uint8_t> png_with(const std::vector<std::uint8_t>& extra) {
  std::vector<std::uint8_t> bytes = encode_png(noise(3, 2, 3));
  bytes.insert(bytes.begin() + 33, extra.begin(), extra.end());
  return bytes;
}

TEST(Png, RoundTripKeepsEveryPixel) {
  for (const int channels : {1, 3, 4}) {
    const Image image = noise(37, 21, channels);
    const Image back = decode_png(encode_png(image));
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 21);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Png, TextRoundTripKeepsUtf8AndLength) {
  const PngText text = {{"title", "Boule de névé ξ ∇"},
                        {"scene", std::string(200000, 'x') + "\n[solver]\n"},
                        {"empty", ""}};
  const std::vector<std::uint8_t> bytes = encode_png(noise(5, 4, 3), text);
  EXPECT_EQ(read_png_text(bytes), text);
  EXPECT_EQ(decode_png(bytes).pixels, noise(5, 4, 3).pixels);
}

TEST(Png, APictureSaysThatItIsSrgb) {
  const std::vector<std::uint8_t> bytes = encode_png(noise(3, 2, 3));
  std::vector<std::string> types;
  for (const PngChunk& part : read_png_chunks(bytes)) types.push_back(part.type);
  EXPECT_EQ(types, (std::vector<std::string>{"IHDR", "sRGB", "gAMA", "cHRM", "IDAT", "IEND"}));
  EXPECT_EQ(read_png_gamma(bytes), 0);
  std::vector<std::uint8_t> linear = bytes;
  const std::vector<std::uint8_t> gamma = chunk("gAMA", std::string("\0\1\x86\xa0", 4));
  linear.erase(linear.begin() + 33, linear.begin() + 33 + 13);  // the chunk sRGB
  linear.erase(linear.begin() + 33, linear.begin() + 33 + 16);  // gAMA
  linear.insert(linear.begin() + 33, gamma.begin(), gamma.end());
  EXPECT_DOUBLE_EQ(read_png_gamma(linear), 1);
}

TEST(Png, TextOfOtherToolsIsReadOrSkipped) {
  const std::string zero(1, '\0');
  EXPECT_EQ(read_png_text(png_with(chunk("tEXt", "Author" + zero + "Zo\xeb"))).at("Author"), "Zoë");
  const std::string compressed = "note" + zero + "\x01" + zero + zero + zero + "\x78\x9c";
  EXPECT_TRUE(read_png_text(png_with(chunk("iTXt", compressed))).empty());
  const std::string translated =
      "note" + zero + zero + zero + "fr" + zero + "n\xc3\xb4te" + zero + "oui";
  EXPECT_EQ(read_png_text(png_with(chunk("iTXt", translated))).at("note"), "oui");
}

TEST(Png, EveryTruncationIsAnError) {
  const std::vector<std::uint8_t> bytes = encode_png(noise(9, 7, 3), {{"key", "value"}});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::span<const std::uint8_t> part(bytes.data(), size);
    EXPECT_THROW(decode_png(part), ImageError) << size;
    EXPECT_THROW(read_png_text(part), ImageError) << size;
  }
}

TEST(Png, EveryDamagedByteIsAnError) {
  const std::vector<std::uint8_t> bytes = encode_png(noise(9, 7, 3), {{"key", "value"}});
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::uint8_t> bad = bytes;
    bad[i] ^= 0x41;
    EXPECT_THROW(decode_png(bad), ImageError) << i;
  }
}

TEST(Png, GarbageAndMalformedTextAreErrors) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint8_t> garbage(random() % 300);
    for (std::uint8_t& b : garbage) b = static_cast<std::uint8_t>(random());
    EXPECT_THROW(decode_png(garbage), ImageError);
    // The same behind a proper signature.
    const std::vector<std::uint8_t> start = encode_png(noise(1, 1, 3));
    garbage.insert(garbage.begin(), start.begin(), start.begin() + 8);
    EXPECT_THROW(read_png_text(garbage), ImageError);
  }
  const std::string zero(1, '\0');
  for (const std::string& data : {std::string(), std::string("key"), "key" + zero,
                                  "key" + zero + zero, "key" + zero + zero + zero + "fr"})
    EXPECT_THROW(read_png_text(png_with(chunk("iTXt", data))), ImageError);
  EXPECT_THROW(read_png_text(png_with(chunk("tEXt", "no end"))), ImageError);
  // A length that would wrap around when added to.
  std::vector<std::uint8_t> huge = chunk("tEXt", "a");
  for (std::size_t i = 0; i < 4; ++i) huge[i] = 0xff;
  EXPECT_THROW(read_png_text(png_with(huge)), ImageError);
}

TEST(Png, UnusableInputIsRefused) {
  EXPECT_THROW(encode_png({}), ImageError);
  EXPECT_THROW(encode_png({4, 4, 3, std::vector<std::uint8_t>(47)}), ImageError);
  const Image image = noise(2, 2, 3);
  for (const std::string& keyword :
       {std::string(), std::string(80, 'k'), std::string(" k"), std::string("a\nb")})
    EXPECT_THROW(encode_png(image, {{keyword, "v"}}), ImageError);
  EXPECT_THROW(encode_png(image, {{"k", std::string("a\0b", 3)}}), ImageError);
}

/// 4 GiB of pixels in a hundred bytes.
/// All checksums are right, but the pixels are in a block of deflate of the type that does not
/// exist (RFC 1951, 3.2.3). stb has no reason for it; one of an earlier picture would hide that, so
/// a thread of its own reads it.
TEST(Png, ABlockOfAnUnknownTypeIsAnError) {
  const std::vector<std::uint8_t> bytes{
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00,
      0x00, 0xfd, 0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x19, 0x49, 0x44, 0x41, 0x54, 0x78,
      0x01, 0x0e, 0x00, 0x00, 0xf1, 0xff, 0x01, 0x64, 0x64, 0x64, 0x00, 0x00, 0x00, 0x01,
      0x64, 0x64, 0x64, 0x00, 0x00, 0x00, 0x14, 0x0f, 0x02, 0x5b, 0xbc, 0x71, 0xfb, 0x67,
      0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  std::thread([&] { EXPECT_THROW(decode_png(bytes), ImageError); }).join();
}

TEST(Png, AFewBytesAreNoLargePicture) {
  const std::vector<std::uint8_t> small = encode_png(noise(4, 4, 3));
  std::vector<std::uint8_t> large = small;
  for (const std::size_t at : {18, 22}) large[at] = 0x40;  // 16384 + 4 pixels wide and high
  const auto sum =
      static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), large.data() + 12, 17));
  for (std::size_t k = 0; k < 4; ++k)
    large[29 + k] = static_cast<std::uint8_t>(sum >> (24 - 8 * k));
  try {
    decode_png(large);
    FAIL();
  } catch (const ImageError& error) {
    EXPECT_NE(std::string(error.what()).find("16388x16388"), std::string::npos) << error.what();
  }
}

TEST(Compare, ComparisonMeasuresLargestAndMeanDifference) {
  const Image a{2, 1, 3, {0, 10, 20, 30, 40, 50}};
  const Image b{2, 1, 3, {0, 13, 20, 30, 40, 41}};
  EXPECT_EQ(compare(a, b).max, 9);
  EXPECT_DOUBLE_EQ(compare(a, b).mean, 2);
  EXPECT_EQ(compare(a, a).max, 0);
  EXPECT_EQ(difference_image(a, b).pixels, (std::vector<std::uint8_t>{0, 24, 0, 0, 0, 72}));
  EXPECT_THROW(compare(a, noise(1, 2, 3)), ImageError);
}

TEST(Compare, ColoursCountByTheAlphaOfTheirPixel) {
  const Image a{3, 1, 4, {255, 255, 255, 0, 0, 0, 255, 1, 200, 100, 50, 255}};
  const Image b{3, 1, 4, {0, 0, 0, 0, 255, 0, 0, 1, 200, 100, 50, 255}};
  EXPECT_EQ(compare(a, b).max, 1) << "a pixel that covers one part of 255";
  Image c = b;
  c.pixels[11] = 155;  // half as much of the last pixel
  EXPECT_EQ(compare(b, c).max, 100);
  const Image difference = difference_image(b, c);
  ASSERT_EQ(difference.channels, 3) << "it can be seen";
  EXPECT_EQ(difference.pixels[6], 255);
}

TEST(Compare, ComparisonFindsTheSquareThatDiffersMost) {
  Image a{40, 20, 3, std::vector<std::uint8_t>(40 * 20 * 3, 100)};
  Image b = a;
  EXPECT_EQ(compare(a, b).local, 0);
  // All of the narrow square in the lower right corner, which is 8 wide and 4 high.
  for (int y = 16; y < 20; ++y)
    for (int x = 32; x < 40; ++x)
      for (int c = 0; c < 3; ++c) b.pixels[static_cast<std::size_t>(3 * (y * 40 + x) + c)] = 130;
  EXPECT_DOUBLE_EQ(compare(a, b).local, 30);
  EXPECT_DOUBLE_EQ(compare(a, b).mean, 30.0 * 32 / 800);
  EXPECT_EQ(compare(a, b).max, 30);
}

}  // namespace
}  // namespace neve::render
