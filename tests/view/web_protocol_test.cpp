#include "app/view/web/web_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/view/frontend/event_queue.h"
#include "app/view/web/frame_pacing.h"

namespace neve::app {
namespace {

using PageKind = app::view::web::PageMessage::Kind;

TEST(PageMessage, PageMessageIsAnInputEvent) {
  const app::view::frontend::InputEvent move =
      app::view::web::read_page_message("m 12.5 -3 3").event;
  EXPECT_EQ(move.kind, app::view::frontend::InputEvent::Kind::move);
  EXPECT_EQ(move.x, 12.5f);
  EXPECT_EQ(move.y, -3.0f);
  EXPECT_TRUE(move.held.ctrl && move.held.shift && !move.held.alt && !move.held.super);

  const app::view::frontend::InputEvent button =
      app::view::web::read_page_message("b 2 1 7 8 4").event;
  EXPECT_EQ(button.kind, app::view::frontend::InputEvent::Kind::button);
  EXPECT_EQ(button.button, 2);
  EXPECT_TRUE(button.is_down && button.held.alt);
  EXPECT_EQ(button.y, 8.0f);

  const app::view::frontend::InputEvent wheel =
      app::view::web::read_page_message("w 0 -500 0").event;
  EXPECT_EQ(wheel.kind, app::view::frontend::InputEvent::Kind::wheel);
  EXPECT_EQ(wheel.y, -20.0f);  // nobody turns it further in one event

  const app::view::frontend::InputEvent key = app::view::web::read_page_message("k 265 1 8").event;
  EXPECT_EQ(key.kind, app::view::frontend::InputEvent::Kind::key);
  EXPECT_EQ(key.key, app::view::frontend::key::up);
  EXPECT_TRUE(key.is_down && key.held.super);

  EXPECT_EQ(app::view::web::read_page_message("t n\xC3\xA9v\xC3\xA9").event.text,
            "n\xC3\xA9v\xC3\xA9");
  EXPECT_EQ(app::view::web::read_page_message("p two\nlines").event.kind,
            app::view::frontend::InputEvent::Kind::paste);
  EXPECT_EQ(app::view::web::read_page_message("p two\nlines").event.text, "two\nlines");
  EXPECT_EQ(app::view::web::read_page_message("a 4294967295").number, 4294967295u);
  EXPECT_FALSE(app::view::web::read_page_message("v 0").is_visible);
}

TEST(PageMessage, MeaninglessPageMessageIsIgnored) {
  for (const char* text : {"",          "m",           "m ",           "m 1 2",
                           "m 1 2 3 4", "m  1 2 3",    "m 1 2 16",     "m 1 2 -1",
                           "m 1 2 0.5", "m nan 2 0",   "m inf 2 0",    "m 1e999 2 0",
                           "m 1 2 0 ",  "b 3 1 0 0 0", "b 0 2 0 0 0",  "b 0 1 0 0",
                           "k 31 1 0",  "k 97 1 0",    "k 127 1 0",    "k 255 1 0",
                           "k 349 1 0", "k 65 1",      "k 65.5 1 0",   "t",
                           "t ",        "tx",          "p ",           "s 1 2",
                           "s nan 1 1", "a -1",        "a 4294967296", "a 1.5",
                           "v 2",       "v",           "x 1 2 3",      "M 1 2 3",
                           "\n"})
    EXPECT_EQ(app::view::web::read_page_message(text).kind, PageKind::none) << text;
}

TEST(PageMessage, PageMessageSurvivesRandomText) {
  std::mt19937 random(11);
  const std::string alphabet = "mbwktpsav 0123456789.-+einfx\n";
  for (int run = 0; run < 50000; ++run) {
    std::string text(random() % 24, ' ');
    for (char& c : text) c = alphabet[random() % alphabet.size()];
    const app::view::web::PageMessage message = app::view::web::read_page_message(text);
    EXPECT_TRUE(std::isfinite(message.event.x) && std::isfinite(message.event.y)) << text;
    EXPECT_LE(double(message.size.width) * message.size.height, app::view::web::max_web_pixels)
        << text;
  }
}

TEST(PageSize, PageSizeStaysInItsLimits) {
  const app::view::frontend::ScreenSize usual =
      app::view::web::read_page_message("s 1280 800 1.5").size;
  EXPECT_EQ(usual.width, 1280);
  EXPECT_EQ(usual.height, 800);
  EXPECT_EQ(usual.scale, 1.5f);
  // A screen of 8K keeps its shape with a quarter of its pixels, and its panels keep their size.
  const app::view::frontend::ScreenSize huge =
      app::view::web::read_page_message("s 7680 4320 2").size;
  EXPECT_LE(double(huge.width) * huge.height, app::view::web::max_web_pixels);
  EXPECT_GT(double(huge.width) * huge.height, 0.99 * app::view::web::max_web_pixels);
  EXPECT_NEAR(double(huge.width) / huge.height, 16.0 / 9, 0.01);
  EXPECT_NEAR(huge.scale, 1.0, 0.01);
  for (const char* text : {"s -5 0 0", "s 1e30 1e30 1e30", "s 1 1e9 -1", "s 32768 64 1"}) {
    const app::view::frontend::ScreenSize size = app::view::web::read_page_message(text).size;
    EXPECT_GE(size.width, 64) << text;
    EXPECT_GE(size.height, 64) << text;
    EXPECT_LE(double(size.width) * size.height, app::view::web::max_web_pixels) << text;
    EXPECT_GE(size.scale, 0.25f) << text;
  }
}

TEST(PageText, PageTextIsAlwaysJson) {
  EXPECT_EQ(app::view::web::page_text("title", "a \"b\"\n"), R"({"title":"a \"b\"\n"})");
  EXPECT_EQ(app::view::web::page_text("title", "\xFF"), "{\"title\":\"\xEF\xBF\xBD\"}");
  EXPECT_EQ(app::view::web::page_picture(0x01020304, "jpeg"), "\x04\x03\x02\x01jpeg");
}

app::view::frontend::InputEvent event_of(const char* text) {
  return app::view::web::read_page_message(text).event;
}

TEST(EventQueue, EventQueueJoinsMovesAndWheels) {
  app::view::frontend::EventQueue queue;
  for (const char* text : {"m 1 1 0", "m 2 2 0", "m 3 3 1", "w 0 1 0", "w 0 2 0", "b 0 1 3 3 0",
                           "m 4 4 0", "m 5 5 0", "t a", "t b"})
    EXPECT_TRUE(queue.push(event_of(text)));
  const auto events = queue.take();
  ASSERT_EQ(events.size(), 7u);  // m, m with ctrl, w, b, m, t, t
  EXPECT_EQ(events[0].x, 2);
  EXPECT_EQ(events[2].y, 3);
  EXPECT_EQ(events[4].x, 5);
  EXPECT_TRUE(queue.empty());
}

TEST(EventQueue, EventQueueRefusesMoreThanItHolds) {
  app::view::frontend::EventQueue queue;
  std::size_t taken = 0;
  while (queue.push(event_of(taken % 2 ? "k 65 0 0" : "k 65 1 0"))) ++taken;
  EXPECT_EQ(taken, app::view::frontend::EventQueue::limit);
  EXPECT_EQ(queue.take().size(), app::view::frontend::EventQueue::limit);

  const std::string pasted = "p " + std::string(200000, 'x');
  for (taken = 0; queue.push(event_of(pasted.c_str())); ++taken)
    ;
  EXPECT_EQ(taken, app::view::frontend::EventQueue::text_limit / 200000);
  queue.take();
  EXPECT_TRUE(queue.push(event_of(pasted.c_str())));
}

TEST(EventQueue, EventQueueReleasesHeldKeysAndButtons) {
  app::view::frontend::EventQueue queue;
  for (const char* text : {"k 65 1 0", "k 66 1 0", "k 65 0 0", "b 0 1 7 8 0", "k 341 1 1"})
    queue.push(event_of(text));
  queue.take();
  queue.release_all();
  queue.release_all();
  const auto events = queue.take();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].kind, app::view::frontend::InputEvent::Kind::button);
  EXPECT_EQ(events[0].x, 7);  // where it was, so that a drag ends there
  EXPECT_EQ(events[1].key, 66);
  EXPECT_EQ(events[2].key, app::view::frontend::key::ctrl);
  for (const app::view::frontend::InputEvent& event : events) EXPECT_FALSE(event.is_down);
}

