#pragma once
/// neve view --web as a program, with its viewers.

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/web_client.h"

namespace neve::test {

class WebView : public Cli {
 protected:
  ~WebView() override {
    if (program_ > 0) {
      ::kill(program_, SIGKILL);
      wait_for(program_);
    }
  }

  void start(const std::vector<std::string>& more = {}) {
    std::string line = "exec \"$0\" view scene.toml --web --json --out viewed --size 640x400";
    for (const std::string& word : more) line += " " + word;
    program_ = start_program({"/bin/bash", "-c", "cd \"$1\" && " + line + " >told 2>said",
                              NEVE_BINARY, folder.path().string()});
    ASSERT_TRUE(wait_for_text(folder / "told"));
    for (int k = 0; k < 100 && !contains(read_text(folder / "told"), "}"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const app::Json told = json_of("told");
    port_ = told["port"].get<int>();
    const auto url = told["url"].get<std::string>();
    token_ = url.substr(url.find('?'));
  }
  std::unique_ptr<WebClient> connect() {
    const std::string host = "127.0.0.1:" + std::to_string(port_);
    auto page = std::make_unique<WebClient>(
        port_, "/ws" + token_, "Host: " + host + "\r\nOrigin: http://" + host + "\r\n");
    EXPECT_TRUE(page->is_open()) << page->answer();
    page->send_text("s 640 400 1");
    return page;
  }
  /// Sends ctrl+S. @return s until the scene is saved; pictures are confirmed meanwhile
  double seconds_to_save(WebClient& page) {
    const std::filesystem::path saved = folder / "viewed/scene.toml";
    std::filesystem::remove(saved);
    const auto begin = std::chrono::steady_clock::now();
    for (const char* message : {"k 341 1 1", "k 83 1 1", "k 83 0 1", "k 341 0 0"})
      page.send_text(message);
    while (std::chrono::steady_clock::now() - begin < std::chrono::seconds(20)) {
      if (std::filesystem::exists(saved)) break;
      if (const auto picture = page.receive(WebClient::binary, 0.02)) confirm(page, *picture);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  static void confirm(WebClient& page, const ServerFrame& picture) {
    std::uint32_t number = 0;
    if (picture.payload.size() >= 4) std::memcpy(&number, picture.payload.data(), 4);
    page.send_text("a " + std::to_string(number));
  }
  double resident_bytes() const {
    std::ifstream file("/proc/" + std::to_string(program_) + "/statm");
    double all = 0, resident = 0;
    file >> all >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
  }
  bool is_alive() const {
    return ::kill(program_, 0) == 0 && ::waitpid(program_, nullptr, WNOHANG) == 0;
  }

  /// Mouse, keys, texts and sizes at random, pictures confirmed as they come.
  void send_anything(WebClient& page, int count, std::uint32_t seed);

  pid_t program_ = -1;
  int port_ = 0;
  std::string token_;
};

inline void WebView::send_anything(WebClient& page, int count, std::uint32_t seed) {
  std::uint32_t state = seed;
  const auto random = [&](std::uint32_t below) {
    state = state * 1664525 + 1013904223;
    return (state >> 8) % below;
  };
  for (int k = 0; k < count; ++k) {
    const std::string x = std::to_string(random(640)), y = std::to_string(random(400));
    const std::string down = std::to_string(random(2)), mods = std::to_string(random(4));
    switch (random(6)) {
      case 0:
        page.send_text("m " + x + " " + y + " " + mods);
        break;
      case 1:
        page.send_text("b 0 1 " + x + " " + y + " " + mods);
        page.send_text("b 0 0 " + x + " " + y + " " + mods);
        break;
      case 2:
        page.send_text("w 0 " + std::to_string(random(5)) + " " + mods);
        break;
      case 3:
        page.send_text("k " + std::to_string(32 + random(310)) + " " + down + " " + mods);
        break;
      case 4:
        page.send_text("t " + std::to_string(random(100'000'000)));
        break;
      default:
        page.send_text("s " + std::to_string(200 + random(900)) + " " +
                       std::to_string(200 + random(700)) + " 1");
    }
    if (const auto picture = page.receive(WebClient::binary, 0.02)) confirm(page, *picture);
  }
}

}  // namespace neve::test
