#pragma once
/// `neve view` in a web page: pictures go out as JPEG over a web socket, input comes back.

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "app/view/frontend/event_queue.h"
#include "app/view/frontend/frontend.h"
#include "app/view/web/frame_pacing.h"
#include "app/view/web/web_server.h"
#include "render/image/image.h"

namespace neve::app::view::web {

struct PageMessage;

struct WebOptions {
  std::string address = "127.0.0.1";        ///< a number, or localhost
  int port = 0;                             ///< 0: a free one
  std::string public_url{};                 ///< of a proxy that shows the page; empty: none
  frontend::ScreenSize size{1280, 800, 1};  ///< until a page connects
  /// The user has seen risk_of(address) and accepts it.
  bool is_risk_taken = false;
  WebLimits limits{};
};

/// Only one page is connected at a time: the one opened last. All but where(), wake() and the
/// destructor belong to one thread, the program's; the server's thread only fills queues.
class WebFrontend final : public frontend::Frontend, private WebListener {
 public:
  /// @throws Error when the build has no JPEG or the address is reached by others and nobody took
  /// the risk; IoError when it cannot be listened at
  explicit WebFrontend(const WebOptions& options);
  ~WebFrontend() override;

  std::string where() const override;
  int port() const { return server_.port(); }
  const std::string& token() const { return guard_.token(); }

  frontend::ScreenSize size() const override;
  std::vector<frontend::InputEvent> wait(double seconds) override;
  void hold_input(bool is_held) override;
  void wake() override;
  bool is_ready() const override;
  bool is_picture_wanted() const override;
  void show(render::Screen& screen) override;
  bool takes_files() const override { return true; }
  void offer(const std::filesystem::path& folder, const std::filesystem::path& file) override;
  void set_clipboard(const std::string& text) override;
  std::string clipboard() const override;

  /// Shows a picture; of several that have to wait only the newest is ever sent. While nothing
  /// changes it is sent once more in full quality, by wait().
  void show_image(render::Image image);

  void set_typing(bool is_wanted) override;
  void set_scrolling(const std::vector<frontend::ScrollPlace>& places) override;
  /// Sets the title of the page, shown in the browser's tab.
  void set_title(const std::string& title);

  /// Pacing of the current page, for measurements.
  FramePacing pacing() const;

 private:
  enum class Sent { nothing, quick, sharp };

  void on_viewer(std::uint64_t viewer) override;
  void on_gone(std::uint64_t viewer) override;
  bool on_message(std::uint64_t viewer, std::string_view text) override;
  void on_all_sent() override;
  bool apply(const PageMessage& message);

  bool is_ready_now() const;
  bool gives_events() const;
  bool has_news() const;
  bool is_sharp_due(double now) const;
  void send_what_is_due(std::unique_lock<std::mutex>& lock);
  void send_picture(std::unique_lock<std::mutex>& lock, bool is_sharp);
  void tell(const std::string& text);

  const WebOptions options_;
  const WebGuard guard_;

  mutable std::mutex mutex_;  ///< of all that follows but the picture and the server
  std::condition_variable changed_;
  frontend::EventQueue events_;
  FramePacing pacing_;
  frontend::ScreenSize size_;
  std::string clipboard_, title_ = "neve";
  std::string scrolls_;       ///< "x y width height notch" of each list, between semicolons
  std::uint64_t viewer_ = 0;  ///< 0: no page is connected
  bool has_told_size_ = false, is_visible_ = true;
  bool is_typing_ = false;  ///< a text field waits for input
  bool is_input_held_ = false;
  bool is_wanted_ = false, is_woken_ = false, is_full_ = false;
  mutable bool has_told_ready_ = false;  ///< the last value told to the program
  Sent sent_ = Sent::nothing;            ///< of the picture, to this viewer
  double sent_time_ = 0;

  render::Image image_;  ///< the newest; of the program's thread

  WebServer server_;  ///< last: its thread uses everything above
};

}  // namespace neve::app::view::web
