#pragma once
/// A forwarded port like that of ssh -L, whose connections can be cut.

#include <atomic>
#include <thread>
#include <vector>

#include "app/view/web/web_listen.h"
#include "tests/support/web_client.h"

namespace neve::test {

class Relay {
 public:
  explicit Relay(int to) : to_(to), socket_(app::view::web::listen_at("127.0.0.1", 0)) {
    thread_ = std::thread([this] { run(); });
  }
  ~Relay() {
    is_over_ = true;
    thread_.join();
    ::close(socket_);
  }
  int port() const { return app::view::web::port_of(socket_); }

  /// Ends all connections and refuses new ones, until they are let through again.
  void cut(bool is_cut) { is_cut_ = is_cut; }

 private:
  struct Pair {
    int near;
    int far;
  };

  void run() {
    std::vector<Pair> pairs;
    while (!is_over_) {
      std::vector<pollfd> files{{socket_, POLLIN, 0}};
      for (const Pair& pair : pairs) {
        files.push_back({pair.near, POLLIN, 0});
        files.push_back({pair.far, POLLIN, 0});
      }
      ::poll(files.data(), files.size(), 20);
      std::vector<Pair> left;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const bool is_open = (!files[2 * k + 1].revents || copy(pairs[k].near, pairs[k].far)) &&
                             (!files[2 * k + 2].revents || copy(pairs[k].far, pairs[k].near));
        if (is_open && !is_cut_)
          left.push_back(pairs[k]);
        else
          end(pairs[k]);
      }
      pairs = left;
      if (files[0].revents) accept(pairs);
    }
    for (const Pair& pair : pairs) end(pair);
  }

  void accept(std::vector<Pair>& pairs) {
    const int near = ::accept(socket_, nullptr, nullptr);
    if (near < 0) return;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(to_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int far = ::socket(AF_INET, SOCK_STREAM, 0);
    if (is_cut_ || ::connect(far, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      end({near, far});
    else
      pairs.push_back({near, far});
  }

  static bool copy(int from, int to) {
    char bytes[65536];
    const ssize_t count = ::recv(from, bytes, sizeof bytes, 0);
    return count > 0 && ::send(to, bytes, count, MSG_NOSIGNAL) == count;
  }

  static void end(const Pair& pair) {
    ::close(pair.near);
    ::close(pair.far);
  }

  int to_, socket_;
  std::atomic<bool> is_over_ = false, is_cut_ = false;
  std::thread thread_;
};

}  // namespace neve::test
