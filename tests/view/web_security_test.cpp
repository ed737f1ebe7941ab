/// Requests without permission, and from hostile programs.

#include <atomic>
#include <filesystem>
#include <random>
#include <thread>

#include "app/support/errors.h"
#include "tests/view/web_support.h"

namespace neve::test {
namespace {

using app::view::frontend::InputEvent;

/// More than an honest server keeps for a viewer, less than one bad message would need if it were
/// kept: tests below send hundreds of megabytes.
constexpr double memory_slack = 12e6;

TEST_F(Web, AddressHasATokenThatIsAskedFor) {
  start();
  const std::string where = front->where();
  EXPECT_EQ(where, "http://" + host + "/?token=" + front->token());
  const std::string page = ask("GET " + target("/") + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 ")) << page.substr(0, 200);
  EXPECT_NE(page.find("<canvas"), std::string::npos);
  for (const std::string& path :
       {std::string("/"), std::string("/?token="), "/?token=" + std::string(32, '0'),
        "/?token=" + front->token().substr(1), "/?token=" + front->token() + "0",
        "/?Token=" + front->token()}) {
    EXPECT_EQ(status(path, "Host: " + host + "\r\n"), 403) << path;
    EXPECT_EQ(WebClient(front->port(), "/ws" + path.substr(1), own_headers()).answer().substr(9, 3),
              "403")
        << path;
  }
  expect_serving();
}

TEST_F(Web, AnswersNeverCarryTheToken) {
  start();
  for (const std::string& path : {target("/"), std::string("/"), target("/ws"), target("/x")}) {
    const std::string answer = ask("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    EXPECT_GT(answer.size(), 50u);
    EXPECT_EQ(answer.find(front->token()), std::string::npos) << path;
  }
}

TEST_F(Web, PageHasStrictHeaders) {
  start();
  const std::string page = ask("GET " + target("/") + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  for (const char* line :
       {"Cache-Control: no-store", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
        "Referrer-Policy: no-referrer", "default-src 'none'", "frame-ancestors 'none'",
        "base-uri 'none'", "Connection: close"})
    EXPECT_NE(page.find(line), std::string::npos) << line;
  // Nothing inside may run that did not come with this answer, and nothing comes from elsewhere.
  EXPECT_EQ(page.find("unsafe-inline"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_EQ(page.find("http://", page.find("\r\n\r\n")), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_NE(page.find("connect-src ws://" + host), std::string::npos);
}

TEST_F(Web, ServerRefusesForeignHosts) {
  start();
  for (const char* name :
       {"evil.example", "evil.example:80", "localhost.evil.example", "10.1.2.3"}) {
    const std::string line = std::string("Host: ") + name + "\r\n";
    EXPECT_EQ(status(target("/"), line), 403) << name;
    // DNS rebinding: the page of the foreign name is its own origin.
    EXPECT_EQ(WebClient(front->port(), target(), line + "Origin: http://" + name + "\r\n")
                  .answer()
                  .substr(9, 3),
              "403")
        << name;
  }
  EXPECT_EQ(status(target("/"), ""), 400);
  // The port is another one through ssh -L.
  EXPECT_EQ(status(target("/"), "Host: localhost:1234\r\n"), 200);
}

TEST_F(Web, ServerRefusesForeignPages) {
  start();
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), std::string("http://127.0.0.1"),
        "https://" + host, "http://localhost:" + std::to_string(front->port()), std::string("")}) {
    const std::string lines = "Host: " + host + "\r\nOrigin: " + origin + "\r\n";
    EXPECT_EQ(status(target("/"), lines), 403) << origin;
    EXPECT_EQ(WebClient(front->port(), target(), lines).answer().substr(9, 3), "403") << origin;
  }
  EXPECT_EQ(WebClient(front->port(), target(), "Host: " + host + "\r\n").answer().substr(9, 3),
            "403");
  expect_serving();
}

TEST_F(Web, ServerServesOnePageOnly) {
  start();
  const std::string lines = "Host: " + host + "\r\n";
  EXPECT_EQ(status("/favicon.ico", lines), 204);
  for (const char* path : {"/etc/passwd", "/../../etc/passwd", "/index.html", "//", "/%2e%2e/"})
    EXPECT_EQ(status(target(path), lines), 404) << path;
  for (const char* method : {"POST", "HEAD", "PUT", "DELETE", "OPTIONS", "CONNECT", "get"}) {
    const std::string answer =
        ask(std::string(method) + " " + target("/") + " HTTP/1.1\r\n" + lines + "\r\n");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 405 ")) << method << answer.substr(0, 40);
  }
  EXPECT_EQ(status(target("/ws"), own_headers()), 426);
}

TEST_F(Web, LimitsRequests) {
  start();
  EXPECT_EQ(status("/?token=" + std::string(5000, 'a'), "Host: " + host + "\r\n"), 414);
  EXPECT_EQ(status("/", "Host: " + host + "\r\nX: " + std::string(20000, 'a') + "\r\n"), 431);
  EXPECT_TRUE(ask(std::string(100000, 'a')).starts_with("HTTP/1.1 414 "));
  std::string many = "Host: " + host + "\r\n";
  for (int k = 0; k < 2000; ++k) many += "A" + std::to_string(k) + ": b\r\n";
  EXPECT_EQ(status("/", many), 431);
  EXPECT_TRUE(ask("\x16\x03\x01\x02\r\n\r\n").starts_with("HTTP/1.1 400 "));
  expect_serving();
}

TEST_F(Web, ServerRefusesBadFramesAndContinues) {
  start();
  const auto code_for = [&](const std::string& bytes) {
    auto page = connect();
    page->socket().send(bytes);
    return page->close_code(3);
  };
  EXPECT_EQ(code_for(client_frame(0x81, "unmasked", false)), 1002);
  EXPECT_EQ(code_for(client_frame(0xF1, "reserved bits")), 1002);
  EXPECT_EQ(code_for(client_frame(0x87, "unknown")), 1002);
  EXPECT_EQ(code_for(client_frame(0x80, "continues nothing")), 1002);
  EXPECT_EQ(code_for(client_frame(0x81, "m 1 \xFF")), 1007);
  EXPECT_EQ(code_for(client_frame(0x82, "pictures go the other way")), 1003);
  EXPECT_EQ(code_for(client_frame(0x88, "x")), 1002);
  EXPECT_EQ(code_for(client_frame(0x88, "")), 1000);
  EXPECT_EQ(code_for(client_frame(0x88, "\x03\xE8")), 1000);
  EXPECT_EQ(code_for("GET / HTTP/1.1\r\n\r\n"), 1002);
  expect_serving();
}

TEST_F(Web, ServerTakesMessagesInPiecesAndAnswersPings) {
  start();
  auto page = connect();
  page->send_frame(0x01, "k 6");
  page->send_frame(0x89, "are you there");
  page->send_frame(0x00, "");
  page->send_frame(0x80, "5 1 0");
  EXPECT_TRUE(wait_for_key('A', true));
  const auto pong = page->receive(WebClient::pong, 3);
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->payload, "are you there");
}

TEST_F(Web, ServerRefusesTooLongMessagesWithoutKeepingThem) {
  start();
  const double before = resident_bytes();
  for (const std::uint64_t length : {std::uint64_t(300'000), std::uint64_t(100'000'000)}) {
    auto page = connect();
    std::string head("\x81\xFF", 2);
    for (int k = 7; k >= 0; --k) head += char(length >> (8 * k) & 0xFF);
    page->socket().send(head + "mask");
    EXPECT_EQ(page->close_code(3), 1009) << length;
    // The rest of the message goes to a closed socket.
    const std::string megabyte(1 << 20, 'x');
    for (int k = 0; k < 100 && page->socket().send(megabyte); ++k) {
    }
  }
  // Many pieces, each small.
  auto page = connect();
  page->send_frame(0x01, std::string(60'000, 'x'));
  for (int k = 0; k < 10; ++k) page->send_frame(0x00, std::string(60'000, 'x'));
  EXPECT_EQ(page->close_code(5), 1009);
  EXPECT_LT(resident_bytes() - before, memory_slack);
  expect_serving();
}

TEST_F(Web, ServerSurvivesRandomConnections) {
  start();
  std::mt19937 random(3);
  for (int run = 0; run < 150; ++run) {
    std::string bytes(random() % 300, '\0');
    for (char& c : bytes) c = char(random());
    if (run % 3 == 0) {
      RawSocket(front->port()).send("GET " + bytes + "\r\n\r\n");
    } else if (run % 3 == 1) {
      connect()->socket().send(bytes);
    } else {
      auto page = connect();
      page->socket().send(client_frame(0x81, "m 1 1 0") + char(0x81) + char(0x85) + bytes);
      page->socket().abort();
    }
  }
  expect_serving();
}

TEST_F(Web, ServerEndsSlowAndSilentConnections) {
  app::view::web::WebOptions options;
  options.limits.head_seconds = 0.4;
  options.limits.message_seconds = 0.4;
  options.limits.ping_seconds = 0.3;
  start(options);
  // A request that never ends, byte by byte.
  RawSocket slow(front->port());
  const double begin = seconds_now();
  std::string answer;
  while (seconds_now() < begin + 5 && !slow.is_closed()) {
    slow.send("G");
    slow.receive(answer, 0.05);
  }
  EXPECT_LT(seconds_now() - begin, 2);
  EXPECT_EQ(answer, "");
  // Nothing at all.
  RawSocket silent(front->port());
  EXPECT_EQ(silent.receive_all(3), "");
  EXPECT_TRUE(silent.is_closed());
  // A message that never ends. Two more bytes come now and then, so that the connection lives.
  auto page = connect();
  const std::string message = client_frame(0x81, std::string(200, 'x'));
  std::size_t sent = 0;
  int code = 0;
  while (code == 0 && sent + 2 < message.size()) {
    page->socket().send(message.substr(sent, 2));
    sent += 2;
    code = page->close_code(0.05);
  }
  EXPECT_EQ(code, 1008);
  // A viewer that does not answer signs of life is gone: its cable was cut.
  auto mute = connect();
  EXPECT_TRUE(wait_until([&] { return front->is_ready(); }));
  EXPECT_TRUE(wait_until([&] { return !front->is_ready(); }, 3));
  EXPECT_EQ(mute->close_code(1), -1);
  expect_serving();
}

TEST_F(Web, ServerKeepsServingWhileOthersOnlySitThere) {
  start();
  auto page = connect();
  std::vector<std::unique_ptr<RawSocket>> idle;
  for (int k = 0; k < 100; ++k) {
    idle.push_back(std::make_unique<RawSocket>(front->port()));
    idle.back()->send("GET /?to");
  }
  // The viewer stays, and a new page does not wait for them to be tired of.
  page->send_text("k 65 1 0");
  EXPECT_TRUE(wait_for_key('A', true));
  const double begin = seconds_now();
  EXPECT_EQ(status(target("/"), "Host: " + host + "\r\n"), 200);
  EXPECT_LT(seconds_now() - begin, 1);
  expect_serving();
}

TEST_F(Web, FloodNeitherGrowsNorStops) {
  start();
  expect_serving();
  const double before = resident_bytes();
  // The page floods the program for half a second while it looks away, then while it looks.
  std::string flood;
  for (int k = 0; k < 2000; ++k)
    flood += client_frame(0x81, k % 2 ? "k 65 1 0" : "k 65 0 0") + client_frame(0x81, "m 1 2 0");
  auto page = connect();
  RawSocket& socket = page->socket();
  std::atomic<bool> is_over = false;
  std::thread sender([&] {
    while (!is_over && socket.send(flood)) {
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_LT(resident_bytes() - before, memory_slack);
  std::size_t most = 0, count = 0;
  for (const double end = seconds_now() + 1; seconds_now() < end;) {
    const double begin = seconds_now();
    const std::size_t events_now = front->wait(0.1).size();
    most = std::max(most, events_now);
    count += events_now;
    EXPECT_LT(seconds_now() - begin, 1);
  }
  EXPECT_LE(most, app::view::frontend::EventQueue::limit);
  // 512 KiB a second of messages of at least 13 bytes, a second's worth of them at once.
  EXPECT_LT(count, 3 * 512 * 1024 / 13);
  EXPECT_GT(count, 1000u);
  EXPECT_LT(resident_bytes() - before, memory_slack);
  is_over = true;
  // The program reads on, or the sender would wait for ever.
  socket.shut_down();
  sender.join();
  page.reset();
  expect_serving();
}

TEST_F(Web, ViewerThatReadsNothingCostsTwoPictures) {
  app::view::web::WebOptions options;
  options.limits.stall_seconds = 1;
  start(options);
  auto page = connect(true, 4096);
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  std::mt19937 random(5);
  render::Image noise = plain_image(800, 800, 0, 0, 0);
  const double before = resident_bytes();
  // It says that it has seen pictures which it has not even read.
  for (int k = 0; k < 40; ++k) {
    for (std::size_t j = 0; j + 4 <= noise.pixels.size(); j += 4) {
      const auto bits = std::uint32_t(random());
      std::memcpy(&noise.pixels[j], &bits, 4);
    }
    front->show_image(noise);
    page->send_text("a " + std::to_string(k + 1));
    front->wait(0.005);
  }
  // Each is about 0.8 MB, all of them 32 MB.
  EXPECT_LT(resident_bytes() - before, memory_slack);
  // The page is given up in the end.
  EXPECT_TRUE(
      wait_until([&] { return front->pacing().in_flight() == 0 || !front->is_ready(); }, 4));
  expect_serving();
}

TEST_F(Web, FiftyReconnectsLeaveNothingBehind) {
  start();
  const auto files = [] {
    int count = 0;
    for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
      ++count;
    return count;
  };
  for (int k = 0; k < 5; ++k) expect_serving();
  const double before = resident_bytes();
  const int files_before = files();
  for (int k = 0; k < 50; ++k) {
    events.clear();
    auto page = connect();
    page->send_text("k 65 1 0");
    page->send_text("b 0 1 5 5 0");
    ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); })) << k;
    front->show_image(plain_image(640, 480, k, 0, 0));
    ASSERT_TRUE(page->receive(WebClient::binary, 3)) << k;
    // Some go without a word, some with one, some in the middle of one.
    if (k % 3 == 0) page->socket().abort();
    if (k % 3 == 1) page->send_frame(0x88, "\x03\xE8");
    if (k % 3 == 2) page->socket().send("\x81");
    page.reset();
    EXPECT_TRUE(wait_for_key('A', false)) << "the key of a viewer who left is still held";
  }
  EXPECT_TRUE(wait_until([&] { return files() <= files_before; }));
  EXPECT_LT(resident_bytes() - before, memory_slack);
  expect_serving();
}

TEST(WebFrontend, OtherAddressesNeedConsentToTheRisk) {
  app::view::web::WebOptions options;
  options.address = "0.0.0.0";
  try {
    app::view::web::WebFrontend front(options);
    FAIL() << "listens at every network";
  } catch (const app::Error& error) {
    EXPECT_EQ(error.code, app::exit_usage);
    EXPECT_NE(std::string(error.what()).find("anyone who can reach it"), std::string::npos);
  }
  options.is_risk_taken = true;
  const app::view::web::WebFrontend front(options);
  EXPECT_EQ(front.where().find("0.0.0.0"), std::string::npos) << front.where();
}

TEST(WebFrontend, AnAddressThatCannotBeUsedIsExplained) {
  app::view::web::WebOptions options;
  const app::view::web::WebFrontend first(options);
  options.port = first.port();
  EXPECT_THROW(app::view::web::WebFrontend second(options), app::IoError);
  options.port = 70000;
  EXPECT_THROW(app::view::web::WebFrontend third(options), app::IoError);
  options.port = 0;
  options.is_risk_taken = true;
  for (const char* address : {"192.0.2.77", "nowhere.example", "", "127.0.0.1:80"}) {
    options.address = address;
    EXPECT_THROW(app::view::web::WebFrontend fourth(options), app::IoError) << address;
  }
}

}  // namespace
}  // namespace neve::test
