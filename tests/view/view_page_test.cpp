/// `neve view --web` as a person uses it: the program, its page in a real browser, a mouse and
/// keys.

#include <functional>

#include "tests/support/child.h"
#include "tests/support/chromium.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

/// A few hundred particles: what takes time here is drawing and the browser.
constexpr const char* long_fall = R"(
title = "Long fall"
frames = 2000
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.1 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
)";

struct Region {
  int x0, y0, x1, y1;  ///< px of the page
};
/// The page is 1280x800; the columns and bars of `neve view` are this wide at that size.
constexpr Region status{460, 4, 940, 32}, left_column{0, 90, 318, 790}, picture{330, 120, 930, 750};
/// Middle of the first button of the bar: Run, and Pause while it runs.
constexpr double run_x = 25, run_y = 18;
constexpr double find_x = 160, find_y = 78;

/// Pixels that differ clearly between two screenshots.
int difference(const render::Image& a, const render::Image& b, const Region& region) {
  int count = 0;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) {
      const std::size_t at = (std::size_t(y) * a.width + x) * a.channels;
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(a.pixels[at + c] - b.pixels[at + c]));
      count += most > 24;  // more than JPEG changes when a picture becomes sharp
    }
  return count;
}

/// Middles of the tab of objects, of its button "Add ..." and of the first and fifth of its menu.
constexpr double objects_x = 115, objects_y = 54, add_x = 28, add_y = 78;
constexpr double item_x = 80, ball_y = 93, sphere_y = 166;

class ViewPage : public testing::Test {
 protected:
  void SetUp() override {
    if (find_chromium().empty()) SKIP_OR_FAIL(no_chromium);
    folder.write("fall.toml", long_fall);
    start_view();
  }
  void TearDown() override {
    if (process > 0) {
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
    }
  }

