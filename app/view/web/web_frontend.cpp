#include "app/view/web/web_frontend.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/view/web/web_protocol.h"
#include "render/image/jpeg.h"

namespace neve::app::view::web {
namespace {

/// s without a new picture, after which the last one is worth its full quality.
constexpr double still_seconds = 0.25;

const WebOptions& checked(const WebOptions& options) {
  if (!render::can_encode_jpeg())
    throw Error(exit_usage, "this build cannot show pictures in a browser", {},
                render::jpeg_advice);
  if (const std::string risk = risk_of(options.address); !risk.empty() && !options.is_risk_taken)
    throw Error(exit_usage, risk, options.address);
  return options;
}

WebServerOptions server_options(const WebOptions& options) {
  WebServerOptions result;
  result.address = options.address;
  result.port = options.port;
  result.limits = options.limits;
  result.goodbye = page_text("end", "ended");
  result.replaced = page_text("end", "replaced");
  return result;
}

bool shows_same(const render::Image& a, const render::Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         a.pixels == b.pixels;
}

}  // namespace

WebFrontend::WebFrontend(const WebOptions& options)
    : options_(checked(options)),
      guard_(options.address, make_token(),
             options.public_url.empty() ? PublicPlace{} : public_place(options.public_url)),
      size_(limited_size(options.size)),
      server_(server_options(options), guard_, *this) {}

WebFrontend::~WebFrontend() = default;

std::string WebFrontend::where() const {
  const std::string& address = options_.address;
  const bool is_ipv6 = address.find(':') != std::string::npos;
  // "Every network" is no place to go to; this machine has a name.
  const std::string name = address == "0.0.0.0" || address == "::" ? guard_.machine()
                           : is_ipv6                               ? '[' + address + ']'
                                                                   : address;
  const PublicPlace& place = guard_.place();
  if (!place.origin.empty()) return place.origin + place.path + "?token=" + token();
  return "http://" + name + ':' + std::to_string(port()) + "/?token=" + token();
}

frontend::ScreenSize WebFrontend::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

void WebFrontend::hold_input(bool is_held) {
  const std::lock_guard lock(mutex_);
  is_input_held_ = is_held;
}

/// A page that has left is told at once.
bool WebFrontend::gives_events() const {
  return !events_.empty() && (!is_input_held_ || events_.has_left());
}

void WebFrontend::wake() {
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = true;
  }
  changed_.notify_all();
}

bool WebFrontend::is_ready_now() const {
  // Unsent bytes are in flight too, even if the page has confirmed all pictures.
  return viewer_ != 0 && has_told_size_ && is_visible_ && pacing_.can_send() &&
         server_.unsent(viewer_) < FramePacing::max_in_flight;
}

bool WebFrontend::is_ready() const {
  const std::lock_guard lock(mutex_);
  return has_told_ready_ = is_ready_now();
}

bool WebFrontend::is_picture_wanted() const {
  const std::lock_guard lock(mutex_);
  return is_wanted_ && is_ready_now();
}

bool WebFrontend::has_news() const {
  const bool is_ready = is_ready_now();
  // The last reported value decides, not the value at the beginning of the wait.
  if (!is_ready) has_told_ready_ = false;
  return gives_events() || is_woken_ || (is_ready && (!has_told_ready_ || is_wanted_));
}

bool WebFrontend::is_sharp_due(double now) const {
  return sent_ == Sent::quick && now >= sent_time_ + still_seconds;
}

std::vector<frontend::InputEvent> WebFrontend::wait(double seconds) {
  const double end = clock_seconds() + std::clamp(seconds, 0.0, 1e6);
  std::unique_lock lock(mutex_);
  for (;;) {
    send_what_is_due(lock);
    const double now = clock_seconds();
    if (has_news() || now >= end) break;
    double next = end;
    if (sent_ == Sent::quick && is_ready_now()) next = std::min(next, sent_time_ + still_seconds);
    changed_.wait_for(lock, std::chrono::duration<double>(std::max(0.0, next - now)));
  }
  is_woken_ = false;
  has_told_ready_ = is_ready_now();
  std::vector<frontend::InputEvent> happened;
  bool was_full = false;
  if (gives_events()) {
    happened = events_.take();
    was_full = std::exchange(is_full_, false);
  }
  lock.unlock();
  if (was_full) server_.resume();
  return happened;
}

void WebFrontend::send_what_is_due(std::unique_lock<std::mutex>& lock) {
  if (image_.pixels.empty() || is_wanted_ || !is_ready_now()) return;
  if (sent_ == Sent::nothing)
    send_picture(lock, false);
  else if (is_sharp_due(clock_seconds()))
    send_picture(lock, true);
}

