#pragma once
/// Access control: only a page of ours with the token may connect. Any page in a browser can send
/// requests to this machine, so a local address alone is not enough.

#include <string>
#include <string_view>

#include "app/view/web/http.h"

namespace neve::app::view::web {

/// 128 random bits of the operating system as 32 hex digits. @throws IoError
std::string make_token();

/// Takes the same time wherever the two differ.
bool is_same_secret(std::string_view secret, std::string_view given);

/// True if only this machine reaches it: 127.x.x.x, ::1 or localhost.
bool is_loopback(const std::string& address);

/// Warning to print before listening at the address; "" for loopback.
std::string risk_of(const std::string& address);

/// The address at which a proxy shows the page: https://hub/user/x/proxy/8080/.
struct PublicPlace {
  std::string origin;  ///< "https://hub", as browsers write it; empty: there is no proxy
  std::string host;    ///< "hub", with a port where it is not the usual one
  std::string path;    ///< "/user/x/proxy/8080/"

  /// Returns the origin at which a page may open its web socket: "wss://hub".
  std::string socket_origin() const;
};
/// @throws UsageError for anything but http:// or https://, a host, and a path
PublicPlace public_place(const std::string& url);

class WebGuard {
 public:
  /// @param address where the server listens
  WebGuard(std::string address, std::string token, PublicPlace place = {});

  /// True if a Host line names this server. A foreign name means that a foreign name server points
  /// here (DNS rebinding). The port may be any: a tunnel has its own.
  bool is_own_host(std::string_view host) const;

  /// @return whether the page that asks came from this server
  bool is_own_origin(const HttpRequest& request) const;

  bool has_token(const HttpRequest& request) const {
    return is_same_secret(token_, request.query_value("token"));
  }

  /// The path of a request without that of the proxy, whether or not the proxy has removed it.
  std::string own_path(const std::string& path) const;

  const PublicPlace& place() const { return place_; }
  const std::string& token() const { return token_; }
  /// Name of this machine, or localhost.
  const std::string& machine() const { return machine_; }

 private:
  std::string address_, token_, machine_;
  PublicPlace place_;
  bool is_local_ = true;
};

}  // namespace neve::app::view::web