  void start_view() {
    process = start_program({"/bin/sh", "-c",
                             "cd '" + folder.path().string() +
                                 "' && exec '" NEVE_BINARY "' view fall.toml --web --out saved"
                                 " > address.txt 2> messages.txt"});
    for (int k = 0; k < 600 && address.find('\n') == std::string::npos; ++k) {
      int status_of_process = 0;
      if (::waitpid(process, &status_of_process, WNOHANG) == process) {
        process = -1;
        const std::string why = read_text(folder / "messages.txt");
        if (WEXITSTATUS(status_of_process) == 4) SKIP_OR_FAIL(why);  // no OpenGL here
        FAIL() << why;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      address = read_text(folder / "address.txt");
    }
    ASSERT_TRUE(address.starts_with("http://127.0.0.1:")) << address;
    address.pop_back();
  }

  static bool wait_until(const std::function<bool()>& is_so, double seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  bool changes(const render::Image& before, const Region& region, int pixels) {
    return wait_until([&] { return difference(before, browser->screenshot(), region) >= pixels; });
  }
  bool becomes_still() {
    return wait_until([&] {
      const render::Image before = browser->screenshot();
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      return difference(before, browser->screenshot(), {0, 0, 1280, 800}) == 0;
    });
  }
  void press(const std::string& name, const std::string& code, int number, int modifiers = 0) {
    browser->key(true, name, code, number, modifiers);
    browser->key(false, name, code, number, modifiers);
  }
  void press_with_ctrl(const std::string& name, const std::string& code, int number) {
    browser->key(true, "Control", "ControlLeft", 17, 2);
    press(name, code, number, 2);
    browser->key(false, "Control", "ControlLeft", 17);
  }

  /// The page of the program, 1280x800, once it rests.
  void open_page() {
    browser = std::make_unique<Chromium>();
    browser->resize(1280, 800);
    browser->open(address);
    ASSERT_TRUE(wait_until([&] {
      return browser->evaluate("typeof drawn !== 'undefined' && drawn > 0 && note.hidden") == true;
    })) << "no picture comes";
    ASSERT_TRUE(becomes_still());
  }
  /// A click whose effect is awaited.
  void click_and_see(double x, double y, const Region& region, int pixels) {
    const render::Image before = browser->screenshot();
    browser->click(x, y);
    EXPECT_TRUE(changes(before, region, pixels)) << "a click at " << x << ", " << y;
    EXPECT_TRUE(becomes_still());
  }

  TemporaryFolder folder;
  pid_t process = -1;
  std::string address;
  std::unique_ptr<Chromium> browser;
};

TEST_F(ViewPage, PageIsWorkedWithMouseAndKeys) {
  browser = std::make_unique<Chromium>();
  browser->resize(1280, 800);
  browser->open(address);
  ASSERT_TRUE(wait_until([&] {
    return browser->evaluate("typeof drawn !== 'undefined' && drawn > 0 && note.hidden") == true;
  })) << "no picture comes";
  EXPECT_TRUE(wait_until(
      [&] { return std::string(browser->evaluate("document.title")).starts_with("fall.toml"); }));
  ASSERT_TRUE(becomes_still());

  // The buttons of the bar.
  const render::Image start = browser->screenshot();
  browser->click(run_x, run_y);
  EXPECT_TRUE(changes(start, status, 30)) << "Run does not run";
  EXPECT_TRUE(changes(browser->screenshot(), status, 5)) << "the run continues";
  browser->click(run_x, run_y);
  ASSERT_TRUE(becomes_still()) << "Pause does not pause";

  // The picture is turned and brought near; the panels beside it stay.
  render::Image before = browser->screenshot();
  browser->drag(640, 400, 800, 430);
  EXPECT_TRUE(changes(before, picture, 1000)) << "a drag does not turn the picture";
  ASSERT_TRUE(becomes_still());
  const render::Image turned = browser->screenshot();
  EXPECT_EQ(difference(before, turned, left_column), 0);
  for (int k = 0; k < 4; ++k) browser->wheel(640, 400, 0, -100);
  EXPECT_TRUE(changes(turned, picture, 1000)) << "the wheel does not bring it near";
  ASSERT_TRUE(becomes_still());

  // Text into a field: the list of parameters becomes short.
  before = browser->screenshot();
  browser->click(find_x, find_y);
  for (const char c : std::string("hardening")) browser->type_letter(c);
  EXPECT_TRUE(changes(before, left_column, 2000)) << "what is typed finds nothing";
  press("Escape", "Escape", 27);

  // A key: the picture of this moment goes to the folder, and nowhere else.
  browser->click(640, 760);
  press("p", "KeyP", 80);
  EXPECT_TRUE(wait_until([&] {
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(folder / "saved", none))
      if (file.path().extension() == ".png") return true;
    return false;
  })) << "P saves no picture";

  // Ctrl-C in the terminal.
  ::kill(process, SIGINT);
  EXPECT_TRUE(wait_until([&] {
    return browser->evaluate("note.textContent") == "neve has ended; you can close this page.";
  }));
  EXPECT_EQ(wait_for(process), 0) << read_text(folder / "messages.txt");
  process = -1;
  EXPECT_EQ(browser->exceptions, "");
}

/// A person who records a long run looks at other pages meanwhile.
TEST_F(ViewPage, ARecordingGoesOnWhileThePageIsHidden) {
  open_page();
  constexpr double save_x = 395, save_y = 18, record_x = 460, record_y = 52;
  click_and_see(save_x, save_y, {398, 20, 700, 120}, 1000);
  click_and_see(record_x, record_y, {398, 20, 700, 120}, 1000);
  const auto recorded = [&] {
    std::size_t count = 0;
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(folder / "saved/particles", none))
      count += file.path().extension() == ".png";
    return count;
  };
  const auto say_hidden = [&](const char* value) {
    browser->evaluate(std::string("Object.defineProperty(document, 'hidden', {value: ") + value +
                      ", configurable: true}); document.dispatchEvent(new Event("
                      "'visibilitychange'))");
  };
  browser->click(run_x, run_y);
  ASSERT_TRUE(wait_until([&] { return recorded() >= 2; }));
  say_hidden("true");
  // Some are on their way when it hides; without the page no more than these came.
  const std::size_t before = recorded();
  EXPECT_TRUE(wait_until([&] { return recorded() >= before + 20; }, 60))
      << recorded() << " after " << before;
  const render::Image old = browser->screenshot();
  say_hidden("false");
  EXPECT_TRUE(changes(old, status, 5)) << "the page does not show what was made meanwhile";
}

TEST_F(ViewPage, ObjectsAreAddedOnThePage) {
  open_page();
  const Region column{0, 64, 318, 790};
  click_and_see(objects_x, objects_y, column, 500);
  click_and_see(add_x, add_y, column, 500);
  click_and_see(item_x, sphere_y, picture, 500);
  click_and_see(add_x, add_y, column, 500);
  click_and_see(item_x, ball_y, picture, 300);
  press_with_ctrl("s", "KeyS", 83);
  const auto saved = [&] { return read_text(folder / "saved/scene.toml"); };
  EXPECT_TRUE(wait_until([&] { return saved().find("name = \"sphere\"") != std::string::npos; }));
  EXPECT_NE(saved().find("[[body]]\nname = \"ball_2\"\n"), std::string::npos) << saved();
  press_with_ctrl("z", "KeyZ", 90);
  press_with_ctrl("s", "KeyS", 83);
  EXPECT_TRUE(wait_until([&] { return saved().find("ball_2") == std::string::npos; }));
  EXPECT_EQ(browser->exceptions, "");
}

}  // namespace
}  // namespace neve::test