TEST(EventQueue, EventQueueDropsTheEventsOfAViewerThatLeaves) {
  app::view::frontend::EventQueue queue;
  for (const char* text : {"k 65 1 0", "k 66 1 0", "k 66 0 0", "p pasted"})
    queue.push(event_of(text));
  EXPECT_FALSE(queue.has_left());
  queue.leave();
  EXPECT_TRUE(queue.has_left());
  queue.push(event_of("k 67 1 0"));
  const auto events = queue.take();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].kind, app::view::frontend::InputEvent::Kind::gone);
  EXPECT_EQ(events[1].key, 65);
  EXPECT_FALSE(events[1].is_down);
  EXPECT_EQ(events[2].key, 67);
}

/// Sends and shows pictures one after the other. @return the quality after them
int quality_after(int pictures, double seconds_each) {
  app::view::web::FramePacing pacing;
  double now = 100;
  for (int k = 0; k < pictures; ++k) {
    const std::uint32_t number = pacing.sent(now);
    now += seconds_each;
    EXPECT_TRUE(pacing.shown(number, now));
  }
  return pacing.quality();
}

TEST(FramePacing, FramePacingAdaptsQualityToTheNetwork) {
  EXPECT_EQ(quality_after(100, 0.01), app::view::web::FramePacing::max_quality);
  EXPECT_EQ(quality_after(100, 0.3), app::view::web::FramePacing::min_quality);
  // The quality stays as it is between the two.
  EXPECT_EQ(quality_after(100, 0.09), app::view::web::FramePacing().quality());
}

TEST(FramePacing, FramePacingLetsTwoPicturesOnTheirWay) {
  app::view::web::FramePacing pacing;
  const std::uint32_t first = pacing.sent(1), second = pacing.sent(1);
  EXPECT_FALSE(pacing.can_send());
  EXPECT_FALSE(pacing.shown(second + 1, 2));
  EXPECT_FALSE(pacing.can_send());
  EXPECT_TRUE(pacing.shown(first, 2));
  EXPECT_FALSE(pacing.shown(first, 2));
  EXPECT_EQ(pacing.in_flight(), 1);
  // Pictures in flight to the previous viewer say nothing about the next one's.
  pacing.reset();
  EXPECT_EQ(pacing.in_flight(), 0);
  EXPECT_FALSE(pacing.shown(second, 3));
  EXPECT_GT(pacing.sent(3), second);
}

}  // namespace
}  // namespace neve::app
