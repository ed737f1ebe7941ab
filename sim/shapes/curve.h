#pragma once
/// Monotone curves through values at increasing times: the motion by keyframes of cameras and
/// colliders.

#include <cstddef>
#include <vector>

namespace neve::sim::shapes {

/// A time between two keyframes.
struct CurvePlace {
  std::size_t next = 0;  ///< the first keyframe after the time; 0: before all, their number: after
  double span = 1;       ///< s, between the keyframes around it
  double part = 0;       ///< of the span, [0, 1)

  /// @param times  increasing, at least one
  CurvePlace(const std::vector<double>& times, double time);
  bool is_between(const std::vector<double>& times) const {
    return next > 0 && next < times.size();
  }
};

struct CurveValue {
  double value, slope;  ///< slope per second
};

/// Slope at keyframe k, per second: the weighted harmonic mean of Fritsch and Butland of the slopes
/// before and after it, zero where these disagree in sign, and at the first and the last keyframe.
/// @param before, after  mean slopes of the two spans, per second
double slope_at(const std::vector<double>& times, std::size_t k, double before, double after);

/// The curve through (t[k], x[k]): cubic between keyframes, continuous in value and slope, never
/// beyond the keyframes around a time; at rest at the first and the last, and beyond them.
CurveValue curve_at(const std::vector<double>& times, const std::vector<double>& x,
                    const CurvePlace& place);

}  // namespace neve::sim::shapes
