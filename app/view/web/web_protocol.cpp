#include "app/view/web/web_protocol.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "app/support/json.h"

namespace neve::app::view::web {
namespace {

constexpr double far = 100000;  ///< px: a drag may leave the picture; so far it is nowhere
constexpr double max_notches = 20;

/// The numbers of "m 12 34.5 0", split by single blanks: exactly so many, all finite.
template <std::size_t count>
std::optional<std::array<double, count>> read_numbers(std::string_view text) {
  std::array<double, count> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (double& number : numbers) {
    if (at == end || *at != ' ') return {};
    const auto [stop, error] = std::from_chars(at + 1, end, number);
    if (error != std::errc() || !std::isfinite(number)) return {};
    at = stop;
  }
  if (at != end) return {};
  return numbers;
}

bool is_whole(double number, double least, double most) {
  return number >= least && number <= most && number == std::floor(number);
}

frontend::Modifiers modifiers_of(double bits) {
  const int set = int(bits);
  return {bool(set & 1), bool(set & 2), bool(set & 4), bool(set & 8)};
}

/// The part that the messages of pointer and keys have in common.
PageMessage event_of(frontend::InputEvent::Kind kind, double modifiers) {
  PageMessage message;
  if (!is_whole(modifiers, 0, 15)) return message;
  message.kind = PageMessage::Kind::event;
  message.event.kind = kind;
  message.event.held = modifiers_of(modifiers);
  return message;
}

void set_place(frontend::InputEvent& event, double x, double y) {
  event.x = float(std::clamp(x, -far, far));
  event.y = float(std::clamp(y, -far, far));
}

PageMessage read_move(std::string_view text) {
  const auto n = read_numbers<3>(text);  // x, y, modifiers
  if (!n) return {};
  PageMessage message = event_of(frontend::InputEvent::Kind::move, (*n)[2]);
  set_place(message.event, (*n)[0], (*n)[1]);
  return message;
}

PageMessage read_button(std::string_view text) {
  const auto n = read_numbers<5>(text);  // button, is down, x, y, modifiers
  if (!n || !is_whole((*n)[0], 0, 2) || !is_whole((*n)[1], 0, 1)) return {};
  PageMessage message = event_of(frontend::InputEvent::Kind::button, (*n)[4]);
  message.event.button = int((*n)[0]);
  message.event.is_down = (*n)[1] != 0;
  set_place(message.event, (*n)[2], (*n)[3]);
  return message;
}

PageMessage read_wheel(std::string_view text) {
  const auto n = read_numbers<3>(text);  // notches to the right, up, modifiers
  if (!n) return {};
  PageMessage message = event_of(frontend::InputEvent::Kind::wheel, (*n)[2]);
  message.event.x = float(std::clamp((*n)[0], -max_notches, max_notches));
  message.event.y = float(std::clamp((*n)[1], -max_notches, max_notches));
  return message;
}

bool is_key(double number) {
  if (!is_whole(number, ' ', frontend::key::last)) return false;
  return number <= '~' ? !(number >= 'a' && number <= 'z') : number >= frontend::key::escape;
}

PageMessage read_key(std::string_view text) {
  const auto n = read_numbers<3>(text);  // key, is down, modifiers
  if (!n || !is_key((*n)[0]) || !is_whole((*n)[1], 0, 1)) return {};
  PageMessage message = event_of(frontend::InputEvent::Kind::key, (*n)[2]);
  message.event.key = int((*n)[0]);
  message.event.is_down = (*n)[1] != 0;
  return message;
}

PageMessage read_text(std::string_view text, frontend::InputEvent::Kind kind) {
  if (text.size() < 2 || text[0] != ' ') return {};
  PageMessage message = event_of(kind, 0);
  message.event.text = text.substr(1);
  return message;
}

PageMessage read_size(std::string_view text) {
  const auto n = read_numbers<3>(text);  // width, height, pixels per point
  if (!n) return {};
  PageMessage message;
  message.kind = PageMessage::Kind::size;
  message.size.width = int(std::clamp((*n)[0], 1.0, far));
  message.size.height = int(std::clamp((*n)[1], 1.0, far));
  message.size.scale = float((*n)[2]);
  message.size = limited_size(message.size);
  return message;
}

PageMessage read_shown(std::string_view text) {
  const auto n = read_numbers<1>(text);
  if (!n || !is_whole((*n)[0], 0, 0xFFFFFFFFu)) return {};
  PageMessage message;
  message.kind = PageMessage::Kind::shown;
  message.number = std::uint32_t((*n)[0]);
  return message;
}

PageMessage read_visible(std::string_view text) {
  const auto n = read_numbers<1>(text);
  if (!n || !is_whole((*n)[0], 0, 1)) return {};
  PageMessage message;
  message.kind = PageMessage::Kind::visible;
  message.is_visible = (*n)[0] != 0;
  return message;
}

}  // namespace

frontend::ScreenSize limited_size(frontend::ScreenSize size) {
  size.width = std::clamp(size.width, 64, 16384);
  size.height = std::clamp(size.height, 64, 16384);
  size.scale = std::clamp(size.scale, 0.25f, 8.0f);
  const double pixels = double(size.width) * size.height;
  if (pixels > max_web_pixels) {
    const double share = std::sqrt(max_web_pixels / pixels);
    size.width = std::max(64, int(size.width * share));
    size.height = std::max(64, int(size.height * share));
    size.scale = std::max(0.25f, float(size.scale * share));
  }
  return size;
}

PageMessage read_page_message(std::string_view text) {
  if (text.empty()) return {};
  const std::string_view rest = text.substr(1);
  switch (text[0]) {
    case 'm':
      return read_move(rest);
    case 'b':
      return read_button(rest);
    case 'w':
      return read_wheel(rest);
    case 'k':
      return read_key(rest);
    case 't':
      return read_text(rest, frontend::InputEvent::Kind::text);
    case 'p':
      return read_text(rest, frontend::InputEvent::Kind::paste);
    case 's':
      return read_size(rest);
    case 'a':
      return read_shown(rest);
    case 'v':
      return read_visible(rest);
    default:
      return {};
  }
}

std::string page_text(const char* key, const std::string& value) {
  return to_text(Json{{key, value}}, -1);
}

std::string page_picture(std::uint32_t number, std::string_view jpeg) {
  std::string bytes;
  bytes.reserve(4 + jpeg.size());
  for (int k = 0; k < 4; ++k) bytes += char(number >> (8 * k) & 0xFF);
  return bytes.append(jpeg);
}

}  // namespace neve::app::view::web
