/// Pictures to a page and back what a person does, by a page that is no browser.

#include <thread>

#include "render/image/jpeg.h"
#include "tests/view/web_support.h"

namespace neve::test {
namespace {

using app::view::frontend::InputEvent;
using app::view::web::FramePacing;

TEST(Jpeg, JpegKeepsThePicture) {
  ASSERT_TRUE(render::can_encode_jpeg());
  const render::Image image = plain_image(33, 17, 200, 100, 50);
  const auto quick = render::encode_jpeg(image, 60, false);
  const auto sharp = render::encode_jpeg(image, 92, true);
  for (const auto& jpeg : {quick, sharp}) {
    const Received back = read_picture("1234" + std::string(jpeg.begin(), jpeg.end()));
    EXPECT_EQ(back.width, 33);
    EXPECT_EQ(back.height, 17);
    EXPECT_NEAR(back.red, 200, 4);  // rounding of YCbCr
    EXPECT_NEAR(back.green, 100, 4);
    EXPECT_NEAR(back.blue, 50, 4);
  }
  EXPECT_THROW(render::encode_jpeg({0, 0, 3, {}}, 80, false), render::ImageError);
  EXPECT_THROW(render::encode_jpeg({4, 4, 3, {1, 2}}, 80, false), render::ImageError);
}

/// The pictures that come within some seconds.
std::vector<Received> pictures(WebClient& page, double seconds) {
  std::vector<Received> result;
  const double end = seconds_now() + seconds;
  while (seconds_now() < end)
    if (const auto frame = page.receive(WebClient::binary, end - seconds_now()))
      result.push_back(read_picture(frame->payload));
  return result;
}

TEST_F(Web, APageIsToldThatATextFieldWaits) {
  start();
  auto page = connect();
  front->set_typing(true);
  bool is_told = false;
  for (int k = 0; k < 4 && !is_told; ++k)
    if (const auto frame = page->receive(WebClient::text, 3))
      is_told = frame->payload.find("\"typing\"") != std::string::npos &&
                frame->payload.find("on") != std::string::npos;
  EXPECT_TRUE(is_told);
}

TEST_F(Web, NoPictureIsSentBeforeAPageAsks) {
  start();
  EXPECT_FALSE(front->is_ready());
  EXPECT_FALSE(front->is_picture_wanted());
  auto page = connect(false);
  EXPECT_FALSE(wait_until([&] { return front->is_ready(); }, 0.2)) << "its size is not known yet";
  page->send_text("s 320 200 2");
  EXPECT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  EXPECT_EQ(front->size().width, 320);
  EXPECT_EQ(front->size().height, 200);
  EXPECT_EQ(front->size().scale, 2);
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == InputEvent::Kind::resize && event.x == 320 && event.y == 200;
  }));
  front->show_image(plain_image(320, 200, 250, 0, 0));
  EXPECT_FALSE(front->is_picture_wanted());
  const auto frame = page->receive(WebClient::binary, 3);
  ASSERT_TRUE(frame);
  EXPECT_NEAR(read_picture(frame->payload).red, 250, 6);
}

TEST_F(Web, TwoPicturesAreOnTheirWayAndThenTheNewest) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  for (int k = 1; k <= 10; ++k) front->show_image(plain_image(64, 64, 20 * k, 0, 0));
  EXPECT_FALSE(front->is_ready());
  EXPECT_EQ(front->pacing().in_flight(), FramePacing::max_in_flight);
  const auto first = pictures(*page, 0.4);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_NEAR(first[0].red, 20, 6);
  EXPECT_NEAR(first[1].red, 40, 6);
  // One has been seen: of the eight that waited the last one comes.
  page->send_text("a " + std::to_string(first[0].number));
  std::optional<ServerFrame> next;
  ASSERT_TRUE(
      wait_until([&] { return (next = page->receive(WebClient::binary, 0.01)).has_value(); }));
  EXPECT_NEAR(read_picture(next->payload).red, 200, 6);
  EXPECT_FALSE(front->is_ready());
  // Twice the same says nothing new.
  page->send_text("a " + std::to_string(first[0].number));
  EXPECT_FALSE(wait_until([&] { return front->is_ready(); }, 0.2));
}

TEST_F(Web, StillPictureBecomesSharpOnceAndIsNeverSentAgain) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  const render::Image image = plain_image(64, 64, 90, 90, 90);
  front->show_image(image);
  std::vector<Received> seen;
  std::thread reader([&] {
    for (const double end = seconds_now() + 1.2; seconds_now() < end;)
      if (const auto frame = page->receive(WebClient::binary, end - seconds_now())) {
        seen.push_back(read_picture(frame->payload));
        page->send_text("a " + std::to_string(seen.back().number));
      }
  });
  for (const double end = seconds_now() + 1.2; seconds_now() < end;) {
    front->show_image(image);
    front->wait(0.05);
  }
  reader.join();
  EXPECT_EQ(seen.size(), 2u);
}

