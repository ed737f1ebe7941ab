#pragma once
/// The other side of a web server, byte by byte, so that a test can also say what no browser says.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace neve::test {

/// A connection to a port of this machine.
class RawSocket {
 public:
  explicit RawSocket(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0)
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawSocket() { close(); }
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;

  bool is_connected() const { return is_connected_; }
  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  /// Ends what another thread waits for in send().
  void shut_down() { ::shutdown(socket_, SHUT_RDWR); }
  /// Ends with a reset: the other side sees an error, not an end.
  void abort() {
    const linger now{1, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    close();
  }

  /// @return false when the other side has closed
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(count);
    }
    return true;
  }

  /// Waits for more bytes and appends them. @return false when none came in time or it is closed
  bool receive(std::string& bytes, double seconds) {
    pollfd file{socket_, POLLIN, 0};
    if (::poll(&file, 1, int(seconds * 1000)) <= 0) return false;
    char some[65536];
    const ssize_t count = ::recv(socket_, some, sizeof some, 0);
    if (count <= 0) {
      is_closed_ = true;
      return false;
    }
    bytes.append(some, count);
    return true;
  }

  /// Everything until the other side closes, or nothing more comes for so long.
  std::string receive_all(double seconds) {
    std::string bytes;
    while (receive(bytes, seconds)) {
    }
    return bytes;
  }

  /// True if the other side has closed; set by receive().
  bool is_closed() const { return is_closed_; }

 private:
  int socket_;
  bool is_connected_ = false, is_closed_ = false;
};

/// One frame as a client sends it.
/// @param first FIN, reserved bits and the opcode
inline std::string client_frame(int first, std::string_view payload, bool is_masked = true) {
  std::string frame(1, char(first));
  const int mask_bit = is_masked ? 0x80 : 0;
  const std::uint64_t length = payload.size();
  const int bytes = length < 126 ? 0 : length < 65536 ? 2 : 8;
  frame += char(mask_bit | (bytes == 0 ? int(length) : bytes == 2 ? 126 : 127));
  for (int k = bytes - 1; k >= 0; --k) frame += char(length >> (8 * k) & 0xFF);
  const char mask[4] = {0x12, 0x34, 0x56, 0x78};
  if (is_masked) frame.append(mask, 4);
  for (std::size_t k = 0; k < payload.size(); ++k)
    frame += char(is_masked ? payload[k] ^ mask[k & 3] : payload[k]);
  return frame;
}

struct ServerFrame {
  int opcode = 0;
  std::string payload;
};

/// A web socket. Every frame of the server is held against RFC 6455; a wrong one throws.
class WebClient {
 public:
  static constexpr int text = 1, binary = 2, closing = 8, ping = 9, pong = 10;

  /// @param target path and query
  /// @param headers more lines, each with its end
  WebClient(int port, const std::string& target, const std::string& headers, int receive_buffer = 0)
      : socket_(port, receive_buffer) {
    // Key and answer are the example of RFC 6455, section 1.3.
    socket_.send("GET " + target +
                 " HTTP/1.1\r\nUpgrade: websocket\r\nConnection: keep-alive, Upgrade\r\n"
                 "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                 headers + "\r\n");
    while (bytes_.find("\r\n\r\n") == std::string::npos && socket_.receive(bytes_, 5)) {
    }
    const std::size_t end = bytes_.find("\r\n\r\n");
    answer_ = bytes_.substr(0, end);
    is_open_ = answer_.starts_with("HTTP/1.1 101 ") &&
               answer_.find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") != std::string::npos;
    bytes_.erase(0, end == std::string::npos ? bytes_.size() : end + 4);
  }

  bool is_open() const { return is_open_; }
  const std::string& answer() const { return answer_; }
  RawSocket& socket() { return socket_; }

  bool send_text(std::string_view payload) { return socket_.send(client_frame(0x81, payload)); }
  bool send_frame(int first, std::string_view payload, bool is_masked = true) {
    return socket_.send(client_frame(first, payload, is_masked));
  }

  /// The next frame; none when it does not come in time or the connection has ended.
  std::optional<ServerFrame> receive(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
      if (auto frame = take_frame()) return frame;
      const std::chrono::duration<double> left = end - std::chrono::steady_clock::now();
      if (left.count() <= 0 || !socket_.receive(bytes_, left.count())) return {};
    }
  }

  /// The next frame of this kind; others are dropped.
  std::optional<ServerFrame> receive(int opcode, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
      const std::chrono::duration<double> left = end - std::chrono::steady_clock::now();
      auto frame = receive(std::max(0.0, left.count()));
      if (!frame || frame->opcode == opcode) return frame;
    }
  }

  /// Code with which the server closes; 0 when it does not, -1 when it ends without one.
  int close_code(double seconds) {
    const auto frame = receive(closing, seconds);
    if (!frame) return socket_.is_closed() ? -1 : 0;
    if (frame->payload.size() < 2) return -1;
    return static_cast<unsigned char>(frame->payload[0]) << 8 |
           static_cast<unsigned char>(frame->payload[1]);
  }

 private:
  std::optional<ServerFrame> take_frame() {
    if (bytes_.size() < 2) return {};
    const unsigned char first = bytes_[0], second = bytes_[1];
    if ((first & 0xF0) != 0x80) throw std::runtime_error("a frame in pieces or with reserved bits");
    if (second & 0x80) throw std::runtime_error("a masked frame from a server");
    std::uint64_t length = second & 0x7F;
    const std::size_t extra = length == 126 ? 2 : length == 127 ? 8 : 0;
    if (bytes_.size() < 2 + extra) return {};
    if (extra > 0) length = 0;
    for (std::size_t k = 0; k < extra; ++k)
      length = length << 8 | static_cast<unsigned char>(bytes_[2 + k]);
    if (bytes_.size() - 2 - extra < length) return {};
    ServerFrame frame{first & 0x0F, bytes_.substr(2 + extra, length)};
    bytes_.erase(0, 2 + extra + length);
    return frame;
  }

  RawSocket socket_;
  std::string bytes_, answer_;
  bool is_open_ = false;
};

}  // namespace neve::test
