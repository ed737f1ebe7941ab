#include "app/view/web/web_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <string>
#include <string_view>

#include "app/support/clock.h"
#include "app/view/web/web_listen.h"

namespace neve::app::view::web {

/// Files of this folder that are compiled in; see cmake/EmbedFiles.cmake.
std::string_view find_embedded_page(std::string_view file_name);

namespace {

constexpr double goodbye_seconds = 0.5;

std::string plain(int status, std::string_view sentence, const HttpHeaders& more = {}) {
  return http_answer(status, "text/plain; charset=utf-8", std::string(sentence) + "\n", more);
}

std::string fill_in(std::string_view page, const std::string& number) {
  std::string text(page);
  constexpr std::string_view mark = "{{nonce}}";
  for (std::size_t k = 0; (k = text.find(mark, k)) != std::string::npos; k += number.size())
    text.replace(k, mark.size(), number);
  return text;
}

std::string answer_with(int status, std::string_view file, const std::string& may_connect) {
  const std::string nonce = make_token();
  const std::string policy = "default-src 'none'; script-src 'nonce-" + nonce +
                             "'; style-src 'nonce-" + nonce + "'; connect-src " + may_connect +
                             "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
  return http_answer(status, "text/html; charset=utf-8", fill_in(find_embedded_page(file), nonce),
                     {{"Content-Security-Policy", policy}});
}

/// The answer with the page. Its script and its style carry a number of this answer only, so that
/// nothing else can run in it, and it may connect only to these places.
/// @param sockets  origins of web sockets between blanks, of checked hosts: "ws://localhost:8080"
std::string page_answer(const std::string& sockets) {
  return answer_with(200, "web_page.html", sockets);
}

/// Answer to a request without token. A reloaded tab finds its token again.
std::string no_token_answer() {
  return answer_with(403, "web_no_token.html", "'none'");
}

}  // namespace

WebServer::WebServer(const WebServerOptions& options, const WebGuard& guard, WebListener& listener)
    : limits_(options.limits),
      goodbye_(options.goodbye),
      replaced_(options.replaced),
      guard_(guard),
      listener_(listener),
      socket_(listen_at(options.address, options.port)),
      bell_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  thread_ = std::thread([this] { run(); });
}

WebServer::~WebServer() {
  is_ending_ = true;
  poke();
  thread_.join();
  ::close(socket_);
  ::close(bell_);
}

int WebServer::port() const {
  return port_of(socket_);
}

void WebServer::poke() {
  const std::uint64_t one = 1;
  // It can only fail when the bell rings already.
  [[maybe_unused]] const ssize_t written = ::write(bell_, &one, sizeof one);
}

void WebServer::send(std::uint64_t viewer, Opcode opcode, std::string_view payload) {
  std::string frame = web_socket_frame(opcode, payload);
  {
    const std::lock_guard lock(mutex_);
    if (viewer == 0 || viewer != viewer_) return;
    posted_.push_back(std::move(frame));
    ++unsent_;
  }
  poke();
}

int WebServer::unsent(std::uint64_t viewer) const {
  const std::lock_guard lock(mutex_);
  return viewer == viewer_ ? unsent_ : 0;
}

void WebServer::resume() {
  {
    const std::lock_guard lock(mutex_);
    is_resumed_ = true;
  }
  poke();
}

std::string WebServer::offer(std::unique_ptr<OpenFile> file) {
  const std::lock_guard lock(mutex_);
  return tickets_.add(std::move(file), clock_seconds());
}

void WebServer::run() {
  while (!is_ending_) {
    const double now = clock_seconds();
    take_posted(now);
    wait(now);
  }
  say_goodbye();
}

void WebServer::take_posted(double now) {
  std::vector<std::string> frames;
  bool is_resumed = false;
  {
    const std::lock_guard lock(mutex_);
    frames.swap(posted_);
    std::swap(is_resumed, is_resumed_);
  }
  Connection* const to = viewer();
  if (!to) return;
  for (std::string& frame : frames) to->queue(std::move(frame), now);
  to->transmit(now);
  if (is_resumed) {
    to->release();
    serve(*to, now);
  }
  note_unsent();
}