TEST_F(Web, IdleWaitSleeps) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  front->show_image(plain_image(64, 64, 90, 90, 90));
  for (int k = 1; k <= 2; ++k) {
    const auto frame = page->receive(WebClient::binary, 0.01);
    page->send_text("a " + std::to_string(k));
    front->wait(0.4);
  }
  wait_until([] { return false; }, 0.2);
  timespec before{}, after{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
  const double begin = seconds_now();
  EXPECT_TRUE(front->wait(0.7).empty());
  EXPECT_GT(seconds_now() - begin, 0.69);
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
  const double used =
      double(after.tv_sec - before.tv_sec) + 1e-9 * double(after.tv_nsec - before.tv_nsec);
  EXPECT_LT(used, 0.02);  // of 0.7 s: a thread that looks again and again would use all of it
}

TEST_F(Web, WaitEndsWhenSomethingHappens) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  front->show_image(plain_image(64, 64, 1, 1, 1));
  const auto seconds_of_wait = [&](const std::function<void()>& action) {
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      action();
    });
    const double begin = seconds_now();
    front->wait(5);
    const double seconds = seconds_now() - begin;
    other.join();
    return seconds;
  };
  EXPECT_LT(seconds_of_wait([&] { front->wake(); }), 1);
  EXPECT_LT(seconds_of_wait([&] { page->send_text("m 1 1 0"); }), 1);
  // Full, and then there is room again.
  front->show_image(plain_image(64, 64, 2, 2, 2));
  EXPECT_FALSE(front->is_ready());
  EXPECT_LT(seconds_of_wait([&] { page->send_text("a 1"); }), 1);
  // Room that came before wait() began ends the wait too: the program knows only what it was told.
  front->show_image(plain_image(64, 64, 3, 3, 3));
  EXPECT_FALSE(front->is_ready());
  page->send_text("a 2");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_LT(seconds_of_wait([] {}), 0.09);
}

TEST_F(Web, HiddenPageGetsNothing) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  page->send_text("v 0");
  ASSERT_TRUE(wait_until([&] { return !front->is_ready(); }));
  front->show_image(plain_image(64, 64, 100, 0, 0));
  front->show_image(plain_image(64, 64, 0, 100, 0));
  EXPECT_TRUE(pictures(*page, 0.2).empty());
  page->send_text("v 1");
  EXPECT_TRUE(wait_until([&] { return front->pacing().in_flight() == 1; }));
  const auto frame = page->receive(WebClient::binary, 3);
  ASSERT_TRUE(frame);
  EXPECT_NEAR(read_picture(frame->payload).green, 100, 6);
}

TEST_F(Web, ClipboardGoesBothWays) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_ready(); }));
  front->set_clipboard("neve render \"n\xC3\xA9v\xC3\xA9.toml\"\n");
  for (;;) {
    const auto frame = page->receive(WebClient::text, 3);
    ASSERT_TRUE(frame);
    if (frame->payload.find("clipboard") == std::string::npos) continue;
    EXPECT_EQ(frame->payload, "{\"clipboard\":\"neve render \\\"n\xC3\xA9v\xC3\xA9.toml\\\"\\n\"}");
    break;
  }
  EXPECT_EQ(front->clipboard(), "neve render \"n\xC3\xA9v\xC3\xA9.toml\"\n");
  page->send_text("p 0.25\n");
  EXPECT_TRUE(wait_for([](const InputEvent& event) {
    return event.kind == InputEvent::Kind::paste && event.text == "0.25\n";
  }));
  EXPECT_EQ(front->clipboard(), "0.25\n");
}

TEST_F(Web, TitleAndTypingAreToldToEveryViewerAndOnlyWhenTheyChange) {
  start();
  front->set_title("snowball");
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_ready(); }));
  for (int k = 0; k < 5; ++k) {
    front->set_typing(true);
    front->set_title("snowball");
  }
  std::string all;
  while (const auto frame = page->receive(WebClient::text, 0.2)) all += frame->payload;
  EXPECT_EQ(all, "{\"title\":\"snowball\"}{\"typing\":\"on\"}");
}

TEST_F(Web, NewViewerTakesThePlaceOfTheOneBefore) {
  start();
  auto first = connect();
  first->send_text("k 65 1 0");
  ASSERT_TRUE(wait_for_key('A', true));
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  const render::Image image = plain_image(64, 64, 90, 0, 0);
  front->show_image(image);
  auto second = connect();
  EXPECT_TRUE(wait_for_key('A', false)) << "held by a page that is gone";
  EXPECT_EQ(first->close_code(3), app::view::web::close_code::taken);
  // The same picture, but for someone who has not seen it.
  ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
  front->show_image(image);
  EXPECT_TRUE(second->receive(WebClient::binary, 3));
}

TEST_F(Web, EndOfTheProgramIsTold) {
  start();
  auto page = connect();
  ASSERT_TRUE(wait_until([&] { return front->is_ready(); }));
  std::string all;
  int code = 0;
  std::thread reader([&] {
    while (const auto frame = page->receive(3)) {
      if (frame->opcode == WebClient::text) all += frame->payload;
      if (frame->opcode == WebClient::closing)
        code = static_cast<unsigned char>(frame->payload[0]) << 8 |
               static_cast<unsigned char>(frame->payload[1]);
    }
    page->socket().close();
  });
  const double begin = seconds_now();
  front.reset();
  EXPECT_LT(seconds_now() - begin, 1);
  reader.join();
  EXPECT_NE(all.find(R"({"end":"ended"})"), std::string::npos) << all;
  EXPECT_EQ(code, app::view::web::close_code::going_away);
}

}  // namespace
}  // namespace neve::test
