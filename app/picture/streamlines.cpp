#include "app/picture/streamlines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <unordered_map>

namespace neve::app::picture {

namespace {

using Eigen::Vector2d;

/// A line ends where it comes closer to another one than this share of their distance.
constexpr double closest = 0.5;
constexpr std::size_t max_points = 4000;

/// Points of lines in squares as wide as the lines are apart.
class Neighbours {
 public:
  explicit Neighbours(double width) : width_(width) {}
  void add(const Vector2d& x) { squares_[key(x, 0, 0)].push_back(x); }
  bool has_within(const Vector2d& x, double distance) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        const auto square = squares_.find(key(x, i, j));
        if (square == squares_.end()) continue;
        for (const Vector2d& other : square->second)
          if ((other - x).norm() < distance) return true;
      }
    return false;
  }

 private:
  std::int64_t key(const Vector2d& x, int i, int j) const {
    const auto square = [&](double at) { return static_cast<std::int64_t>(std::floor(at)); };
    return ((square(x.x() / width_) + i) << 32) + square(x.y() / width_) + j;
  }
  double width_;
  std::unordered_map<std::int64_t, std::vector<Vector2d>> squares_;
};

class Tracer {
 public:
  Tracer(const PlaneField& field, const StreamlineStyle& style)
      : field_(field), style_(style), lines_(style.distance) {}

  /// Adds the line through a place that is far enough from all others.
  void try_from(const Vector2d& seed) {
    if (!is_inside(seed) || lines_.has_within(seed, style_.distance * 0.999) || !along(seed))
      return;
    Streamline line = half(seed, -1);
    std::reverse(line.begin(), line.end());
    line.push_back(seed);
    const Streamline ahead = half(seed, 1);
    line.insert(line.end(), ahead.begin(), ahead.end());
    if (static_cast<double>(line.size() - 1) * style_.step < style_.shortest) return;
    for (const Vector2d& x : line) lines_.add(x);
    queue_.push_back(found_.size());
    found_.push_back(std::move(line));
  }

  /// Adds lines beside the found ones, until no room is left.
  void fill() {
    for (; !queue_.empty(); queue_.pop_front()) {
      const auto every =
          static_cast<std::size_t>(std::max(1.0, std::round(0.5 * style_.distance / style_.step)));
      const Streamline line = found_[queue_.front()];
      for (std::size_t k = 0; k < line.size(); k += every)
        if (const auto way = along(line[k])) {
          const Vector2d aside = style_.distance * Vector2d(-way->y(), way->x());
          try_from(line[k] + aside);
          try_from(line[k] - aside);
        }
    }
  }

  std::vector<Streamline> take() { return std::move(found_); }

 private:
  bool is_inside(const Vector2d& x) const {
    return (x - style_.low).minCoeff() >= 0 && (style_.high - x).minCoeff() >= 0;
  }
  std::optional<Vector2d> along(const Vector2d& x) const {
    const std::optional<Vector2d> value = field_(x);
    const double size = value ? value->norm() : 0;
    if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
    return *value / size;
  }
  /// Traces a line with the field (1) or against it (-1) by the midpoint rule, without its seed.
  Streamline half(const Vector2d& seed, double sign) const {
    Streamline line;
    Vector2d x = seed;
    while (line.size() < max_points) {
      const auto here = along(x);
      const auto way = here ? along(x + 0.5 * sign * style_.step * *here) : std::nullopt;
      if (!way) break;
      x += sign * style_.step * *way;
      if (!is_inside(x) || !along(x)) break;
      if (lines_.has_within(x, closest * style_.distance)) break;
      // A closed line ends where it began.
      if (static_cast<double>(line.size()) * style_.step > 2 * style_.distance &&
          (x - seed).norm() < closest * style_.distance)
        break;
      line.push_back(x);
    }
    return line;
  }

  const PlaneField& field_;
  const StreamlineStyle& style_;
  Neighbours lines_;
  std::vector<Streamline> found_;
  std::deque<std::size_t> queue_;
};

}  // namespace

std::vector<Streamline> streamlines(const PlaneField& field, const StreamlineStyle& style) {
  Tracer tracer(field, style);
  const Vector2d size = style.high - style.low;
  const auto count = [&](double extent) {
    return std::max(1.0, std::floor(extent / style.distance));
  };
  // Seeds in rows are as good as seeds from the middle outwards, and need no order of their own.
  for (double j = 0; j < count(size.y()); ++j)
    for (double i = 0; i < count(size.x()); ++i) {
      tracer.try_from(style.low + style.distance * Vector2d(i + 0.5, j + 0.5));
      tracer.fill();
    }
  return tracer.take();
}

}  // namespace neve::app::picture