void WebServer::wait(double now) {
  std::vector<pollfd> files{{bell_, POLLIN, 0},
                            {socket_, short(now >= accept_again_ ? POLLIN : 0), 0}};
  double soonest = now < accept_again_ ? accept_again_ : HUGE_VAL;
  for (const auto& connection : connections_) {
    const int events =
        (connection->wants_input() ? POLLIN : 0) | (connection->wants_output() ? POLLOUT : 0);
    files.push_back({connection->socket(), short(events), 0});
    soonest = std::min(soonest, connection->deadline());
  }
  const double seconds = std::max(0.0, soonest - now);
  // The wait is rounded up, so that a deadline has passed when poll returns.
  const int milliseconds = seconds < 1e6 ? int(std::ceil(seconds * 1000)) : -1;
  if (::poll(files.data(), files.size(), milliseconds) < 0) return;
  now = clock_seconds();
  std::uint64_t rings;
  if (files[0].revents) [[maybe_unused]]
    const ssize_t got = ::read(bell_, &rings, sizeof rings);
  // Connections that are accepted now were not among those looked at.
  for (std::size_t k = 0; k + 2 < files.size(); ++k) {
    Connection& connection = *connections_[k];
    const short happened = files[k + 2].revents;
    if (happened & POLLOUT) connection.transmit(now);
    if (happened & POLLIN)
      connection.receive(now);
    else if (happened & (POLLERR | POLLHUP | POLLNVAL))
      connection.kill();
    if (happened & POLLIN) serve(connection, now);
    connection.expire(now);
  }
  if (files[1].revents) accept_all(now);
  forget_dead();
  note_unsent();
}

void WebServer::accept_all(double now) {
  for (int k = 0; k < limits_.connections; ++k) {
    const int socket = accept_at(socket_);
    if (socket < 0) {
      // Without files or memory, what waits stays there, and asking again at once would not help.
      if (errno != EAGAIN && errno != EINTR && errno != ECONNABORTED) accept_again_ = now + 1;
      return;
    }
    make_room();
    connections_.push_back(std::make_unique<Connection>(socket, next_id_++, limits_, now));
  }
}

/// Closes the oldest connection that is neither the viewer's nor sends it a file, so that idle
/// connections block nobody out.
void WebServer::make_room() {
  if (int(connections_.size()) < limits_.connections) return;
  const auto oldest =
      std::find_if(connections_.begin(), connections_.end(), [](const auto& connection) {
        return connection->stage() != Connection::Stage::open && !connection->is_sending_file();
      });
  if (oldest != connections_.end()) connections_.erase(oldest);
}

void WebServer::serve(Connection& connection, double now) {
  if (connection.stage() == Connection::Stage::head) answer_head(connection, now);
  while (auto message = connection.next_message(now))
    if (!listener_.on_message(connection.id(), message->payload))
      connection.hold(std::move(*message));
}

void WebServer::answer_head(Connection& connection, double now) {
  const HttpHead head = read_http_head(connection.head());
  if (head.status == 0) return;
  if (head.status != 200)
    return connection.finish(plain(head.status, "neve does not accept this request"), now);
  HttpRequest request = head.request;
  request.path = guard_.own_path(request.path);
  if (std::string refusal = refusal_of(request); !refusal.empty())
    return connection.finish(std::move(refusal), now);
  if (std::unique_ptr<OpenFile> file = file_for(request, now)) {
    std::string answer = http_file_head(file->name(), file->size());
    return connection.finish(std::move(answer), std::move(file), now);
  }
  if (std::string page = answer(request); !page.empty())
    return connection.finish(std::move(page), now);
  open_viewer(connection, head.size, request.header("sec-websocket-key"), now);
}

/// @return the answer to a request that comes from another place or asks for more than to read
std::string WebServer::refusal_of(const HttpRequest& request) const {
  if (!guard_.is_own_host(request.header("host")))
    return plain(403, "this address does not belong to neve");
  // Browsers omit Origin when the user opens a page, never when a script opens a web socket.
  if ((request.path == "/ws" || request.has_header("origin")) && !guard_.is_own_origin(request))
    return plain(403, "another page may not talk to neve");
  if (request.method != "GET") return plain(405, "only GET", {{"Allow", "GET"}});
  return {};
}

