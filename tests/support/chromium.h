#pragma once
/// A real browser without a window, worked by the DevTools protocol as a person works it.
/// https://chromedevtools.github.io/devtools-protocol/

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "app/support/json.h"
#include "render/image/image.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/web_client.h"

extern "C" char** environ;

namespace neve::test {

using app::Json;

inline constexpr const char* no_chromium =
    "no chromium, chromium-browser or google-chrome in PATH (Debian: chromium)";

/// Path of Chromium or Chrome, empty where there is none.
inline std::string find_chromium() {
  const char* const path = std::getenv("PATH");
  for (const char* name :
       {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (std::filesystem::exists(folder + "/" + name)) return folder + "/" + name;
  }
  return {};
}

inline std::string decode_base64(const std::string& text) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (digit < 0) continue;
    bits = bits << 6 | unsigned(digit);
    if ((count += 6) >= 8) bytes += char(bits >> (count -= 8) & 0xFF);
  }
  return bytes;
}

class Chromium {
 public:
  /// Starts it with one empty page. @throws std::runtime_error when it does not come up in time
  Chromium() {
    start();
    connect();
    call("Page.enable");
    call("Runtime.enable");
  }
  ~Chromium() {
    ::kill(process_, SIGTERM);
    // It writes its profile when it ends; nobody needs that.
    for (int k = 0; k < 100 && ::waitpid(process_, nullptr, WNOHANG) == 0; ++k) {
      if (k == 30) ::kill(process_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  Json call(const std::string& method, Json parameters = Json::object()) {
    const int id = ++last_id_;
    page_->send_text(app::to_text({{"id", id}, {"method", method}, {"params", parameters}}, -1));
    for (;;) {
      const auto frame = page_->receive(WebClient::text, 20);
      if (!frame) throw std::runtime_error("Chromium does not answer " + method);
      const Json answer = Json::parse(frame->payload);
      if (answer.value("method", "") == "Runtime.exceptionThrown")
        exceptions += answer["params"]["exceptionDetails"].dump() + "\n";
      if (answer.value("id", 0) != id) continue;
      if (answer.contains("error")) throw std::runtime_error(method + ": " + frame->payload);
      return answer["result"];
    }
  }

  /// The value of an expression, of a promise after it is kept.
  Json evaluate(const std::string& expression) {
    const Json result = call("Runtime.evaluate", {{"expression", expression},
                                                  {"returnByValue", true},
                                                  {"awaitPromise", true},
                                                  {"userGesture", true}});
    if (result.contains("exceptionDetails"))
      throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
    return result["result"].contains("value") ? result["result"]["value"] : Json();
  }

  void open(const std::string& address) { call("Page.navigate", {{"url", address}}); }

  /// The window's size in CSS pixels, and how many pixels of the screen one of them is.
  void resize(int width, int height, double ratio = 1) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", ratio}, {"mobile", false}});
  }

  /// @param type mouseMoved, mousePressed, mouseReleased
  /// @param button left, right, middle; none while only moving
  /// @param held bits of the buttons that are down: 1 left, 2 right, 4 middle
  void mouse(const std::string& type, double x, double y, const std::string& button = "none",
             int held = 0) {
    call("Input.dispatchMouseEvent", {{"type", type},
                                      {"x", x},
                                      {"y", y},
                                      {"button", button},
                                      {"buttons", held},
                                      {"clickCount", type == "mouseMoved" ? 0 : 1}});
  }
  void click(double x, double y, const std::string& button = "left") {
    const int bit = button == "left" ? 1 : button == "right" ? 2 : 4;
    mouse("mouseMoved", x, y);
    mouse("mousePressed", x, y, button, bit);
    mouse("mouseReleased", x, y, button);
  }
  void drag(double x0, double y0, double x1, double y1, int steps = 8) {
    mouse("mouseMoved", x0, y0);
    mouse("mousePressed", x0, y0, "left", 1);
    for (int k = 1; k <= steps; ++k)
      mouse("mouseMoved", x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps, "left", 1);
    mouse("mouseReleased", x1, y1, "left");
  }
  /// Fingers on a touch screen: where each of them is now.
  /// @param type touchStart, touchMove, touchEnd
  void touch(const std::string& type, const std::vector<std::pair<double, double>>& fingers) {
    Json points = Json::array();
    for (std::size_t k = 0; k < fingers.size(); ++k)
      points.push_back({{"x", fingers[k].first}, {"y", fingers[k].second}, {"id", k}});
    call("Input.dispatchTouchEvent", {{"type", type}, {"touchPoints", points}});
  }
  void wheel(double x, double y, double right, double down, int modifiers = 0) {
    call("Input.dispatchMouseEvent", {{"type", "mouseWheel"},
                                      {"x", x},
                                      {"y", y},
                                      {"deltaX", right},
                                      {"deltaY", down},
                                      {"modifiers", modifiers}});
  }

  /// Presses a key, or lets it go.
  /// @param name KeyboardEvent.key, @param code KeyboardEvent.code, @param number of the key on
  /// Windows, @param modifiers 1 alt, 2 ctrl, 4 meta, 8 shift
  void key(bool is_down, const std::string& name, const std::string& code, int number,
           int modifiers = 0, const std::string& command = {}) {
    const bool has_text = is_down && name.size() == 1 && (modifiers & 7) == 0;
    Json parameters = {{"type", !is_down   ? "keyUp"
                                : has_text ? "keyDown"
                                           : "rawKeyDown"},
                       {"key", name},
                       {"code", code},
                       {"windowsVirtualKeyCode", number},
                       {"modifiers", modifiers}};
    if (has_text) parameters["text"] = name;
    if (!command.empty()) parameters["commands"] = Json::array({command});
    call("Input.dispatchKeyEvent", parameters);
  }
  void type_letter(char c) {
    const char upper = c >= 'a' && c <= 'z' ? char(c - 32) : c;
    const std::string code = c == '.'               ? "Period"
                             : c >= '0' && c <= '9' ? "Digit" + std::string(1, c)
                                                    : "Key" + std::string(1, upper);
    const int number = c == '.' ? 190 : upper;
    key(true, std::string(1, c), code, number);
    key(false, std::string(1, c), code, number);
  }

  render::Image screenshot(const std::string& file = {}) {
    const std::string png =
        decode_base64(call("Page.captureScreenshot", {{"format", "png"}})["data"]);
    if (!file.empty()) std::ofstream(file, std::ios::binary) << png;
    return render::decode_png({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()});
  }

  std::string exceptions;  ///< that no script of the page caught

 private:
  void start() {
    std::vector<std::string> words = {find_chromium(),
                                      "--headless",
                                      "--no-sandbox",
                                      "--disable-gpu",
                                      "--disable-dev-shm-usage",
                                      "--no-first-run",
                                      "--no-default-browser-check",
                                      "--disable-background-networking",
                                      "--disable-component-update",
                                      "--disable-sync",
                                      "--disable-extensions",
                                      "--no-proxy-server",
                                      "--user-data-dir=" + (folder_ / "profile").string(),
                                      "--remote-debugging-port=0",
                                      "--window-size=1280,800",
                                      "about:blank"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t silence;
    ::posix_spawn_file_actions_init(&silence);
    ::posix_spawn_file_actions_addopen(&silence, 1, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&silence, 2, "/dev/null", O_WRONLY, 0);
    const int failure =
        ::posix_spawn(&process_, words[0].c_str(), &silence, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&silence);
    if (failure != 0) throw std::runtime_error("cannot start " + words[0]);
  }

  void connect() {
    // It tells its port in a file, which may be there before it has a page.
    for (int k = 0; k < 600; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      std::istringstream lines(read_text((folder_ / "profile") / "DevToolsActivePort"));
      int port = 0;
      if (!(lines >> port)) continue;
      const std::string host = "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
      RawSocket socket(port);
      socket.send("GET /json HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n");
      const std::string answer = socket.receive_all(2);
      const std::size_t body = answer.find("\r\n\r\n");
      if (body == std::string::npos) continue;
      const Json pages = Json::parse(answer.substr(body + 4), nullptr, false);
      if (!pages.is_array()) continue;
      for (const Json& page : pages) {
        if (page.value("type", "") != "page") continue;
        const std::string address = page["webSocketDebuggerUrl"];
        page_ = std::make_unique<WebClient>(port, address.substr(address.find("/devtools")), host);
        if (page_->is_open()) return;
      }
    }
    throw std::runtime_error("Chromium did not come up in 30 s");
  }

  TemporaryFolder folder_;
  pid_t process_ = -1;
  std::unique_ptr<WebClient> page_;
  int last_id_ = 0;
};

}  // namespace neve::test
