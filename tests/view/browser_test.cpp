/// The page in a real browser: what a person does there arrives, and what is shown is seen.

#include "tests/support/chromium.h"
#include "tests/support/needs.h"
#include "tests/support/temporary_folder.h"
#include "tests/view/relay.h"
#include "tests/view/web_support.h"

namespace neve::test {
namespace {

using app::view::frontend::InputEvent;
using Kind = InputEvent::Kind;

/// Each quarter has its colour: red, green, blue, and grey at the lower right.
render::Image quarters(int width, int height) {
  render::Image image{width, height, 3, {}};
  image.pixels.resize(std::size_t(width) * height * 3);
  const int colours[4][3] = {{220, 30, 30}, {30, 200, 30}, {30, 30, 220}, {128, 128, 128}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixels[(std::size_t(y) * width + x) * 3 + c] =
            std::uint8_t(colours[2 * (2 * y >= height) + (2 * x >= width)][c]);
  return image;
}

const std::uint8_t* pixel(const render::Image& image, double x, double y) {
  const int column = int(x * image.width), row = int(y * image.height);
  return &image.pixels[(std::size_t(row) * image.width + column) * image.channels];
}

/// True once the page shows a picture. Until its script has run, the page before it answers, or
/// none.
constexpr const char* is_drawn = "typeof note !== 'undefined' && note.hidden && drawn > 0";

class Browser : public Web {
 protected:
  static void SetUpTestSuite() {
    if (!find_chromium().empty()) browser = std::make_unique<Chromium>();
  }
  static void TearDownTestSuite() { browser.reset(); }

  void SetUp() override {
    if (!browser) SKIP_OR_FAIL(no_chromium);
    browser->exceptions.clear();
    start();
  }
  void TearDown() override {
    if (!browser) return;
    EXPECT_EQ(browser->exceptions, "") << "the page's script failed";
  }

  /// Opens the page and shows it a picture of its window's size.
  void open(const std::string& address = {}, int width = 640, int height = 400, double ratio = 1) {
    browser->resize(width, height, ratio);
    browser->open(address.empty() ? front->where() : address);
    ASSERT_TRUE(show_until([&] { return is_true(is_drawn); }));
    events.clear();
  }

  /// Shows a picture of the window's size whenever the frontend wants one. A single picture could
  /// go to a page that is just being replaced.
  bool show_until(const std::function<bool()>& is_content) {
    return wait_until(
        [&] {
          if (front->is_picture_wanted())
            front->show_image(quarters(front->size().width, front->size().height));
          return is_content();
        },
        15);
  }

  bool is_true(const std::string& expression) { return browser->evaluate(expression) == true; }
  std::string note() { return browser->evaluate("note.hidden ? '' : note.textContent"); }

  /// Waits for a move of the mouse to this place.
  bool wait_for_move(double x, double y) {
    return wait_for([=](const InputEvent& event) {
      return event.kind == Kind::move && std::abs(event.x - x) < 0.6 && std::abs(event.y - y) < 0.6;
    });
  }
  bool wait_for_button(int button, bool is_down, double x, double y) {
    return wait_for([=](const InputEvent& event) {
      return event.kind == Kind::button && event.button == button && event.is_down == is_down &&
             std::abs(event.x - x) < 0.6 && std::abs(event.y - y) < 0.6;
    });
  }
  /// Everything typed so far.
  bool wait_for_text(const std::string& text) {
    return wait_until([&] {
      std::string all;
      for (const InputEvent& event : events)
        if (event.kind == Kind::text) all += event.text;
      return all == text;
    });
  }
  void press(const std::string& name, const std::string& code, int number, int modifiers = 0,
             const std::string& command = {}) {
    browser->key(true, name, code, number, modifiers, command);
    browser->key(false, name, code, number, modifiers);
  }

  void expect_quarters(const render::Image& shot) {
    // JPEG and the browser's colours keep each within some steps.
    EXPECT_GT(pixel(shot, 0.25, 0.25)[0], 200);
    EXPECT_LT(pixel(shot, 0.25, 0.25)[1], 60);
    EXPECT_GT(pixel(shot, 0.75, 0.25)[1], 180);
    EXPECT_GT(pixel(shot, 0.25, 0.75)[2], 200);
    EXPECT_NEAR(pixel(shot, 0.75, 0.75)[0], 128, 8);
    EXPECT_NEAR(pixel(shot, 0.75, 0.75)[2], 128, 8);
    // The picture reaches the very edge: no margin and no scroll bar.
    EXPECT_GT(pixel(shot, 0.001, 0.001)[0], 200);
    EXPECT_NEAR(pixel(shot, 0.999, 0.999)[1], 128, 8);
  }

  static inline std::unique_ptr<Chromium> browser;
};

TEST_F(Browser, BrowserSeesThePictureAndHidesTheToken) {
  open();
  EXPECT_EQ(front->size().width, 640);
  EXPECT_EQ(front->size().height, 400);
  expect_quarters(browser->screenshot());
  EXPECT_EQ(browser->evaluate("location.href"), "http://" + host + "/");
  front->set_title("snow \"ball\"");
  EXPECT_TRUE(wait_until([&] { return browser->evaluate("document.title") == "snow \"ball\""; }));
}

TEST_F(Browser, ReloadNeedsNoTokenInTheAddress) {
  open();
  browser->call("Page.reload");
  // First the server sees the viewer leave.
  ASSERT_TRUE(wait_until([&] { return !front->is_ready(); }));
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  front->show_image(quarters(640, 400));
  EXPECT_TRUE(wait_until([&] { return is_true(is_drawn); }));
  EXPECT_EQ(browser->evaluate("location.href"), "http://" + host + "/");
}

TEST_F(Browser, PointerComesWithItsPlace) {
  open();
  browser->mouse("mouseMoved", 100, 80);
  EXPECT_TRUE(wait_for_move(100, 80));
  int number = 0;
  for (const char* button : {"left", "right", "middle"}) {
    browser->click(200 + 10 * number, 120, button);
    EXPECT_TRUE(wait_for_button(number, true, 200 + 10 * number, 120)) << button;
    EXPECT_TRUE(wait_for_button(number, false, 200 + 10 * number, 120)) << button;
    ++number;
  }
  // A drag continues outside of the window.
  browser->mouse("mousePressed", 300, 200, "left", 1);
  browser->mouse("mouseMoved", -20, 200, "left", 1);
  browser->mouse("mouseReleased", -20, 210, "left");
  EXPECT_TRUE(wait_for_button(0, false, -20, 210));
  EXPECT_TRUE(wait_for_move(-100000, -100000)) << "it has left";
  events.clear();
  browser->wheel(50, 60, 0, -100);
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::wheel && std::abs(event.y - 1) < 0.3 && event.x == 0;
  })) << "one notch away from the person is up";
  EXPECT_TRUE(wait_for_move(50, 60)) << "where it was turned";
}