/// The file of a ticket; null for every other request. The ticket takes the place of the token,
/// which would stay in the browser's list of downloads.
std::unique_ptr<OpenFile> WebServer::file_for(const HttpRequest& request, double now) {
  if (!request.path.starts_with(download_path)) return nullptr;
  const std::lock_guard lock(mutex_);
  return tickets_.take(request.path, now);
}

/// @return the answer to the request; nothing when it opens the web socket
std::string WebServer::answer(const HttpRequest& request) const {
  const bool is_socket = request.path == "/ws";
  if (request.path == "/favicon.ico") return http_answer(204, {}, {});
  if (request.path.starts_with(download_path))
    return plain(404, "this download is over: ask for the file again in the page");
  if (!is_socket && request.path != "/") return plain(404, "there is only one page: /");
  if (!guard_.has_token(request)) return is_socket ? plain(403, "wrong token") : no_token_answer();
  if (!is_socket) {
    std::string sockets = "ws://" + std::string(request.header("host"));
    if (!guard_.place().origin.empty()) sockets += " " + guard_.place().socket_origin();
    return page_answer(sockets);
  }
  if (!request.header_has_word("upgrade", "websocket") ||
      !request.header_has_word("connection", "upgrade") ||
      request.header("sec-websocket-version") != "13")
    return plain(426, "this is a web socket",
                 {{"Upgrade", "websocket"}, {"Sec-WebSocket-Version", "13"}});
  return is_web_socket_key(request.header("sec-websocket-key"))
             ? std::string()
             : plain(400, "Sec-WebSocket-Key must be 16 bytes in base64");
}

void WebServer::open_viewer(Connection& connection, std::size_t head_size, std::string_view key,
                            double now) {
  if (Connection* const before = viewer()) {
    before->queue(web_socket_frame(Opcode::text, replaced_), now);
    before->finish(web_socket_frame(Opcode::close, close_payload(close_code::taken, "replaced")),
                   now);
    listener_.on_gone(before->id());
  }
  const std::string accept = web_socket_accept(key);
  connection.open(head_size, now);
  connection.queue(web_socket_answer(accept), now);
  {
    const std::lock_guard lock(mutex_);
    viewer_ = connection.id();
    posted_.clear();
    unsent_ = 0;
  }
  listener_.on_viewer(connection.id());
  // Who reads the answer can count on being the viewer.
  connection.transmit(now);
}

Connection* WebServer::viewer() {
  const std::uint64_t id = [&] {
    const std::lock_guard lock(mutex_);
    return viewer_;
  }();
  for (const auto& connection : connections_)
    if (connection->id() == id && connection->stage() == Connection::Stage::open)
      return connection.get();
  return nullptr;
}

void WebServer::note_unsent() {
  const Connection* const to = viewer();
  bool is_empty_now = false;
  {
    const std::lock_guard lock(mutex_);
    const int before = unsent_;
    unsent_ = int(posted_.size() + (to ? to->queued() : 0));
    is_empty_now = before > 0 && unsent_ == 0;
  }
  if (is_empty_now) listener_.on_all_sent();
}

void WebServer::forget_dead() {
  std::uint64_t gone = 0;
  if (!viewer()) {
    const std::lock_guard lock(mutex_);
    std::swap(gone, viewer_);
    posted_.clear();
  }
  if (gone) listener_.on_gone(gone);
  std::erase_if(connections_, [](const auto& connection) {
    return connection->stage() == Connection::Stage::dead;
  });
}

void WebServer::say_goodbye() {
  double now = clock_seconds();
  const double end = now + goodbye_seconds;
  Connection* const to = viewer();
  if (!to) return connections_.clear();
  to->queue(web_socket_frame(Opcode::text, goodbye_), now);
  to->finish(web_socket_frame(Opcode::close, close_payload(close_code::going_away, "ended")), now);
  // The connection has to close too: ended earlier, with bytes unread, it could lose the goodbye.
  while (to->stage() != Connection::Stage::dead && now < end) {
    pollfd file{to->socket(), short(to->wants_output() ? POLLIN | POLLOUT : POLLIN), 0};
    ::poll(&file, 1, int((end - now) * 1000) + 1);
    now = clock_seconds();
    if (file.revents & POLLOUT) to->transmit(now);
    if (file.revents & ~POLLOUT) to->receive(now);
  }
  connections_.clear();
}

}  // namespace neve::app::view::web
