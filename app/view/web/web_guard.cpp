#include "app/view/web/web_guard.h"

#include <arpa/inet.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "app/support/errors.h"

namespace neve::app::view::web {
namespace {

bool is_ipv4(const std::string& text) {
  in_addr address;
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

bool is_ipv6(const std::string& text) {
  in6_addr address;
  return ::inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "name:80" or "[::1]:80" without the port and the brackets, in lower case; "" for anything else.
std::string name_of_host(std::string_view host) {
  std::string name;
  std::string_view rest;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    name = host.substr(1, end - 1);
    if (!is_ipv6(name)) return {};
    rest = host.substr(end + 1);
  } else {
    const std::size_t colon = std::min(host.find(':'), host.size());
    name = host.substr(0, colon);
    rest = host.substr(colon);
  }
  if (!rest.empty() && (rest[0] != ':' || !is_port(rest.substr(1)))) return {};
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = char(c + 32);
  return name;
}

std::string name_of_machine() {
  std::array<char, 256> name{};
  const bool is_known = ::gethostname(name.data(), name.size() - 1) == 0;
  const std::string plain = is_known ? name_of_host(name.data()) : std::string();
  return plain.empty() ? "localhost" : plain;
}

}  // namespace

std::string make_token() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
    throw IoError(std::string("no random numbers for the token: ") + std::strerror(errno), {});
  std::string token;
  for (const unsigned char byte : bytes)
    for (const int digit : {byte >> 4, byte & 15}) token += "0123456789abcdef"[digit];
  return token;
}

bool is_same_secret(std::string_view secret, std::string_view given) {
  unsigned char difference = secret.size() == given.size() ? 0 : 1;
  for (std::size_t k = 0; k < secret.size(); ++k)
    difference |= static_cast<unsigned char>(secret[k] ^ (k < given.size() ? given[k] : 0));
  return difference == 0;
}

bool is_loopback(const std::string& address) {
  return address == "localhost" || address == "::1" ||
         (is_ipv4(address) && address.starts_with("127."));
}

std::string risk_of(const std::string& address) {
  if (is_loopback(address)) return {};
  const bool is_all = address == "0.0.0.0" || address == "::";
  return "listening at " + address + (is_all ? " (every network of this machine)" : "") +
         ": anyone who can reach it and knows the token sees and controls this program, and can "
         "save pictures and scenes into its output folder. Nothing is encrypted: the token and the "
         "pictures can be read on the way. It is safer to listen at 127.0.0.1 and use ssh -L.";
}

std::string PublicPlace::socket_origin() const {
  return (origin.starts_with("https:") ? "wss://" : "ws://") + host;
}

PublicPlace public_place(const std::string& url) {
  const auto refuse = [&](const char* why) {
    throw UsageError("--public-url", "cannot use \"" + url + "\": " + why,
                     "expected the address of the page at the proxy, as in "
                     "https://hub/user/x/proxy/8080/");
  };
  const std::size_t colon = url.find("://");
  const std::string scheme = url.substr(0, std::min(colon, url.size()));
  if (colon == std::string::npos || (scheme != "http" && scheme != "https"))
    refuse("it begins with neither http:// nor https://");
  const std::size_t start = colon + 3, slash = std::min(url.find('/', start), url.size());
  PublicPlace place;
  place.host = url.substr(start, slash - start);
  for (char& c : place.host)
    if (c >= 'A' && c <= 'Z') c = char(c + 32);
  const bool is_plain = place.host.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-.:[]") ==
                        std::string::npos;
  if (!is_plain || name_of_host(place.host).empty()) refuse("it does not name a host");
  // Browsers omit the usual port.
  const std::string usual = scheme == "https" ? ":443" : ":80";
  if (place.host.ends_with(usual)) place.host.resize(place.host.size() - usual.size());
  place.origin = scheme + "://" + place.host;
  place.path = slash < url.size() ? url.substr(slash) : "/";
  if (place.path.find_first_of("?#\"' <>") != std::string::npos)
    refuse("a path has no ?, # or quotes");
  if (!place.path.ends_with('/')) place.path += '/';
  return place;
}

WebGuard::WebGuard(std::string address, std::string token, PublicPlace place)
    : address_(std::move(address)),
      token_(std::move(token)),
      machine_(name_of_machine()),
      place_(std::move(place)),
      is_local_(is_loopback(address_)) {}

bool WebGuard::is_own_host(std::string_view host) const {
  const std::string name = name_of_host(host);
  if (name.empty()) return false;
  // A proxy passes on the name that the browser knows, or puts the number of this machine there.
  if (is_loopback(name) || (!place_.host.empty() && host == place_.host)) return true;
  // Nobody can point a number somewhere else, so numbers are safe from rebinding.
  return !is_local_ && (name == machine_ || is_ipv4(name) || is_ipv6(name));
}

bool WebGuard::is_own_origin(const HttpRequest& request) const {
  const std::string_view origin = request.header("origin"), host = request.header("host");
  if (!place_.origin.empty() && origin == place_.origin) return true;
  // At the proxy, a page that came without its encryption is another one.
  return host != place_.host && origin == "http://" + std::string(host);
}

std::string WebGuard::own_path(const std::string& path) const {
  const bool is_whole = place_.path.size() > 1 && path.starts_with(place_.path);
  return is_whole ? path.substr(place_.path.size() - 1) : path;
}

}  // namespace neve::app::view::web
