#pragma once
/// Serves one page and one web socket to one viewer. A thread of its own does all reading and
/// writing; nothing that comes over the network can make anybody else wait.
///
/// Why not a library: libcivetweb 1.15 takes memory for any length that a frame announces, up to
/// 2 GiB, waits for ever for the rest of a frame, and accepts frames that are not masked without
/// telling. Here every byte and every second is bounded, and a page that sends too much waits.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/view/web/web_connection.h"
#include "app/view/web/web_guard.h"

namespace neve::app::view::web {

struct WebServerOptions {
  std::string address = "127.0.0.1";  ///< a number, or localhost
  int port = 0;                       ///< 0: a free one
  std::string goodbye;                ///< said to the viewer when the server ends
  std::string replaced;               ///< said to the viewer whose place another one takes
  WebLimits limits{};
};

/// Called on the server's thread; must not wait.
class WebListener {
 public:
  virtual ~WebListener() = default;
  virtual void on_viewer(std::uint64_t viewer) = 0;
  virtual void on_gone(std::uint64_t viewer) = 0;
  /// @return false: there is no room; the same message comes again after WebServer::resume(), and
  /// nothing else of the viewer is read until then
  virtual bool on_message(std::uint64_t viewer, std::string_view text) = 0;
  /// The network has taken everything that was queued.
  virtual void on_all_sent() = 0;
};

class WebServer {
 public:
  /// Listens and starts the thread. The newest viewer takes the place of the one before.
  /// @throws IoError when the address cannot be listened at
  WebServer(const WebServerOptions& options, const WebGuard& guard, WebListener& listener);
  /// Says goodbye and ends the thread, within half a second.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;

  /// Queues a message for the viewer, from any thread; it is dropped if the viewer has gone.
  void send(std::uint64_t viewer, Opcode opcode, std::string_view payload);
  /// @return messages for the viewer that the network has not taken
  int unsent(std::uint64_t viewer) const;
  /// Returns the path at which a page gets the file, once. Any thread may call it.
  std::string offer(std::unique_ptr<OpenFile> file);
  /// Tells, from any thread, that a message has room that on_message() refused.
  void resume();

 private:
  using Connections = std::vector<std::unique_ptr<Connection>>;

  void run();
  void wait(double now);
  void take_posted(double now);
  void accept_all(double now);
  void make_room();
  void serve(Connection& connection, double now);
  void answer_head(Connection& connection, double now);
  std::string refusal_of(const HttpRequest& request) const;
  std::string answer(const HttpRequest& request) const;
  std::unique_ptr<OpenFile> file_for(const HttpRequest& request, double now);
  void open_viewer(Connection& connection, std::size_t head_size, std::string_view key, double now);
  void forget_dead();
  void say_goodbye();
  Connection* viewer();
  void note_unsent();
  void poke();

  const WebLimits limits_;
  const std::string goodbye_, replaced_;
  const WebGuard& guard_;
  WebListener& listener_;
  const int socket_, bell_;  ///< the bell wakes the thread

  // The thread's own.
  Connections connections_;
  std::uint64_t next_id_ = 1;
  double accept_again_ = 0;  ///< the system had no more files for us

  mutable std::mutex mutex_;         ///< of the members below
  std::vector<std::string> posted_;  ///< frames for the viewer
  std::uint64_t viewer_ = 0;         ///< 0: no page is connected
  int unsent_ = 0;                   ///< of its frames, those posted included
  bool is_resumed_ = false;
  Tickets tickets_;
  std::atomic<bool> is_ending_ = false;

  std::thread thread_;
};

}  // namespace neve::app::view::web
