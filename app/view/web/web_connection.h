#pragma once
/// One connection to the web server: its input, its unsent output, and its time limits.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/view/web/download.h"
#include "app/view/web/web_socket.h"

namespace neve::app::view::web {

/// Limits of a connection. Every number is a bound on memory or on time.
struct WebLimits {
  int connections = 16;                  ///< at the same time
  std::size_t message = 256 * 1024;      ///< bytes of one message of a page: a pasted text
  double bytes_per_second = 512 * 1024;  ///< read from a page, on average over a second
  double head_seconds = 5;               ///< from connecting to the end of the request
  double message_seconds = 10;           ///< from the first byte of a message to its last
  double stall_seconds = 20;             ///< without a byte taken while there are some to send
  double ping_seconds = 15;              ///< between signs of life; three missing ones are the end
};

/// A socket that does not block. Seconds are of a clock that never goes back.
class Connection {
 public:
  enum class Stage {
    head,    ///< the request is coming
    answer,  ///< an answer is going out, after which nothing more is said
    drain,   ///< waits for the other side to close, so that it can read the answer
    open,    ///< a web socket
    dead
  };

  Connection(int socket, std::uint64_t id, const WebLimits& limits, double now);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Reads the bytes that have come: into head() or the reader of messages.
  void receive(double now);

  /// The bytes of the request so far.
  std::string_view head() const { return head_; }
  /// The request was a web socket's; bytes behind its head are its first messages.
  void open(std::size_t head_size, double now);
  /// Says this and ends.
  void finish(std::string bytes, double now);
  /// Says this and the file, piece by piece, and ends.
  void finish(std::string head, std::unique_ptr<OpenFile> file, double now);
  bool is_sending_file() const { return file_ != nullptr; }

  /// The next message of the page; errors have been answered and end the connection.
  std::optional<WebMessage> next_message(double now);
  /// The program has no room for this one: it is the next one again, and nothing more is read.
  void hold(WebMessage message);
  void release() { is_held_ = false; }

  /// @return messages waiting to go out
  std::size_t queued() const { return out_.size(); }
  void queue(std::string bytes, double now);
  /// Sends as much as the network takes.
  void transmit(double now);

  /// Closes after a timeout; sends a ping when it is due.
  void expire(double now);
  /// Returns the time at which expire() has something to do next.
  double deadline() const;

  bool wants_input() const;
  bool wants_output() const { return !out_.empty() && stage_ != Stage::dead; }
  void kill() { stage_ = Stage::dead; }

  Stage stage() const { return stage_; }
  int socket() const { return socket_; }
  std::uint64_t id() const { return id_; }

 private:
  void note_progress(double now);
  void queue_piece(double now);
  void refill(double now);
  void pong(const WebMessage& ping, double now);
  void end_web_socket(int code, double now);

  const WebLimits& limits_;
  int socket_;
  std::uint64_t id_;
  Stage stage_ = Stage::head;
  std::string head_;
  FrameReader reader_;
  std::optional<WebMessage> held_;
  bool is_held_ = false;
  std::deque<std::string> out_;
  std::unique_ptr<OpenFile> file_;  ///< that follows
  std::uint64_t file_left_ = 0;     ///< bytes of it
  std::size_t sent_ = 0;            ///< bytes of the first of them
  std::size_t drained_ = 0;         ///< bytes thrown away after the answer
  double budget_ = 0;               ///< bytes that may be read now
  double refilled_ = 0;             ///< when the budget was computed
  double stage_end_ = 0;            ///< of head, answer and drain
  double message_start_ = 0;        ///< when the message that is coming began, 0: none is
  double heard_ = 0, pinged_ = 0;
  double moved_ = 0;  ///< when the last byte went out
};

}  // namespace neve::app::view::web
