#include "app/view/web/web_connection.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace neve::app::view::web {
namespace {

constexpr double drain_seconds = 1;
constexpr std::size_t max_drained = 256 * 1024;
constexpr double missing_pings = 3;
/// A file takes so many bytes in memory at a time, and sends them before others have their turn.
constexpr std::size_t file_piece = 256 * 1024;

}  // namespace

Connection::Connection(int socket, std::uint64_t id, const WebLimits& limits, double now)
    : limits_(limits),
      socket_(socket),
      id_(id),
      reader_(limits.message),
      budget_(limits.bytes_per_second),
      refilled_(now),
      stage_end_(now + limits.head_seconds) {}

Connection::~Connection() {
  ::close(socket_);
}

void Connection::receive(double now) {
  std::array<char, 16384> bytes;
  const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) return kill();
  switch (stage_) {
    case Stage::head:
      head_.append(bytes.data(), count);
      break;
    case Stage::open:
      refill(now);
      budget_ -= double(count);
      heard_ = now;
      reader_.feed({bytes.data(), std::size_t(count)});
      break;
    default:
      drained_ += count;
      if (drained_ > max_drained) kill();
  }
}

void Connection::open(std::size_t head_size, double now) {
  stage_ = Stage::open;
  heard_ = pinged_ = moved_ = now;
  reader_.feed(std::string_view(head_).substr(head_size));
  head_.clear();
}

void Connection::finish(std::string bytes, double now) {
  stage_ = Stage::answer;
  stage_end_ = now + limits_.head_seconds;
  queue(std::move(bytes), now);
  transmit(now);
}

void Connection::finish(std::string head, std::unique_ptr<OpenFile> file, double now) {
  file_left_ = file->size();
  file_ = std::move(file);
  finish(std::move(head), now);
}

/// A file that became shorter ends the connection: the other side sees that it is not whole.
void Connection::queue_piece(double now) {
  std::string piece = file_->read(std::min<std::uint64_t>(file_piece, file_left_));
  if (piece.empty()) return kill();
  file_left_ -= piece.size();
  queue(std::move(piece), now);
}

void Connection::end_web_socket(int code, double now) {
  finish(web_socket_frame(Opcode::close, close_payload(code, {})), now);
}

void Connection::note_progress(double now) {
  if (!reader_.is_midway())
    message_start_ = 0;
  else if (message_start_ == 0)
    message_start_ = now;
}

std::optional<WebMessage> Connection::next_message(double now) {
  while (stage_ == Stage::open && !is_held_) {
    auto message = held_ ? std::move(held_) : reader_.next();
    held_.reset();
    if (!message) {
      if (reader_.error())
        end_web_socket(reader_.error(), now);
      else
        note_progress(now);
      return {};
    }
    // Control frames may come between the pieces of a message and do not make it younger.
    if (message->opcode < Opcode::close) message_start_ = 0;
    switch (message->opcode) {
      case Opcode::text:
        return message;
      case Opcode::ping:
        pong(*message, now);
        break;
      case Opcode::pong:
        break;
      case Opcode::close:
        end_web_socket(
            message->payload.size() == 1 ? close_code::protocol_error : close_code::normal, now);
        break;
      default:
        end_web_socket(close_code::unsupported, now);
    }
  }
  return {};
}

void Connection::pong(const WebMessage& ping, double now) {
  // A page that asks faster than it listens gets one answer for all (section 5.5.3).
  if (queued() < 4) queue(web_socket_frame(Opcode::pong, ping.payload), now);
}

void Connection::hold(WebMessage message) {
  held_ = std::move(message);
  is_held_ = true;
}

void Connection::queue(std::string bytes, double now) {
  if (out_.empty()) moved_ = now;
  out_.push_back(std::move(bytes));
}

void Connection::transmit(double now) {
  while (!out_.empty()) {
    const std::string& first = out_.front();
    const ssize_t count =
        ::send(socket_, first.data() + sent_, first.size() - sent_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count < 0) return kill();
    moved_ = now;
    if (file_) stage_end_ = now + limits_.stall_seconds;
    sent_ += count;
    if (sent_ < first.size()) return;
    out_.pop_front();
    sent_ = 0;
  }
  if (file_ && file_left_ > 0) return queue_piece(now);
  file_.reset();
  if (stage_ != Stage::answer) return;
  // If it closed at once with bytes unread, the answer would be lost with the connection.
  ::shutdown(socket_, SHUT_WR);
  stage_ = Stage::drain;
  stage_end_ = now + drain_seconds;
}

bool Connection::wants_input() const {
  if (stage_ == Stage::open) return !is_held_ && budget_ > 0;
  return stage_ == Stage::head || stage_ == Stage::drain;
}

void Connection::refill(double now) {
  budget_ =
      std::min(limits_.bytes_per_second, budget_ + (now - refilled_) * limits_.bytes_per_second);
  refilled_ = now;
}

void Connection::expire(double now) {
  if (stage_ != Stage::open) {
    if (now >= stage_end_) kill();
    return;
  }
  refill(now);
  // While the program is busy nothing is read, and nothing can be heard.
  if (is_held_) heard_ = now;
  if (message_start_ > 0 && now >= message_start_ + limits_.message_seconds)
    return end_web_socket(close_code::policy, now);
  if (now >= heard_ + missing_pings * limits_.ping_seconds ||
      (!out_.empty() && now >= moved_ + limits_.stall_seconds))
    return kill();
  if (now >= std::max(heard_, pinged_) + limits_.ping_seconds) {
    pinged_ = now;
    queue(web_socket_frame(Opcode::ping, {}), now);
  }
}

double Connection::deadline() const {
  if (stage_ != Stage::open) return stage_end_;
  double soonest = std::max(heard_, pinged_) + limits_.ping_seconds;
  soonest = std::min(soonest, heard_ + missing_pings * limits_.ping_seconds);
  if (message_start_ > 0) soonest = std::min(soonest, message_start_ + limits_.message_seconds);
  if (!out_.empty()) soonest = std::min(soonest, moved_ + limits_.stall_seconds);
  // The wait is long enough for a sensible piece to be allowed again.
  if (budget_ <= 0)
    soonest = std::min(soonest, refilled_ + 0.02 - budget_ / limits_.bytes_per_second);
  return soonest;
}

}  // namespace neve::app::view::web
