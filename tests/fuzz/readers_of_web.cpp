#include <cmath>

#include "app/view/web/http.h"
#include "app/view/web/web_protocol.h"
#include "app/view/web/web_socket.h"
#include "tests/fuzz/readers.h"

namespace neve::test::fuzz {

using namespace neve::app::view;

void read_http(std::span<const std::uint8_t> bytes) {
  const web::HttpHead head = web::read_http_head(text_of(bytes));
  require(head.size <= bytes.size());
  if (head.status != 200) return;
  head.request.header("host");
  head.request.header_has_word("upgrade", "websocket");
  head.request.query_value("token");
  web::is_web_socket_key(head.request.header("sec-websocket-key"));
}

/// The bytes come in pieces, as from a network: the first byte says how large.
void read_web_socket(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  constexpr std::size_t max_message = 4096;
  const std::size_t piece = 1 + bytes[0];
  web::FrameReader reader(max_message);
  for (std::size_t at = 1; at < bytes.size(); at += piece) {
    reader.feed(text_of(bytes.subspan(at, std::min(piece, bytes.size() - at))));
    while (const auto message = reader.next()) {
      require(message->payload.size() <= max_message);
      if (message->opcode == web::Opcode::text) require(web::is_utf8(message->payload));
    }
  }
}

void read_page_message(std::span<const std::uint8_t> bytes) {
  const web::PageMessage message = web::read_page_message(text_of(bytes));
  require(std::isfinite(message.event.x) && std::isfinite(message.event.y));
  if (message.kind == web::PageMessage::Kind::size)
    require(double(message.size.width) * message.size.height <= web::max_web_pixels);
}

}  // namespace neve::test::fuzz
