#include "app/view/web/http.h"

#include <algorithm>
#include <cctype>

#include "app/support/text.h"

namespace neve::app::view::web {
namespace {

/// Characters of names and methods (RFC 9110, 5.6.2).
bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("!#$%&'*+-.^_`|~").find(char(c)) != std::string::npos;
  });
}

bool is_printable(std::string_view text, bool has_blanks) {
  return std::all_of(text.begin(), text.end(), [&](unsigned char c) {
    return (c > 32 && c != 127) || (has_blanks && (c == ' ' || c == '\t'));
  });
}

/// @return 200 or the answer to give
int read_request_line(std::string_view line, HttpRequest& request) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string::npos || first == last) return 400;
  const std::string_view method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(method) || !is_printable(target, false)) return 400;
  if (target.size() > max_http_target) return 414;
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    return version.starts_with("HTTP/") ? 505 : 400;
  if (!target.starts_with('/')) return 400;
  request.method = method;
  const std::size_t question = target.find('?');
  request.path = target.substr(0, question);
  if (question != std::string::npos) request.query = target.substr(question + 1);
  return 200;
}

int read_header_line(std::string_view line, HttpRequest& request) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos || !is_token(line.substr(0, colon))) return 400;
  const std::string value = trimmed(line.substr(colon + 1));
  if (!is_printable(value, true)) return 400;
  std::string name = lower_text(line.substr(0, colon));
  if ((name == "host" || name == "origin") && request.has_header(name)) return 400;
  // A body would have to be read and to be limited; nothing here takes one.
  if (name == "transfer-encoding" || (name == "content-length" && value != "0")) return 400;
  request.headers.emplace_back(std::move(name), value);
  return 200;
}

/// The answer while the end of the head has not come.
int judge_unfinished(std::string_view bytes) {
  const std::size_t line = bytes.find("\r\n");
  // A method, a version and blanks take less than 32 characters.
  if (std::min(line, bytes.size()) > max_http_target + 32) return 414;
  return bytes.size() > max_http_head ? 431 : 0;
}

std::string_view reason_of(int status) {
  constexpr std::pair<int, std::string_view> reasons[] = {{101, "Switching Protocols"},
                                                          {200, "OK"},
                                                          {204, "No Content"},
                                                          {400, "Bad Request"},
                                                          {403, "Forbidden"},
                                                          {404, "Not Found"},
                                                          {405, "Method Not Allowed"},
                                                          {408, "Request Timeout"},
                                                          {414, "URI Too Long"},
                                                          {426, "Upgrade Required"},
                                                          {431, "Request Header Fields Too Large"},
                                                          {505, "HTTP Version Not Supported"}};
  for (const auto& [number, reason] : reasons)
    if (number == status) return reason;
  return "Error";
}

}  // namespace

std::string_view HttpRequest::header(std::string_view name) const {
  for (const auto& [key, value] : headers)
    if (key == name) return value;
  return {};
}

bool HttpRequest::has_header(std::string_view name) const {
  return std::any_of(headers.begin(), headers.end(),
                     [&](const auto& header) { return header.first == name; });
}

bool HttpRequest::header_has_word(std::string_view name, std::string_view word) const {
  for (const auto& [key, value] : headers) {
    if (key != name) continue;
    for (std::size_t begin = 0; begin <= value.size();) {
      const std::size_t end = std::min(value.find(',', begin), value.size());
      if (lower_text(trimmed(std::string_view(value).substr(begin, end - begin))) == word)
        return true;
      begin = end + 1;
    }
  }
  return false;
}

std::string_view HttpRequest::query_value(std::string_view name) const {
  for (std::size_t begin = 0; begin < query.size();) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view part = std::string_view(query).substr(begin, end - begin);
    if (part.starts_with(name) && part.substr(name.size()).starts_with('='))
      return part.substr(name.size() + 1);
    begin = end + 1;
  }
  return {};
}

HttpHead read_http_head(std::string_view bytes) {
  HttpHead head;
  const std::size_t end = bytes.find("\r\n\r\n");
  if (end == std::string::npos || end > max_http_head) {
    head.status = judge_unfinished(bytes);
    return head;
  }
  head.size = end + 4;
  const std::string_view lines = bytes.substr(0, end + 2);
  std::size_t begin = 0;
  while (begin < lines.size()) {
    const std::size_t stop = lines.find("\r\n", begin);
    const std::string_view line = lines.substr(begin, stop - begin);
    head.status =
        begin == 0 ? read_request_line(line, head.request) : read_header_line(line, head.request);
    if (head.status != 200) return head;
    begin = stop + 2;
  }
  if (!head.request.has_header("host")) head.status = 400;
  return head;
}

namespace {

/// Writes the head of an answer, up to the empty line.
std::string http_head(int status, std::string_view type, std::uint64_t size,
                      const HttpHeaders& more) {
  std::string answer = "HTTP/1.1 " + std::to_string(status) + ' ' + std::string(reason_of(status)) +
                       "\r\nConnection: close\r\nContent-Length: " + std::to_string(size) +
                       "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff"
                       "\r\nReferrer-Policy: no-referrer\r\nX-Frame-Options: DENY"
                       "\r\nCross-Origin-Opener-Policy: same-origin"
                       "\r\nCross-Origin-Resource-Policy: same-origin\r\n";
  if (!type.empty()) answer.append("Content-Type: ").append(type).append("\r\n");
  bool has_policy = false;
  for (const auto& [name, value] : more) {
    answer.append(name).append(": ").append(value).append("\r\n");
    has_policy = has_policy || name == "Content-Security-Policy";
  }
  if (!has_policy)
    answer += "Content-Security-Policy: default-src 'none'; frame-ancestors 'none'\r\n";
  return answer.append("\r\n");
}

}  // namespace

std::string http_answer(int status, std::string_view type, std::string_view body,
                        const HttpHeaders& more) {
  return http_head(status, type, body.size(), more).append(body);
}

std::string http_file_head(std::string_view name, std::uint64_t size) {
  return http_head(200, "application/octet-stream", size,
                   {{"Content-Disposition", "attachment; filename=\"" + std::string(name) + "\""}});
}

std::string web_socket_answer(std::string_view accept) {
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Accept: " +
         std::string(accept) + "\r\n\r\n";
}

}  // namespace neve::app::view::web