void WebFrontend::send_picture(std::unique_lock<std::mutex>& lock, bool is_sharp) {
  const std::uint64_t to = viewer_;
  const int quality = is_sharp ? FramePacing::sharp_quality : pacing_.quality();
  lock.unlock();
  const std::vector<std::uint8_t> jpeg = render::encode_jpeg(image_, quality, is_sharp);
  lock.lock();
  if (viewer_ != to) return;
  sent_ = is_sharp ? Sent::sharp : Sent::quick;
  sent_time_ = clock_seconds();
  const std::uint32_t number = pacing_.sent(sent_time_);
  const std::string_view bytes(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
  server_.send(to, Opcode::binary, page_picture(number, bytes));
}

void WebFrontend::show_image(render::Image image) {
  std::unique_lock lock(mutex_);
  is_wanted_ = false;
  if (!shows_same(image, image_)) {
    image_ = std::move(image);
    sent_ = Sent::nothing;
  }
  send_what_is_due(lock);
}

void WebFrontend::tell(const std::string& text) {
  server_.send(viewer_, Opcode::text, text);
}

void WebFrontend::offer(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const std::string path = server_.offer(std::make_unique<OpenFile>(folder, file));
  const std::lock_guard lock(mutex_);
  tell(page_text("download", path));
}

void WebFrontend::set_clipboard(const std::string& text) {
  const std::lock_guard lock(mutex_);
  clipboard_ = text;
  tell(page_text("clipboard", text));
}

std::string WebFrontend::clipboard() const {
  const std::lock_guard lock(mutex_);
  return clipboard_;
}

void WebFrontend::set_typing(bool is_wanted) {
  const std::lock_guard lock(mutex_);
  if (is_typing_ == is_wanted) return;
  is_typing_ = is_wanted;
  tell(page_text("typing", is_typing_ ? "on" : "off"));
}

void WebFrontend::set_scrolling(const std::vector<frontend::ScrollPlace>& places) {
  std::string text;
  for (const frontend::ScrollPlace& place : places)
    text += fmt::format("{}{:.0f} {:.0f} {:.0f} {:.0f} {:.0f}", text.empty() ? "" : ";", place.x,
                        place.y, place.width, place.height, place.notch);
  const std::lock_guard lock(mutex_);
  if (scrolls_ == text) return;
  scrolls_ = text;
  tell(page_text("scrolls", scrolls_));
}

void WebFrontend::set_title(const std::string& title) {
  const std::lock_guard lock(mutex_);
  if (title_ == title) return;
  title_ = title;
  tell(page_text("title", title_));
}

FramePacing WebFrontend::pacing() const {
  const std::lock_guard lock(mutex_);
  return pacing_;
}

void WebFrontend::on_viewer(std::uint64_t viewer) {
  {
    const std::lock_guard lock(mutex_);
    viewer_ = viewer;
    pacing_.reset();
    sent_ = Sent::nothing;
    has_told_size_ = false;
    is_visible_ = is_wanted_ = true;
    tell(page_text("title", title_));
    if (is_typing_) tell(page_text("typing", "on"));
    if (!scrolls_.empty()) tell(page_text("scrolls", scrolls_));
  }
  changed_.notify_all();
}

void WebFrontend::on_gone(std::uint64_t) {
  {
    const std::lock_guard lock(mutex_);
    viewer_ = 0;
    is_full_ = false;
    events_.leave();
  }
  changed_.notify_all();
}

bool WebFrontend::on_message(std::uint64_t, std::string_view text) {
  const PageMessage message = read_page_message(text);
  bool is_taken = true;
  {
    const std::lock_guard lock(mutex_);
    is_taken = apply(message);
    is_full_ = is_full_ || !is_taken;
  }
  if (message.kind != PageMessage::Kind::none) changed_.notify_all();
  return is_taken;
}

void WebFrontend::on_all_sent() {
  // A thread about to wait has to be waiting, or it would miss the notification.
  { const std::lock_guard lock(mutex_); }
  changed_.notify_all();
}

/// @return false when there is no room for it
bool WebFrontend::apply(const PageMessage& message) {
  switch (message.kind) {
    case PageMessage::Kind::none:
      return true;
    case PageMessage::Kind::event:
      if (!events_.push(message.event)) return false;
      if (message.event.kind == frontend::InputEvent::Kind::paste) clipboard_ = message.event.text;
      return true;
    case PageMessage::Kind::size: {
      frontend::InputEvent event;
      event.kind = frontend::InputEvent::Kind::resize;
      event.x = float(message.size.width);
      event.y = float(message.size.height);
      if (!events_.push(event)) return false;
      size_ = message.size;
      has_told_size_ = true;
      return true;
    }
    case PageMessage::Kind::shown:
      pacing_.shown(message.number, clock_seconds());
      return true;
    case PageMessage::Kind::visible:
      is_visible_ = message.is_visible;
      return true;
  }
  return true;
}

}  // namespace neve::app::view::web
