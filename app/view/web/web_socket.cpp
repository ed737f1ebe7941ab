#include "app/view/web/web_socket.h"

#include <algorithm>

namespace neve::app::view::web {

bool is_utf8(std::string_view bytes) {
  for (std::size_t k = 0; k < bytes.size();) {
    const unsigned char first = bytes[k];
    const int more = first < 0x80                     ? 0
                     : first >= 0xC2 && first <= 0xDF ? 1
                     : first >= 0xE0 && first <= 0xEF ? 2
                     : first >= 0xF0 && first <= 0xF4 ? 3
                                                      : -1;
    if (more < 0 || bytes.size() - k <= std::size_t(more)) return false;
    for (int j = 1; j <= more; ++j)
      if ((static_cast<unsigned char>(bytes[k + j]) & 0xC0) != 0x80) return false;
    // The second byte tells overlong forms, surrogates and values beyond the last code point.
    const unsigned char second = more > 0 ? bytes[k + 1] : 0;
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
        (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
      return false;
    k += more + 1;
  }
  return true;
}

bool FrameReader::fail(int code) {
  error_ = code;
  buffer_.clear();
  begin_ = 0;
  message_.clear();
  is_fragmented_ = false;
  return false;
}

bool FrameReader::read_length(std::string_view bytes, Header& header, int length_bytes) {
  if (length_bytes == 0) return true;
  if (bytes.size() < std::size_t(2 + length_bytes)) return false;
  header.length = 0;
  for (int k = 0; k < length_bytes; ++k)
    header.length = header.length << 8 | static_cast<unsigned char>(bytes[2 + k]);
  // Lengths are written in as few bytes as they need (section 5.2).
  const std::uint64_t least = length_bytes == 2 ? 126 : 0x10000;
  return (header.length >= least && !(header.length >> 63)) || fail(close_code::protocol_error);
}

bool FrameReader::read_header(Header& header) {
  const std::string_view bytes = std::string_view(buffer_).substr(begin_);
  if (bytes.size() < 2) return false;
  const unsigned char first = bytes[0], second = bytes[1];
  header.is_final = first & 0x80;
  header.opcode = Opcode(first & 0x0F);
  // Browsers mask what they send; a server has to refuse everything else (section 5.1).
  if (!(second & 0x80)) return fail(close_code::protocol_error);
  header.length = second & 0x7F;
  const int length_bytes = header.length == 126 ? 2 : header.length == 127 ? 8 : 0;
  if (!read_length(bytes, header, length_bytes) || !is_allowed(header, first & 0x70)) return false;
  header.size = 2 + length_bytes + 4;
  if (bytes.size() < header.size) return false;
  std::copy_n(bytes.begin() + 2 + length_bytes, 4, header.mask);
  return true;
}

bool FrameReader::is_allowed(const Header& header, unsigned char reserved_bits) {
  if (reserved_bits) return fail(close_code::protocol_error);
  switch (header.opcode) {
    case Opcode::text:
    case Opcode::binary:
      if (is_fragmented_) return fail(close_code::protocol_error);
      break;
    case Opcode::continuation:
      if (!is_fragmented_) return fail(close_code::protocol_error);
      break;
    case Opcode::close:
    case Opcode::ping:
    case Opcode::pong:
      if (!header.is_final || header.length > 125) return fail(close_code::protocol_error);
      return true;
    default:
      return fail(close_code::protocol_error);
  }
  if (header.length > max_message_ - std::min(max_message_, message_.size()))
    return fail(close_code::too_big);
  return true;
}

std::optional<WebMessage> FrameReader::add_fragment(const Header& header,
                                                    const std::string& payload) {
  if (header.opcode != Opcode::continuation) message_opcode_ = header.opcode;
  message_ += payload;
  is_fragmented_ = !header.is_final;
  if (is_fragmented_) return {};
  WebMessage whole{message_opcode_, std::move(message_)};
  message_.clear();
  if (whole.opcode == Opcode::text && !is_utf8(whole.payload)) {
    fail(close_code::invalid_text);
    return {};
  }
  return whole;
}

std::optional<WebMessage> FrameReader::next() {
  while (!error_) {
    Header header;
    if (!read_header(header)) return {};
    // The length was held against the limit, so that it is small here.
    const std::size_t length = std::size_t(header.length);
    if (buffer_.size() - begin_ - header.size < length) return {};
    std::string payload = buffer_.substr(begin_ + header.size, length);
    for (std::size_t k = 0; k < length; ++k) payload[k] = char(payload[k] ^ header.mask[k & 3]);
    begin_ += header.size + length;
    if (header.opcode >= Opcode::close) return WebMessage{header.opcode, std::move(payload)};
    if (auto whole = add_fragment(header, payload)) return whole;
  }
  return {};
}

std::string web_socket_frame(Opcode opcode, std::string_view payload) {
  std::string frame(1, char(0x80 | int(opcode)));
  const std::uint64_t length = payload.size();
  const int length_bytes = length < 126 ? 0 : length < 0x10000 ? 2 : 8;
  frame += char(length_bytes == 0 ? int(length) : length_bytes == 2 ? 126 : 127);
  for (int k = length_bytes - 1; k >= 0; --k) frame += char(length >> (8 * k) & 0xFF);
  frame.append(payload);
  return frame;
}

std::string close_payload(int code, std::string_view reason) {
  std::string payload{char(code >> 8), char(code & 0xFF)};
  payload.append(reason.substr(0, 123));
  return payload;
}

}  // namespace neve::app::view::web
