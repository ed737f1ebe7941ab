#include "app/view/web/web_listen.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "app/support/errors.h"

namespace neve::app::view::web {
namespace {

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

Addresses find_address(const std::string& address, int port) {
  if (!address.empty() && address.find_first_not_of("0123456789") == std::string::npos)
    throw UsageError("--listen", address + " is a port, and no address",
                     "did you mean --listen 127.0.0.1:" + address + "?");
  addrinfo wish{};
  wish.ai_family = AF_UNSPEC;
  wish.ai_socktype = SOCK_STREAM;
  wish.ai_flags = AI_PASSIVE | AI_NUMERICHOST | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string number = address == "localhost" ? "127.0.0.1" : address;
  const int failure = ::getaddrinfo(number.c_str(), std::to_string(port).c_str(), &wish, &found);
  if (failure != 0 || port < 0 || port > 65535)
    throw IoError("cannot listen at \"" + address + "\" port " + std::to_string(port) +
                      "; expected the number of an address of this machine, like 127.0.0.1 or ::1, "
                      "and a port from 0 (a free one) to 65535",
                  address);
  return {found, ::freeaddrinfo};
}

}  // namespace

int listen_at(const std::string& address, int port) {
  const Addresses found = find_address(address, port);
  const int socket =
      ::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP);
  const int yes = 1;
  if (socket >= 0) ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (socket >= 0 && ::bind(socket, found->ai_addr, found->ai_addrlen) == 0 &&
      ::listen(socket, 64) == 0)
    return socket;
  const int reason = errno;
  if (socket >= 0) ::close(socket);
  throw IoError("cannot listen at " + address + " port " + std::to_string(port) + ": " +
                    std::strerror(reason),
                address, reason == EADDRINUSE ? "choose another port, or 0 for a free one" : "");
}

int port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  // The port is in the same place for both families.
  static_assert(offsetof(sockaddr_in, sin_port) == offsetof(sockaddr_in6, sin6_port));
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

int accept_at(int socket) {
  const int connection = ::accept4(socket, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  const int yes = 1;
  if (connection >= 0) ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return connection;
}

}  // namespace neve::app::view::web
