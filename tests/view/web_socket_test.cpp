/// Frames, heads and names as bytes: nothing here opens a connection.

#include "app/view/web/web_socket.h"

#include <gtest/gtest.h>

#include <random>

#include "app/support/errors.h"
#include "app/view/web/http.h"
#include "app/view/web/web_guard.h"
#include "tests/support/web_client.h"

namespace neve::app {
namespace {

using test::client_frame;

/// Close code for these bytes, 0 when nothing is wrong with them.
int error_of(const std::string& bytes, std::size_t limit = 1000) {
  app::view::web::FrameReader reader(limit);
  reader.feed(bytes);
  while (reader.next()) {
  }
  return reader.error();
}

TEST(WebSocketKey, WebSocketKeyIsAnsweredAsInTheStandard) {
  // RFC 6455, section 1.3.
  EXPECT_EQ(app::view::web::web_socket_accept("dGhlIHNhbXBsZSBub25jZQ=="),
            "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_TRUE(app::view::web::is_web_socket_key("dGhlIHNhbXBsZSBub25jZQ=="));
  EXPECT_FALSE(app::view::web::is_web_socket_key("dGhlIHNhbXBsZSBub25jZQ="));
  EXPECT_FALSE(app::view::web::is_web_socket_key("dGhlIHNhbXBsZSBub25j=Q=="));
  EXPECT_FALSE(app::view::web::is_web_socket_key(""));
}

TEST(Utf8, Utf8IsWhatTheStandardAllows) {
  for (const char* good : {"", "snow", "n\xC3\xA9v\xC3\xA9", "\xE2\x9D\x84", "\xF0\x9F\x8C\xA8",
                           "\xED\x9F\xBF", "\xEE\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_TRUE(app::view::web::is_utf8(good)) << good;
  for (const char* bad :
       {"\x80", "\xC3", "\xC0\xAF", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
        "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE2\x9D", "\xE2\x28\xA1", "\xFF"})
    EXPECT_FALSE(app::view::web::is_utf8(bad)) << bad;
}

TEST(FrameReader, FrameReaderFindsMessagesInPiecesOfAnySize) {
  const std::string bytes = client_frame(0x81, "first") + client_frame(0x01, "sec") +
                            client_frame(0x89, "ping") + client_frame(0x00, "") +
                            client_frame(0x80, "ond") + client_frame(0x82, std::string(300, 'x'));
  for (std::size_t piece = 1; piece <= bytes.size(); piece += 3) {
    app::view::web::FrameReader reader(1000);
    std::string found;
    for (std::size_t k = 0; k < bytes.size(); k += piece) {
      reader.feed(bytes.substr(k, piece));
      while (const auto message = reader.next())
        found += std::to_string(int(message->opcode)) + message->payload.substr(0, 8) + ' ';
    }
    EXPECT_EQ(found, "1first 9ping 1second 2xxxxxxxx ") << piece;
    EXPECT_EQ(reader.error(), 0);
    EXPECT_FALSE(reader.is_midway());
  }
}

TEST(FrameReader, FrameReaderReadsLengthsInAllThreeForms) {
  for (const std::size_t length : {0u, 1u, 125u, 126u, 127u, 65535u, 65536u, 100000u}) {
    app::view::web::FrameReader reader(100000);
    reader.feed(client_frame(0x82, std::string(length, 'a')));
    const auto message = reader.next();
    ASSERT_TRUE(message) << length;
    EXPECT_EQ(message->payload, std::string(length, 'a'));
  }
}

TEST(FrameReader, FrameReaderRefusesFramesThatTheStandardForbids) {
  EXPECT_EQ(error_of(client_frame(0x81, "unmasked", false)), 1002);
  EXPECT_EQ(error_of(client_frame(0xC1, "reserved bit")), 1002);
  EXPECT_EQ(error_of(client_frame(0x83, "unknown opcode")), 1002);
  EXPECT_EQ(error_of(client_frame(0x8B, "unknown control")), 1002);
  EXPECT_EQ(error_of(client_frame(0x80, "continues nothing")), 1002);
  EXPECT_EQ(error_of(client_frame(0x01, "half") + client_frame(0x81, "another")), 1002);
  EXPECT_EQ(error_of(client_frame(0x09, "ping in pieces")), 1002);
  EXPECT_EQ(error_of(client_frame(0x89, std::string(126, 'x'))), 1002);
  EXPECT_EQ(error_of(client_frame(0x81, "caf\xE9")), 1007);
  EXPECT_EQ(error_of(client_frame(0x01, "\xE2\x9D") + client_frame(0x80, "\x28")), 1007);
  // 5 and 200 in more bytes than they need, and a length with the highest bit.
  EXPECT_EQ(error_of(std::string("\x81\xFE\x00\x05mask12345", 13)), 1002);
  EXPECT_EQ(error_of(std::string("\x81\xFF\0\0\0\0\0\0\0\xC8mask", 14)), 1002);
  EXPECT_EQ(error_of(std::string("\x81\xFF\x80\0\0\0\0\0\0\x01mask", 14)), 1002);
}

TEST(FrameReader, FrameReaderRefusesTooLongMessagesBeforeTheyCome) {
  EXPECT_EQ(error_of(client_frame(0x81, std::string(1000, 'a'))), 0);
  EXPECT_EQ(error_of(client_frame(0x81, std::string(1001, 'a')).substr(0, 4)), 1009);
  EXPECT_EQ(error_of(client_frame(0x01, std::string(600, 'a')) +
                     client_frame(0x80, std::string(401, 'a')).substr(0, 4)),
            1009);
  EXPECT_EQ(error_of(std::string("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 10)), 1009);
}

TEST(FrameReader, FrameReaderSurvivesRandomBytes) {
  std::mt19937 random(7);
  for (int run = 0; run < 20000; ++run) {
    std::string bytes(random() % 40, '\0');
    for (char& c : bytes) c = char(random());
    // Half of them begin like something sensible.
    if (!bytes.empty() && run % 2) bytes[0] = char(0x80 | (random() % 3));
    if (bytes.size() > 1 && run % 2) bytes[1] = char(bytes[1] | 0x80);
    app::view::web::FrameReader reader(64);
    reader.feed(bytes);
    int messages = 0;
    while (reader.next()) ++messages;
    EXPECT_LE(messages, 7);
  }
}

TEST(ServerFrame, ServerFrameIsReadBackByAClient) {
  EXPECT_EQ(app::view::web::web_socket_frame(app::view::web::Opcode::text, "hello"),
            "\x81\x05hello");
  EXPECT_EQ(app::view::web::web_socket_frame(app::view::web::Opcode::binary, std::string(126, 'x'))
                .substr(0, 4),
            std::string("\x82\x7E\x00\x7E", 4));
  EXPECT_EQ(
      app::view::web::web_socket_frame(app::view::web::Opcode::binary, std::string(65536, 'x'))
          .substr(0, 10),
      std::string("\x82\x7F\0\0\0\0\0\x01\0\0", 10));
  EXPECT_EQ(app::view::web::close_payload(1002, "why"), "\x03\xEAwhy");
}

int status_of(const std::string& head) {
  return app::view::web::read_http_head(head).status;
}

TEST(HttpHead, HttpHeadIsReadStrictly) {
  const app::view::web::HttpHead head = app::view::web::read_http_head(
      "GET /ws?a=1&token=abc HTTP/1.1\r\nHost: localhost:80\r\nConnection: keep-alive, "
      "Upgrade\r\n\r\nmore");
  ASSERT_EQ(head.status, 200);
  EXPECT_EQ(head.request.path, "/ws");
  EXPECT_EQ(head.request.query_value("token"), "abc");
  EXPECT_EQ(head.request.query_value("tok"), "");
  EXPECT_EQ(head.request.header("host"), "localhost:80");
  EXPECT_TRUE(head.request.header_has_word("connection", "upgrade"));
  EXPECT_FALSE(head.request.header_has_word("connection", "alive"));

  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: a\r\n"), 0);
  EXPECT_EQ(status_of(""), 0);
  for (const char* bad :
       {"GET /\r\n\r\n", "GET  / HTTP/1.1\r\nHost: a\r\n\r\n", "GET / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nOrigin: b\r\nOrigin: b\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\n folded\r\n\r\n", "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\nOrigin: b\r\n\r\n", "GET http://a/ HTTP/1.1\r\nHost: a\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\n", "\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n",
        "G(T / HTTP/1.1\r\nHost: a\r\n\r\n", "\x16\x03\x01\r\n\r\n"})
    EXPECT_EQ(status_of(bad), 400) << bad;
  EXPECT_EQ(status_of(std::string("GET /\0 HTTP/1.1\r\nHost: a\r\n\r\n", 28)), 400);
  EXPECT_EQ(status_of("GET / HTTP/2.0\r\nHost: a\r\n\r\n"), 505);
}

TEST(HttpHead, HttpHeadIsLimitedWhileItComes) {
  const std::string long_target(2000, 'a');
  EXPECT_EQ(status_of("GET /" + long_target + " HTTP/1.1\r\nHost: a\r\n\r\n"), 414);
  EXPECT_EQ(status_of("GET /" + long_target), 414);
  EXPECT_EQ(status_of(long_target), 414);
  const std::string start = "GET / HTTP/1.1\r\nHost: a\r\n";
  EXPECT_EQ(status_of(start + "X: " + std::string(app::view::web::max_http_head, 'a')), 431);
  EXPECT_EQ(status_of(start + "X: " + std::string(app::view::web::max_http_head, 'a') + "\r\n\r\n"),
            431);
  EXPECT_EQ(status_of(start + "X: " + std::string(4000, 'a') + "\r\n\r\n"), 200);
}

TEST(WebGuard, WebGuardKnowsItsOwnNames) {
  const app::view::web::WebGuard local("127.0.0.1", "secret");
  for (const char* own : {"127.0.0.1:8080", "localhost", "LocalHost:1", "[::1]:9", "127.0.0.2:3"})
    EXPECT_TRUE(local.is_own_host(own)) << own;
  for (const char* foreign :
       {"", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example", "10.0.0.5:80",
        "localhost:", "localhost:80:80", "localhost:http", "localhost:123456", "[::1", "[evil]:80",
        "localhost.", "127.0.0.1@evil.example", "127.1", "2130706433", "0.0.0.0"})
    EXPECT_FALSE(local.is_own_host(foreign)) << foreign;

  const app::view::web::WebGuard open("0.0.0.0", "secret");
  EXPECT_TRUE(open.is_own_host("10.0.0.5:80"));
  EXPECT_TRUE(open.is_own_host("[2001:db8::1]:80"));
  EXPECT_TRUE(open.is_own_host(open.machine()));
  EXPECT_FALSE(open.is_own_host("evil.example"));
}

/// A hub with TLS shows the page below a path; its proxy keeps the name of the host, or puts the
/// number of this machine there.
TEST(WebGuard, WebGuardKnowsThePlaceOfItsProxy) {
  using app::view::web::HttpRequest;
  const app::view::web::PublicPlace place =
      app::view::web::public_place("https://Hub.example:443/user/x/proxy/8080");
  EXPECT_EQ(place.origin, "https://hub.example");
  EXPECT_EQ(place.path, "/user/x/proxy/8080/");
  EXPECT_EQ(place.socket_origin(), "wss://hub.example");
  const app::view::web::WebGuard guard("127.0.0.1", "secret", place);
  const auto is_own = [&](const char* host, const char* origin) {
    const HttpRequest request{"GET", "/ws", "", {{"host", host}, {"origin", origin}}};
    return guard.is_own_host(host) && guard.is_own_origin(request);
  };
  EXPECT_TRUE(is_own("hub.example", "https://hub.example"));
  EXPECT_TRUE(is_own("127.0.0.1:8080", "https://hub.example"));
  EXPECT_TRUE(is_own("127.0.0.1:8080", "http://127.0.0.1:8080")) << "without the proxy";
  for (const auto& [host, origin] : {std::pair{"hub.example", "http://hub.example"},
                                     {"hub.example", "https://evil.example"},
                                     {"evil.example", "https://evil.example"},
                                     {"evil.example", "https://hub.example"},
                                     {"hub.example.evil", "https://hub.example"},
                                     {"127.0.0.1:8080", "https://hub.example.evil"},
                                     {"127.0.0.1:8080", "https://hub.example:8443"},
                                     {"127.0.0.1:8080", "null"},
                                     {"hub.example", ""}})
    EXPECT_FALSE(is_own(host, origin)) << host << " " << origin;
  EXPECT_EQ(guard.own_path("/user/x/proxy/8080/ws"), "/ws");
  EXPECT_EQ(guard.own_path("/ws"), "/ws") << "a proxy that has removed its path";
  EXPECT_EQ(guard.own_path("/user/y/proxy/8080/ws"), "/user/y/proxy/8080/ws");
}

TEST(WebGuard, PublicPlacesAreAddressesOfPages) {
  EXPECT_EQ(app::view::web::public_place("http://gate:8000").path, "/");
  EXPECT_EQ(app::view::web::public_place("http://gate:8000").origin, "http://gate:8000");
  for (const char* wrong :
       {"", "hub/user", "ftp://hub/", "https://", "https:///x", "https://hub:x/", "https://a b/",
        "https://hub/x?token=1", "https://hub/x#y", "https://hub/'", "https://user@hub/"})
    EXPECT_THROW(app::view::web::public_place(wrong), app::UsageError) << wrong;
}

TEST(WebGuard, WebGuardTellsTheRiskOfOtherAddresses) {
  for (const char* safe : {"127.0.0.1", "127.3.2.1", "::1", "localhost"})
    EXPECT_EQ(app::view::web::risk_of(safe), "") << safe;
  for (const char* open : {"0.0.0.0", "::", "10.0.0.5", "127.0.0.1.example", "example.com"})
    EXPECT_NE(app::view::web::risk_of(open), "") << open;
}

TEST(Token, TokenHasManyRandomBits) {
  const std::string a = app::view::web::make_token(), b = app::view::web::make_token();
  EXPECT_EQ(a.size(), 32u);
  EXPECT_EQ(a.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(a, b);
  EXPECT_TRUE(app::view::web::is_same_secret(a, a));
  EXPECT_FALSE(app::view::web::is_same_secret(a, b));
  EXPECT_FALSE(app::view::web::is_same_secret(a, a.substr(0, 31)));
  EXPECT_FALSE(app::view::web::is_same_secret(a, a + "0"));
  EXPECT_FALSE(app::view::web::is_same_secret(a, ""));
}

}  // namespace
}  // namespace neve::app
