/// The answer to a Sec-WebSocket-Key. SHA-1 (FIPS 180-4, section 6.1) is asked for by the protocol
/// to show that the server understood; no secret depends on it.

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "app/view/web/web_socket.h"

namespace neve::app::view::web {
namespace {

constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void add_block(std::array<std::uint32_t, 5>& hash, const unsigned char* block) {
  std::array<std::uint32_t, 80> w;
  for (int t = 0; t < 16; ++t)
    w[t] = std::uint32_t(block[4 * t]) << 24 | std::uint32_t(block[4 * t + 1]) << 16 |
           std::uint32_t(block[4 * t + 2]) << 8 | block[4 * t + 3];
  for (int t = 16; t < 80; ++t) w[t] = std::rotl(w[t - 3] ^ w[t - 8] ^ w[t - 14] ^ w[t - 16], 1);
  auto [a, b, c, d, e] = hash;
  for (int t = 0; t < 80; ++t) {
    const std::uint32_t f = t < 20   ? (b & c) | (~b & d)
                            : t < 40 ? b ^ c ^ d
                            : t < 60 ? (b & c) | (b & d) | (c & d)
                                     : b ^ c ^ d;
    constexpr std::uint32_t k[4] = {0x5A827999, 0x6ED9EBA1, 0x8F1BBCDC, 0xCA62C1D6};
    const std::uint32_t next = std::rotl(a, 5) + f + e + k[t / 20] + w[t];
    e = d;
    d = c;
    c = std::rotl(b, 30);
    b = a;
    a = next;
  }
  const std::uint32_t last[5] = {a, b, c, d, e};
  for (int k = 0; k < 5; ++k) hash[k] += last[k];
}

std::string sha1(std::string bytes) {
  const std::uint64_t bits = bytes.size() * 8;
  bytes += char(0x80);
  while (bytes.size() % 64 != 56) bytes += char(0);
  for (int k = 7; k >= 0; --k) bytes += char(bits >> (8 * k) & 0xFF);
  std::array<std::uint32_t, 5> hash = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
  for (std::size_t k = 0; k < bytes.size(); k += 64)
    add_block(hash, reinterpret_cast<const unsigned char*>(bytes.data() + k));
  std::string digest;
  for (const std::uint32_t word : hash)
    for (int k = 3; k >= 0; --k) digest += char(word >> (8 * k) & 0xFF);
  return digest;
}

std::string base64(std::string_view bytes) {
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (k + j < bytes.size() ? static_cast<unsigned char>(bytes[k + j]) : 0);
    for (std::size_t j = 0; j < 4; ++j)
      text += k + j <= bytes.size() ? base64_digits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

}  // namespace

std::string web_socket_accept(std::string_view key) {
  return base64(sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

bool is_web_socket_key(std::string_view key) {
  return key.size() == 24 && key.ends_with("==") &&
         key.find_first_not_of(base64_digits) == key.size() - 2;
}

}  // namespace neve::app::view::web
