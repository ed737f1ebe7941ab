#pragma once
/// The little of HTTP that one page needs: heads of requests are read strictly, answers are made.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace neve::app::view::web {

/// The first line and the headers of a request. Names are in lower case.
struct HttpRequest {
  std::string method, path, query;
  std::vector<std::pair<std::string, std::string>> headers;

  /// @return "" if it is absent; heads with two Host or Origin lines are not read at all
  std::string_view header(std::string_view name) const;
  bool has_header(std::string_view name) const;
  /// True if a list like "keep-alive, Upgrade" has the word, in any case.
  bool header_has_word(std::string_view name, std::string_view word) const;
  /// Value of a key in "a=1&token=2", without decoding; "" if absent.
  std::string_view query_value(std::string_view name) const;
};

struct HttpHead {
  int status = 0;        ///< 0 not complete yet, 200 read, otherwise the answer to give
  std::size_t size = 0;  ///< bytes of a head that was read
  HttpRequest request;
};

inline constexpr std::size_t max_http_target = 1024, max_http_head = 8192;

/// Reads the head at the start of the bytes that have come. Everything that two programs could read
/// in two ways is refused: bare line feeds, folded lines, bodies, Host or Origin twice.
HttpHead read_http_head(std::string_view bytes);

using HttpHeaders = std::vector<std::pair<std::string, std::string>>;

/// An answer after which the connection ends. Never stored anywhere, never shown inside another
/// page.
std::string http_answer(int status, std::string_view type, std::string_view body,
                        const HttpHeaders& more = {});

/// The head of a file that follows, to be saved and not shown.
/// @param name safe in a header
std::string http_file_head(std::string_view name, std::uint64_t size);

/// 101, after which both sides speak WebSocket.
std::string web_socket_answer(std::string_view accept);

}  // namespace neve::app::view::web