TEST_F(Browser, PinchOnATouchPadIsAWheelWithoutCtrl) {
  open();
  browser->wheel(50, 60, 0, -10, 2);  // as browsers tell it, though nobody pressed ctrl
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::wheel && std::abs(event.y - 1) < 0.3 && !event.held.ctrl;
  }));
  events.clear();
  browser->key(true, "Control", "ControlLeft", 17, 2);
  browser->wheel(50, 60, 0, -100, 2);
  browser->key(false, "Control", "ControlLeft", 17);
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::wheel && std::abs(event.y - 1) < 0.3 && event.held.ctrl;
  }));
}

/// A swipe that begins on a slider of a list scrolls the list and changes nothing.
TEST_F(Browser, AFingerScrollsAListAndDragsSideways) {
  browser->call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 2}});
  open();
  front->set_scrolling({{0, 100, 200, 200, 50}});
  EXPECT_TRUE(show_until([&] { return is_true("scrolls.length === 1"); }))
      << "the page knows the list";
  const auto pressed = [&] {
    return std::any_of(events.begin(), events.end(), [](const InputEvent& event) {
      return event.kind == Kind::button && event.is_down;
    });
  };
  events.clear();
  browser->touch("touchStart", {{100, 250}});
  browser->touch("touchMove", {{103, 220}});
  browser->touch("touchMove", {{104, 150}});
  browser->touch("touchEnd", {});
  EXPECT_TRUE(wait_for_move(-100000, -100000));
  float notches = 0;
  for (const InputEvent& event : events)
    if (event.kind == Kind::wheel) notches += event.y;
  // 100 pixels up, 50 to a notch; the page rounds each move to hundredths.
  EXPECT_NEAR(notches, -2, 0.02);
  EXPECT_FALSE(pressed());
  // Sideways, and beside the list, it drags.
  for (const auto& [from, to] : {std::pair(std::pair(100, 250), std::pair(160, 240)),
                                 std::pair(std::pair(300, 250), std::pair(300, 150))}) {
    events.clear();
    browser->touch("touchStart", {{from.first, from.second}});
    browser->touch("touchMove", {{(from.first + to.first) / 2, (from.second + to.second) / 2}});
    browser->touch("touchMove", {{to.first, to.second}});
    browser->touch("touchEnd", {});
    EXPECT_TRUE(wait_for_button(0, false, to.first, to.second));
    EXPECT_TRUE(pressed());
  }
  browser->call("Emulation.setTouchEmulationEnabled", {{"enabled", false}});
}

