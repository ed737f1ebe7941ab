#pragma once
/// The pace and the quality of pictures to a browser, so that what is seen is never old: the number
/// of pictures on their way is bounded, and a slow network gets smaller ones.

#include <cstdint>
#include <vector>

namespace neve::app::view::web {

/// Seconds are of a clock that never goes back. The class is not protected against threads.
class FramePacing {
 public:
  static constexpr int max_in_flight = 2;
  static constexpr int min_quality = 60, max_quality = 90, sharp_quality = 92;

  /// A new viewer: nothing is on its way, nothing is known of its network.
  void reset();

  bool can_send() const { return int(in_flight_.size()) < max_in_flight; }
  int in_flight() const { return int(in_flight_.size()); }

  /// @return the number of the picture that is sent now
  std::uint32_t sent(double now);

  /// The browser has shown it. @return false for a picture that was not on its way
  bool shown(std::uint32_t number, double now);

  /// JPEG quality for a picture of many.
  int quality() const { return int(quality_); }

 private:
  struct Picture {
    std::uint32_t number = 0;
    double sent = 0;
  };
  std::vector<Picture> in_flight_;
  std::uint32_t next_number_ = 1;  ///< continues with the next viewer: no number is used twice
  double quality_ = 80;
  double round_trip_ = 0;  ///< s from sending to showing, smoothed; 0 before the first
};

}  // namespace neve::app::view::web
