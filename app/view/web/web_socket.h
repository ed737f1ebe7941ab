#pragma once
/// Messages of the WebSocket protocol as a server reads and writes them (RFC 6455, no extensions).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace neve::app::view::web {

/// Sec-WebSocket-Accept that answers a Sec-WebSocket-Key (section 4.2.2).
std::string web_socket_accept(std::string_view key);

/// True for 16 bytes in base64, the form of a Sec-WebSocket-Key.
bool is_web_socket_key(std::string_view key);

/// True if the bytes are UTF-8: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view bytes);

enum class Opcode : std::uint8_t {
  continuation = 0,
  text = 1,
  binary = 2,
  close = 8,
  ping = 9,
  pong = 10
};

/// Why a connection is closed (section 7.4).
namespace close_code {
inline constexpr int normal = 1000, going_away = 1001, protocol_error = 1002, unsupported = 1003,
                     invalid_text = 1007, policy = 1008, too_big = 1009, taken = 4000;
}

struct WebMessage {
  Opcode opcode = Opcode::text;  ///< never continuation
  std::string payload;
};

/// Finds messages in the bytes that a browser sends. It buffers at most the longest message
/// allowed: a longer one is refused as soon as its length is known.
class FrameReader {
 public:
  explicit FrameReader(std::size_t max_message) : max_message_(max_message) {}

  void feed(std::string_view bytes) {
    buffer_.erase(0, begin_);
    begin_ = 0;
    buffer_.append(bytes);
  }

  /// @return the next whole message or control frame; none when more bytes are needed or after an
  /// error
  std::optional<WebMessage> next();

  /// Close code of the first offence, 0 while there was none.
  int error() const { return error_; }

  /// True if a part of a frame or of a message has come and the rest has not.
  bool is_midway() const { return begin_ < buffer_.size() || is_fragmented_; }

 private:
  struct Header {
    bool is_final = false;
    Opcode opcode = Opcode::text;
    std::size_t size = 0;      ///< of the header itself
    std::uint64_t length = 0;  ///< of the payload
    char mask[4] = {};
  };
  /// @return false when more bytes are needed or there was an error
  bool read_header(Header& header);
  bool read_length(std::string_view bytes, Header& header, int length_bytes);
  bool is_allowed(const Header& header, unsigned char reserved_bits);
  std::optional<WebMessage> add_fragment(const Header& header, const std::string& payload);
  bool fail(int code);

  std::size_t max_message_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes in the buffer
  std::string message_;    ///< the fragments that have come
  Opcode message_opcode_ = Opcode::text;
  bool is_fragmented_ = false;
  int error_ = 0;
};

/// One unmasked frame with the whole message, as servers send them.
std::string web_socket_frame(Opcode opcode, std::string_view payload);

/// Payload of a close frame; the reason has at most 123 bytes.
std::string close_payload(int code, std::string_view reason);

}  // namespace neve::app::view::web