TEST_F(Browser, FingersAreButtonsAndWheel) {
  browser->call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 2}});
  open();
  // A tap is a click.
  browser->touch("touchStart", {{100, 90}});
  browser->touch("touchEnd", {});
  EXPECT_TRUE(wait_for_button(0, true, 100, 90));
  EXPECT_TRUE(wait_for_button(0, false, 100, 90));
  EXPECT_TRUE(wait_for_move(-100000, -100000)) << "nothing stays lit";
  // A second one at once has ctrl.
  browser->touch("touchStart", {{102, 91}});
  browser->touch("touchEnd", {});
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::button && event.button == 0 && event.is_down && event.held.ctrl;
  }));
  // One finger drags with the left button.
  events.clear();
  browser->touch("touchStart", {{200, 150}});
  browser->touch("touchMove", {{260, 170}});
  browser->touch("touchMove", {{300, 180}});
  browser->touch("touchEnd", {});
  EXPECT_TRUE(wait_for_button(0, true, 200, 150) || wait_for_button(0, true, 260, 170));
  EXPECT_TRUE(wait_for_button(0, false, 300, 180));
  // Two drag with the middle one; away from each other they are a wheel as well.
  events.clear();
  browser->touch("touchStart", {{200, 200}, {300, 200}});
  browser->touch("touchMove", {{150, 220}, {350, 220}});
  browser->touch("touchEnd", {});
  EXPECT_TRUE(wait_for_button(2, true, 250, 200));
  EXPECT_TRUE(wait_for_button(2, false, 250, 220));
  float notches = 0;
  for (const InputEvent& event : events) {
    if (event.kind == Kind::wheel) notches += event.y;
    EXPECT_FALSE(event.kind == Kind::button && event.button == 0) << "no click on the way";
  }
  // Twice as far apart is twice as large: a notch makes it 1 / 0.88 times as large.
  EXPECT_NEAR(std::pow(0.88, -notches), 2, 0.05);
  EXPECT_TRUE(wait_for_move(-100000, -100000)) << "the fingers have left";
  browser->call("Emulation.setTouchEmulationEnabled", {{"enabled", false}});
}

