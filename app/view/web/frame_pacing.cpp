#include "app/view/web/frame_pacing.h"

#include <algorithm>

namespace neve::app::view::web {
namespace {

/// s. Two pictures on their way at this round trip are about 30 pictures a second.
constexpr double good_round_trip = 0.06;
/// s. From here on a drag feels late.
constexpr double bad_round_trip = 0.12;

}  // namespace

void FramePacing::reset() {
  const std::uint32_t number = next_number_;
  *this = {};
  next_number_ = number;
}

std::uint32_t FramePacing::sent(double now) {
  in_flight_.push_back({next_number_, now});
  return next_number_++;
}

bool FramePacing::shown(std::uint32_t number, double now) {
  const auto found = std::find_if(in_flight_.begin(), in_flight_.end(),
                                  [&](const Picture& picture) { return picture.number == number; });
  if (found == in_flight_.end()) return false;
  const double seconds = now - found->sent;
  in_flight_.erase(found);
  round_trip_ = round_trip_ == 0 ? seconds : 0.7 * round_trip_ + 0.3 * seconds;
  // Down faster than up: a slow network is felt, a little more blur is not.
  if (round_trip_ > bad_round_trip) quality_ -= 4;
  if (round_trip_ < good_round_trip) quality_ += 1;
  quality_ = std::clamp(quality_, double(min_quality), double(max_quality));
  return true;
}

}  // namespace neve::app::view::web
