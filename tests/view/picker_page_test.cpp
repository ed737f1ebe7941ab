/// `neve pick` in a browser, in a window and in a terminal, as a program.

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "app/support/errors.h"
#include "app/view/picker/layout.h"
#include "tests/support/chromium.h"
#include "tests/support/needs.h"
#include "tests/support/pick_cli.h"
#include "tests/support/xvfb.h"

namespace neve::test {
namespace {

class PickPage : public PickSearch {
 protected:
  ~PickPage() override {
    if (program_ <= 0) return;
    ::kill(program_, SIGKILL);
    wait_for(program_);
  }

  /// Starts the page, and waits for its address.
  void serve(const std::string& more = "") {
    program_ = start("a", "--web --json " + more);
    ASSERT_TRUE(wait_for_text(folder / "told")) << read_text(folder / "said");
    ASSERT_TRUE(wait_until([&] { return contains(read_text(folder / "told"), "}"); }));
    const app::Json told = json_of("told");
    port_ = told["port"].get<int>();
    url_ = told["url"].get<std::string>();
  }

  std::unique_ptr<WebClient> connect() {
    const std::string host = "127.0.0.1:" + std::to_string(port_);
    auto page =
        std::make_unique<WebClient>(port_, "/ws" + url_.substr(url_.find('?')),
                                    "Host: " + host + "\r\nOrigin: http://" + host + "\r\n");
    EXPECT_TRUE(page->is_open()) << page->answer();
    page->send_text("s 1280 800 1");
    return page;
  }
  void press(WebClient& page, char key) {
    for (const char* down : {" 1 0", " 0 0"})
      page.send_text("k " + std::to_string(int(key)) + down);
  }
  /// Confirms pictures for a moment, as a page does all the time: a program whose picture waits for
  /// that draws no other one, and reads no keys.
  static void watch(WebClient& page) {
    for (int k = 0; k < 5; ++k)
      if (const auto picture = page.receive(WebClient::binary, 0.05)) confirm(page, *picture);
  }
  static void confirm(WebClient& page, const ServerFrame& picture) {
    std::uint32_t number = 0;
    if (picture.payload.size() >= 4) std::memcpy(&number, picture.payload.data(), 4);
    page.send_text("a " + std::to_string(number));
  }

  template <class IsTrue>
  static bool watch_until(WebClient& page, IsTrue is_true) {
    return wait_until([&] {
      watch(page);
      return is_true();
    });
  }

