#pragma once
/// Sockets that listen.

#include <string>

namespace neve::app::view::web {

/// @param address a number, or localhost
/// @param port 0: a free one
/// @return a socket that does not block
/// @throws IoError
int listen_at(const std::string& address, int port);

int port_of(int socket);

/// @return the next connection, which does not block and sends small pieces at once; -1: none now,
/// errno tells why
int accept_at(int socket);

}  // namespace neve::app::view::web