TEST_F(Browser, PlacesArePixelsOfThePicture) {
  open({}, 400, 300, 2);
  EXPECT_EQ(front->size().width, 800);
  EXPECT_EQ(front->size().height, 600);
  EXPECT_EQ(front->size().scale, 2);
  browser->mouse("mouseMoved", 100, 75);
  EXPECT_TRUE(wait_for_move(200, 150));
  expect_quarters(browser->screenshot());
  // A picture with half the pixels, as while something is dragged.
  front->show_image(quarters(400, 300));
  EXPECT_TRUE(wait_until([&] { return is_true("picture.width === 400"); }));
  events.clear();
  browser->mouse("mouseMoved", 200, 150);
  EXPECT_TRUE(wait_for_move(200, 150));
  expect_quarters(browser->screenshot());
}

TEST_F(Browser, WindowMayChangeItsSize) {
  open();
  browser->resize(500, 300);
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::resize && event.x == 500 && event.y == 300;
  }));
  front->show_image(quarters(front->size().width, front->size().height));
  EXPECT_TRUE(wait_until([&] { return is_true("picture.width === 500"); }));
  expect_quarters(browser->screenshot());
}

TEST_F(Browser, KeysAreThoseOfTheProgramButNotOfTheBrowser) {
  open();
  browser->key(true, "a", "KeyA", 65);
  EXPECT_TRUE(wait_for_key('A', true));
  browser->key(false, "a", "KeyA", 65);
  EXPECT_TRUE(wait_for_key('A', false));
  EXPECT_TRUE(wait_for_text("a"));
  press("Tab", "Tab", 9);
  EXPECT_TRUE(wait_for_key(app::view::frontend::key::tab, false));
  EXPECT_TRUE(is_true("document.activeElement === typing")) << "Tab stays inside";
  press("ArrowLeft", "ArrowLeft", 37);
  EXPECT_TRUE(wait_for_key(app::view::frontend::key::left, false));
  press(" ", "Space", 32);
  EXPECT_TRUE(wait_for_key(' ', false));
  press("?", "Slash", 191, 8);
  EXPECT_TRUE(wait_for_key('/', false));
  EXPECT_TRUE(wait_for_text("a ?"));
  browser->key(true, "Control", "ControlLeft", 17, 2);
  press("z", "KeyZ", 90, 2);
  browser->key(false, "Control", "ControlLeft", 17);
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::key && event.key == 'Z' && event.is_down && event.held.ctrl;
  }));
  EXPECT_TRUE(wait_for_key(app::view::frontend::key::ctrl, false));
  events.clear();
  press("F12", "F12", 123);
  press("l", "KeyL", 76, 2);
  press("x", "KeyX", 88);
  EXPECT_TRUE(wait_for_key('X', false));
  for (const InputEvent& event : events)
    EXPECT_TRUE(event.kind != Kind::key || event.key == 'X') << event.key;
}

TEST_F(Browser, HeldKeysAreLetGoWhenThePageLosesTheFocus) {
  open();
  browser->key(true, "w", "KeyW", 87);
  ASSERT_TRUE(wait_for_key('W', true));
  browser->mouse("mousePressed", 30, 30, "left", 1);
  ASSERT_TRUE(wait_for_button(0, true, 30, 30));
  browser->evaluate("dispatchEvent(new Event('blur'))");
  EXPECT_TRUE(wait_for_key('W', false));
  EXPECT_TRUE(wait_for_button(0, false, 30, 30));
  browser->key(false, "w", "KeyW", 87);
  browser->mouse("mouseReleased", 30, 30, "left");
}

TEST_F(Browser, TextComesAsItIsWritten) {
  open();
  for (const char c : std::string("0.25")) browser->type_letter(c);
  EXPECT_TRUE(wait_for_text("0.25"));
  // An input method: nothing counts before the word is chosen.
  browser->call("Input.imeSetComposition",
                {{"text", "yuki"}, {"selectionStart", 4}, {"selectionEnd", 4}});
  browser->call("Input.insertText", {{"text", "\xE9\x9B\xAA"}});
  EXPECT_TRUE(wait_for_text("0.25\xE9\x9B\xAA"));
  EXPECT_EQ(browser->evaluate("typing.value"), "");
}