  bool round_is_made(int round) {
    return wait_until([&] {
      return contains(read_text(folder / "a/round.html"),
                      "<h1>Round " + std::to_string(round) + " of 8</h1>");
    });
  }
  /// Opens the page as on a desk. @return whether all of its first round is drawn
  bool open_first_round(Chromium& browser, int rounds) {
    browser.resize(1280, 800);
    browser.open(url_);
    const std::string title = "<h1>Round 1 of " + std::to_string(rounds) + "</h1>";
    const bool is_drawn = wait_until([&] {
      return contains(read_text(folder / "a/round.html"), title) &&
             browser.evaluate("typeof drawn !== 'undefined' && drawn > 1") == true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    return is_drawn;
  }
  static std::pair<double, double> middle(const app::view::picker::Layout& layout, int tile) {
    const app::view::picker::Grid& grid = layout.grid;
    return {grid.tile_x(tile) + grid.tile_width / 2.0, grid.tile_y(tile) + grid.tile_height / 2.0};
  }
  /// Waits for the end, two minutes at most. @return exit code
  int end() {
    if (!wait_until([&] { return has_ended(); })) ::kill(program_, SIGKILL);
    return wait_for(std::exchange(program_, -1));
  }

  bool has_ended() const {
    siginfo_t told{};
    return ::waitid(P_PID, static_cast<id_t>(program_), &told, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           told.si_pid != 0;
  }

  pid_t program_ = -1;
  int port_ = 0;
  std::string url_;
};

/// Two browsers: the one opened last has the search. A closed page changes nothing: the round is
/// made, and the page opened next answers it.
TEST_F(PickPage, PagesComeAndGoAndTheSearchContinues) {
  serve();
  auto first = connect();
  ASSERT_TRUE(first->receive(WebClient::binary, 20));
  auto second = connect();
  ASSERT_TRUE(second->receive(WebClient::binary, 20));
  ASSERT_TRUE(round_is_made(1));
  press(*first, '3');  // is not heard any more
  watch(*first);
  press(*second, '5');
  ASSERT_TRUE(watch_until(*second, [&] { return answers("a") == "5\n"; })) << answers("a");
  second.reset();
  ASSERT_TRUE(round_is_made(2));
  auto third = connect();
  ASSERT_TRUE(third->receive(WebClient::binary, 20));
  press(*third, '1');
  ASSERT_TRUE(watch_until(*third, [&] { return answers("a") == "5\n1\n"; })) << answers("a");
  press(*third, 'Q');
  ASSERT_TRUE(watch_until(*third, [&] { return exists("a/picked.toml"); }));
  press(*third, 'Q');
  ASSERT_TRUE(watch_until(*third, [&] { return has_ended(); }));
  EXPECT_EQ(end(), 0) << read_text(folder / "said");
  ASSERT_EQ(by_list("5\n1\n", "b").exit_code, 0);
  expect_same_pick("a", "b");
}

/// Ctrl-C while a round is made: 75, no process left, and the same command continues.
TEST_F(PickPage, CtrlCDuringARoundLosesNothing) {
  serve();
  ASSERT_TRUE(wait_until([&] { return exists("a/manifest.json"); }));
  const auto begin = std::chrono::steady_clock::now();
  ::kill(program_, SIGINT);
  EXPECT_EQ(end(), app::exit_resumable) << read_text(folder / "said");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_TRUE(contains(read_text(folder / "said"), "the same command continues"));
  serve();
  ASSERT_TRUE(round_is_made(1));
  ::kill(program_, SIGTERM);
  EXPECT_EQ(end(), app::exit_resumable);
}

/// A person with a mouse on a desk, then with a finger on a phone.
TEST_F(PickPage, AClickOnATileChoosesItOnDeskAndPhone) {
  if (find_chromium().empty()) SKIP_OR_FAIL(no_chromium);
  serve("--rounds 2");
  Chromium browser;
  ASSERT_TRUE(open_first_round(browser, 2));
  const auto [x, y] = middle(app::view::picker::lay_out(1280, 800, 14, 2, 64, 36), 4);
  browser.click(x, y);
  ASSERT_TRUE(wait_until([&] { return answers("a") == "5\n"; })) << answers("a");
  browser.call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 2}});
  browser.resize(390, 844);
  ASSERT_TRUE(wait_until(
      [&] { return contains(read_text(folder / "a/round.html"), "<h1>Round 2 of 2</h1>"); }));
  ASSERT_TRUE(wait_until([&] { return browser.evaluate("picture.width === 390") == true; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto [u, v] = middle(app::view::picker::lay_out(390, 844, 14, 2, 64, 36), 8);
  browser.touch("touchStart", {{u, v}});
  browser.touch("touchEnd", {});
  ASSERT_TRUE(wait_until([&] { return answers("a") == "5\n9\n"; })) << answers("a");
  EXPECT_TRUE(wait_until([&] { return exists("a/picked.toml"); }));
  EXPECT_EQ(browser.exceptions, "");
}

/// The buttons of the column on the right are drawn, not elements of the page: clicks down the
/// column press each of them.
TEST_F(PickPage, TheEndGivesItsFilesToTheBrowser) {
  if (find_chromium().empty()) SKIP_OR_FAIL(no_chromium);
  serve("--rounds 1");
  Chromium browser;
  const TemporaryFolder there;
  browser.call("Browser.setDownloadBehavior",
               {{"behavior", "allow"}, {"downloadPath", there.path().string()}});
  ASSERT_TRUE(open_first_round(browser, 1));
  const app::view::picker::Layout layout = app::view::picker::lay_out(1280, 800, 14, 2, 64, 36);
  const auto [tile_x, tile_y] = middle(layout, 0);
  browser.click(tile_x, tile_y);
  ASSERT_TRUE(wait_until([&] { return exists("a/picked.toml"); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const std::vector<std::string> files{"picked.toml", "picked_sweep.toml", "clicks.txt"};
  const auto came = [&](const std::string& file) {
    return std::filesystem::exists(there.path() / file);
  };
  const double x = layout.grid.tile_x(2) + layout.grid.tile_width + 60;
  for (double y = 60; y < 790 && !std::all_of(files.begin(), files.end(), came); y += 12) {
    browser.click(x, y);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  }
  for (const std::string& file : files) {
    ASSERT_TRUE(wait_until([&] { return came(file); })) << file;
    EXPECT_EQ(read_text(there.path() / file), read_text(folder / "a" / file)) << file;
  }
  EXPECT_EQ(browser.exceptions, "");
}

/// The window is the same screen: a key there is an answer.
TEST_F(PickPage, AWindowIsAnsweredByKeys) {
  const Xvfb display;
  if (!display.reason().empty()) SKIP_OR_FAIL(display.reason());
  XHand hand;
  if (!hand.reason().empty()) SKIP_OR_FAIL(hand.reason());
  program_ = start("a", "--window");
  if (!wait_until([&] { return exists("a/round.html") || has_ended(); }) || has_ended()) {
    if (contains(read_text(folder / "said"), "built without")) SKIP_OR_FAIL("no window");
    FAIL() << read_text(folder / "said");
  }
  hand.move(600, 400);
  ASSERT_TRUE(wait_until([&] {
    if (answers("a").empty()) hand.tap('5');
    return !answers("a").empty();
  }));
  EXPECT_EQ(answers("a"), "5\n");
  hand.tap('q');
  ASSERT_TRUE(wait_until([&] { return exists("a/picked.toml"); }));
  hand.tap('q');
  EXPECT_EQ(end(), 0) << read_text(folder / "said");
}

/// A user with a terminal alone, over ssh: the page is offered, and the terminal answers too.
TEST_F(PickPage, InATerminalWithoutADisplayBothWaysWork) {
  int terminal = -1;
  std::vector<std::string> all = words("a");
  program_ = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (program_ == 0) {
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    std::vector<char*> argv{const_cast<char*>(NEVE_BINARY)};
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (::chdir(folder.path().c_str()) == 0) ::execv(NEVE_BINARY, argv.data());
    ::_exit(127);
  }
  std::string said;
  const auto listen = [&] {
    pollfd file{terminal, POLLIN, 0};
    char bytes[4096];
    while (::poll(&file, 1, 0) > 0) {
      const ssize_t count = ::read(terminal, bytes, sizeof bytes);
      if (count <= 0) break;
      said.append(bytes, static_cast<std::size_t>(count));
    }
    return said;
  };
  const auto type = [&](const std::string& line) {
    EXPECT_EQ(::write(terminal, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  };
  ASSERT_TRUE(wait_until([&] { return contains(listen(), "http://127.0.0.1:"); })) << said;
  ASSERT_TRUE(wait_until([&] { return contains(listen(), "round 1 of 8: choose"); })) << said;
  type("5\n");
  ASSERT_TRUE(wait_until([&] { return contains(listen(), "round 2 of 8: choose"); })) << said;
  type("q\n");
  ASSERT_TRUE(wait_until([&] { return contains(listen(), "the pick is written"); })) << said;
  type("q\n");
  ASSERT_TRUE(wait_until([&] { return contains(listen(), "picked after 1 round"); })) << said;
  EXPECT_EQ(end(), 0);
  ::close(terminal);
  ASSERT_EQ(by_list("5\n", "b").exit_code, 0);
  expect_same_pick("a", "b");
}

}  // namespace
}  // namespace neve::test
