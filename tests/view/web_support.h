#pragma once
/// A web frontend in this process, pictures to show and a page that is no browser.

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <memory>

#include "app/view/web/web_frontend.h"
#include "tests/support/web_client.h"

namespace neve::test {

inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A picture of one colour.
inline render::Image plain_image(int width, int height, int red, int green, int blue) {
  render::Image image{width, height, 3, {}};
  for (int k = 0; k < width * height; ++k)
    for (const int value : {red, green, blue}) image.pixels.push_back(std::uint8_t(value));
  return image;
}

/// Resident memory of this process, bytes.
inline double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * double(::sysconf(_SC_PAGESIZE));
}

/// A picture as the page gets it.
struct Received {
  std::uint32_t number = 0;
  int width = 0, height = 0;
  int red = 0, green = 0, blue = 0;  ///< in the middle
};

inline Received read_picture(const std::string& payload) {
  Received picture;
  if (payload.size() < 5) return picture;
  std::memcpy(&picture.number, payload.data(), 4);
  int channels = 0;
  stbi_uc* const pixels =
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(payload.data()) + 4,
                            int(payload.size() - 4), &picture.width, &picture.height, &channels, 3);
  if (!pixels) return picture;
  const stbi_uc* middle = pixels + 3 * (picture.height / 2 * picture.width + picture.width / 2);
  picture.red = middle[0];
  picture.green = middle[1];
  picture.blue = middle[2];
  stbi_image_free(pixels);
  return picture;
}

class Web : public testing::Test {
 protected:
  void start(app::view::web::WebOptions options = {}) {
    front = std::make_unique<app::view::web::WebFrontend>(options);
    host = "127.0.0.1:" + std::to_string(front->port());
  }

  std::string own_headers() const {
    return "Host: " + host + "\r\nOrigin: http://" + host + "\r\n";
  }
  std::string target(const std::string& path = "/ws") const {
    return path + "?token=" + front->token();
  }

  /// A page that is connected and, unless told otherwise, has told its size.
  std::unique_ptr<WebClient> connect(bool tells_size = true, int receive_buffer = 0) {
    auto page = std::make_unique<WebClient>(front->port(), target(), own_headers(), receive_buffer);
    EXPECT_TRUE(page->is_open()) << page->answer();
    if (tells_size) page->send_text("s 320 200 1");
    return page;
  }

  /// Everything that is answered to these bytes.
  std::string ask(const std::string& bytes) {
    RawSocket socket(front->port());
    socket.send(bytes);
    return socket.receive_all(3);
  }
  /// Status of a GET with this Host line and perhaps more.
  int status(const std::string& where, const std::string& headers) {
    const std::string answer = ask("GET " + where + " HTTP/1.1\r\n" + headers + "\r\n");
    return answer.size() > 12 ? std::atoi(answer.c_str() + 9) : 0;
  }

  /// Events until the test is content, for some seconds.
  bool wait_until(const std::function<bool()>& is_content, double seconds = 5) {
    const double end = seconds_now() + seconds;
    while (seconds_now() < end) {
      if (is_content()) return true;
      for (auto& event : front->wait(0.02)) events.push_back(std::move(event));
    }
    return is_content();
  }
  bool wait_for(const std::function<bool(const app::view::frontend::InputEvent&)>& is_it,
                double seconds = 5) {
    return wait_until(
        [&] {
          for (const auto& event : events)
            if (is_it(event)) return true;
          return false;
        },
        seconds);
  }
  bool wait_for_key(int key, bool is_down) {
    return wait_for([&](const app::view::frontend::InputEvent& event) {
      return event.kind == app::view::frontend::InputEvent::Kind::key && event.key == key &&
             event.is_down == is_down;
    });
  }

  /// A page can still connect, say something and get a picture.
  void expect_serving() {
    events.clear();
    auto page = connect();
    page->send_text("k 90 1 0");
    EXPECT_TRUE(wait_for_key('Z', true)) << "input does not come";
    ASSERT_TRUE(wait_until([&] { return front->is_picture_wanted(); }));
    front->show_image(plain_image(64, 64, 10, 200, 30));
    const auto frame = page->receive(WebClient::binary, 3);
    ASSERT_TRUE(frame) << "the picture does not come";
    EXPECT_NEAR(read_picture(frame->payload).green, 200, 6);  // JPEG
    page->socket().close();
    wait_until([&] { return !front->is_ready(); });
  }

  std::unique_ptr<app::view::web::WebFrontend> front;
  std::string host;
  std::vector<app::view::frontend::InputEvent> events;
};

}  // namespace neve::test
