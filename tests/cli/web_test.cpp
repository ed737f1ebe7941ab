/// neve view --web as a program: whoever has the token takes no more than a budget.

#include "tests/support/web_view.h"

namespace neve::test {
namespace {

/// Keys and long pastes flood the viewer, from a page that is visible or hidden.
TEST_F(WebView, AFloodEndsWithItsViewerAndTakesNoMemory) {
  start();
  {
    auto page = connect();
    EXPECT_LT(seconds_to_save(*page), 5);
  }
  std::string keys, pastes;
  for (int k = 0; k < 500; ++k)
    keys += client_frame(0x81, k % 2 ? "k 65 0 0" : "k 65 1 0") + client_frame(0x81, "t abc");
  for (int k = 0; k < 5; ++k) pastes += client_frame(0x81, "p " + std::string(100'000, 'x'));
  for (const auto& [flood, is_hidden] :
       {std::pair{keys, false}, std::pair{keys, true}, std::pair{pastes, false}}) {
    auto page = connect();
    if (is_hidden) page->send_text("v 0");
    RawSocket& socket = page->socket();
    std::atomic<bool> is_over = false;
    std::thread sender([&, &bytes = flood] {
      while (!is_over && socket.send(bytes)) {
      }
    });
    // Panels that open take some memory once.
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double before = resident_bytes();
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_LT(resident_bytes() - before, 4e6) << "hidden: " << is_hidden;
    auto next = connect();
    EXPECT_LT(seconds_to_save(*next), 2) << "hidden: " << is_hidden;
    is_over = true;
    socket.shut_down();
    sender.join();
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(WebView, AnyInputLeavesTheProgramRunning) {
  start({"--run"});
  auto page = connect();
  send_anything(*page, 400, 7);
  page.reset();
  // A text field may have the keys now.
  EXPECT_TRUE(connect()->receive(WebClient::binary, 5)) << "no picture for the next page";
  EXPECT_TRUE(is_alive()) << read_text(folder / "said");
}

}  // namespace
}  // namespace neve::test