TEST_F(Browser, ClipboardGoesBothWays) {
  open();
  browser->call("Browser.grantPermissions",
                {{"origin", "http://" + host},
                 {"permissions", {"clipboardReadWrite", "clipboardSanitizedWrite"}}});
  browser->call("Page.bringToFront");
  browser->click(10, 10);
  front->set_clipboard("neve render \"n\xC3\xA9v\xC3\xA9.toml\"\n--set a=1");
  EXPECT_TRUE(wait_until([&] {
    return browser->evaluate("navigator.clipboard.readText()") ==
           "neve render \"n\xC3\xA9v\xC3\xA9.toml\"\n--set a=1";
  }));
  browser->evaluate("navigator.clipboard.writeText('1.4e5 Pa')");
  press("v", "KeyV", 86, 2, "paste");
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == Kind::paste && event.text == "1.4e5 Pa";
  }));
  EXPECT_EQ(front->clipboard(), "1.4e5 Pa");
  for (const InputEvent& event : events) EXPECT_FALSE(event.kind == Kind::key && event.key == 'V');
}

TEST_F(Browser, LostConnectionIsShownAndComesBack) {
  Relay relay(front->port());
  const std::string address =
      "http://localhost:" + std::to_string(relay.port()) + "/?token=" + front->token();
  open(address);
  relay.cut(true);
  EXPECT_TRUE(wait_until([&] { return note().find("is lost") != std::string::npos; }));
  // The last picture stays, grey and dark behind the message.
  const render::Image shot = browser->screenshot();
  EXPECT_LT(pixel(shot, 0.1, 0.1)[0], 100);
  EXPECT_NEAR(pixel(shot, 0.1, 0.1)[0], pixel(shot, 0.1, 0.1)[2], 6);
  EXPECT_FALSE(front->is_ready());
  relay.cut(false);
  EXPECT_TRUE(show_until([&] { return note().empty(); }));
  expect_quarters(browser->screenshot());
}

TEST_F(Browser, OfferedFilesComeToTheFolderOfDownloads) {
  open();
  const TemporaryFolder here, there;
  here.write("particles/0007.png", std::string(200'000, 'p'));
  browser->call("Browser.setDownloadBehavior",
                {{"behavior", "allow"}, {"downloadPath", there.path().string()}});
  front->offer(here.path(), here / "particles/0007.png");
  const auto arrived = there / "0007.png";
  EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(arrived); }));
  // The browser writes beside it and renames.
  EXPECT_EQ(std::filesystem::file_size(arrived), 200'000u);
  EXPECT_EQ(browser->evaluate("location.href"), "http://" + host + "/") << "the page stays";
}

TEST_F(Browser, EndAndReplacementAreTold) {
  open();
  auto other = connect();
  EXPECT_TRUE(wait_until([&] { return note().find("somewhere else") != std::string::npos; }));
  browser->evaluate("note.querySelector('button').click()");
  EXPECT_EQ(other->close_code(3), app::view::web::close_code::taken);
  EXPECT_TRUE(show_until([&] { return note().empty(); }));
  front.reset();
  for (int k = 0; k < 100 && note().empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(note(), "neve has ended; you can close this page.");
}

TEST_F(Browser, OtherPagesCannotConnect) {
  browser->open("about:blank");
  const std::string attempt =
      "new Promise(done => { const s = new WebSocket('ws://" + host + target() +
      "'); s.onopen = () => done('open'); s.onerror = () => done('refused'); })";
  EXPECT_EQ(browser->evaluate(attempt), "refused");
  EXPECT_FALSE(front->is_ready());
}

}  // namespace
}  // namespace neve::test
