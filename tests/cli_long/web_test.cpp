/// The viewer of neve view --web who floods it, for as long as docs/developers.md says with
/// NEVE_WHOLE=1.

#include <iostream>

#include "tests/support/web_view.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

struct Flood {
  const char* name;
  std::string bytes;
  bool is_hidden = false;  ///< the page says that nobody looks at it
};

std::vector<Flood> floods() {
  std::string keys, texts, pastes, moves, sizes, pings;
  for (int k = 0; k < 500; ++k) {
    keys += client_frame(0x81, k % 2 ? "k 65 0 0" : "k 65 1 0");
    texts += client_frame(0x81, "t abc");
    moves += client_frame(0x81, "m " + std::to_string(k) + " " + std::to_string(k % 7) + " 0");
    sizes += client_frame(0x81, "s " + std::to_string(300 + k) + " 300 1");
    pings += client_frame(0x89, "are you there");
  }
  for (int k = 0; k < 5; ++k) pastes += client_frame(0x81, "p " + std::string(100'000, 'x'));
  return {{"keys", keys},          {"keys of a hidden page", keys, true},
          {"texts", keys + texts}, {"pastes", pastes},
          {"moves", moves},        {"sizes", sizes},
          {"pings", pings}};
}

class WebViewFlood : public WebView, public testing::WithParamInterface<Flood> {};

TEST_P(WebViewFlood, TakesNoMemoryAndTheNextViewerIsObeyedAtOnce) {
  start();
  {
    auto page = connect();
    EXPECT_LT(seconds_to_save(*page), 5);
  }
  auto page = connect();
  if (GetParam().is_hidden) page->send_text("v 0");
  RawSocket& socket = page->socket();
  std::atomic<bool> is_over = false;
  std::thread sender([&] {
    while (!is_over && socket.send(GetParam().bytes)) {
    }
  });
  // Panels that open and pictures of another size take some memory once.
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const double before = resident_bytes();
  double most = 0;
  for (int k = 0; k < 10 * count_or_whole(5, 60); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    most = std::max(most, resident_bytes() - before);
  }
  auto next = connect();
  const double seconds = seconds_to_save(*next);
  is_over = true;
  socket.shut_down();
  sender.join();
  std::cout << GetParam().name << ": " << most / (1 << 20) << " MiB more, a key after " << seconds
            << " s\n";
  EXPECT_LT(most, 8 * (1 << 20));
  EXPECT_LT(seconds, 0.5);
  EXPECT_TRUE(is_alive());
}

INSTANTIATE_TEST_SUITE_P(Floods, WebViewFlood, testing::ValuesIn(floods()), [](const auto& info) {
  std::string name = info.param.name;
  std::erase(name, ' ');
  return name;
});

TEST_F(WebView, ThousandsOfInputsLeaveTheProgramRunning) {
  start({"--run"});
  const int count = count_or_whole(1000, 10'000);
  for (int sent = 0; sent < count; sent += 500) {
    auto page = connect();
    send_anything(*page, 500, static_cast<std::uint32_t>(sent));
    ASSERT_TRUE(is_alive()) << read_text(folder / "said");
  }
  EXPECT_TRUE(connect()->receive(WebClient::binary, 5)) << "no picture for the next page";
}

}  // namespace
}  // namespace neve::test
