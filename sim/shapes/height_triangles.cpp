#include <algorithm>
#include <cmath>

#include "sim/shapes/height_field.h"

namespace neve::sim::shapes {
namespace {

class Triangles {
 public:
  Triangles(const HeightField& field, const std::vector<std::size_t>& columns,
            const std::vector<std::size_t>& rows)
      : field_(field), columns_(columns), rows_(rows) {}

  HeightTriangles make() {
    for (std::size_t r = 0; r + 1 < rows_.size(); ++r)
      for (std::size_t c = 0; c + 1 < columns_.size(); ++c) add_cell(c, r);
    add_bottom();
    return std::move(out_);
  }

 private:
  Vec3d post(std::size_t c, std::size_t r) const {
    return {field_.x_of(columns_[c]), field_.height_of(columns_[c], rows_[r]),
            field_.z_of(rows_[r])};
  }
  bool has_ground(std::size_t c, std::size_t r) const {
    return !std::isnan(post(c, r).y() + post(c + 1, r).y() + post(c, r + 1).y() +
                       post(c + 1, r + 1).y());
  }
  bool is_cell(std::size_t c, std::size_t r) const {
    return c + 1 < columns_.size() && r + 1 < rows_.size() && has_ground(c, r);
  }

  std::uint32_t add(const Vec3d& position, const Vec3d& normal) {
    out_.position.push_back(position);
    out_.normal.push_back(normal);
    return static_cast<std::uint32_t>(out_.position.size() - 1);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.index.insert(out_.index.end(), {a, b, c});
  }

  void add_cell(std::size_t c, std::size_t r) {
    if (!has_ground(c, r)) return;
    const Vec3d nw = post(c, r), ne = post(c + 1, r), sw = post(c, r + 1), se = post(c + 1, r + 1);
    const double dx = ne.x() - nw.x(), dz = sw.z() - nw.z();
    const auto normal = [&](double along_x, double along_z) {
      return Vec3d(-along_x / dx, 1, -along_z / dz).normalized();
    };
    const double north = ne.y() - nw.y(), south = se.y() - sw.y(), west = sw.y() - nw.y(),
                 east = se.y() - ne.y();
    const std::uint32_t a = add(nw, normal(north, west)), b = add(ne, normal(north, east)),
                        d = add(se, normal(south, east)), e = add(sw, normal(south, west));
    const std::uint32_t middle =
        add(0.25 * (nw + ne + sw + se), normal(0.5 * (north + south), 0.5 * (west + east)));
    for (const auto& [from, to] : {std::pair{b, a}, {d, b}, {e, d}, {a, e}})
      add_triangle(from, to, middle);
    // A side where the next cell has no ground.
    if (r == 0 || !is_cell(c, r - 1)) add_side(nw, ne, {0, 0, -1});
    if (!is_cell(c, r + 1)) add_side(se, sw, {0, 0, 1});
    if (c == 0 || !is_cell(c - 1, r)) add_side(sw, nw, {-1, 0, 0});
    if (!is_cell(c + 1, r)) add_side(ne, se, {1, 0, 0});
  }

  void add_side(const Vec3d& from, const Vec3d& to, const Vec3d& normal) {
    const double floor = field_.bounds().min.y();
    const std::uint32_t a = add(from, normal), b = add(to, normal),
                        c = add({to.x(), floor, to.z()}, normal),
                        d = add({from.x(), floor, from.z()}, normal);
    add_triangle(a, b, c);
    add_triangle(a, c, d);
  }

  void add_bottom() {
    const Bounds& box = field_.bounds();
    const double floor = box.min.y();
    const Vec3d down(0, -1, 0);
    const std::uint32_t a = add({box.min.x(), floor, box.min.z()}, down),
                        b = add({box.max.x(), floor, box.min.z()}, down),
                        c = add({box.max.x(), floor, box.max.z()}, down),
                        d = add({box.min.x(), floor, box.max.z()}, down);
    add_triangle(a, b, c);
    add_triangle(a, c, d);
  }

  const HeightField& field_;
  const std::vector<std::size_t>&columns_, &rows_;
  HeightTriangles out_;
};

/// Adds posts from a stretch outward, step by step wider.
void add_outward(std::size_t from, std::size_t count, bool is_up, double step, double growth,
                 std::vector<std::size_t>& posts) {
  double at = static_cast<double>(from);
  const double last = static_cast<double>(count - 1);
  while (is_up ? at < last : at > 0) {
    step *= growth;
    at = is_up ? std::min(at + step, last) : std::max(at - step, 0.0);
    posts.push_back(static_cast<std::size_t>(std::llround(at)));
  }
}

}  // namespace

HeightTriangles triangles_of(const HeightField& field, const std::vector<std::size_t>& columns,
                             const std::vector<std::size_t>& rows) {
  return Triangles(field, columns, rows).make();
}

std::vector<std::size_t> drawn_posts(std::size_t count, double low, double high, std::size_t most) {
  std::vector<std::size_t> posts;
  const double last = static_cast<double>(count - 1);
  if (count <= most) {
    for (std::size_t k = 0; k < count; ++k) posts.push_back(k);
    return posts;
  }
  const double begin = std::floor(std::clamp(low, 0.0, last)),
               end = std::ceil(std::clamp(high, begin, last));
  // Half of them are for the stretch; the rest reaches the borders in ever wider steps.
  const double step = std::max(1.0, std::ceil(2 * (end - begin) / static_cast<double>(most)));
  for (double growth = 1.05;; growth *= 1.05) {
    posts.clear();
    for (double at = begin; at < end; at += step) posts.push_back(static_cast<std::size_t>(at));
    posts.push_back(static_cast<std::size_t>(end));
    add_outward(static_cast<std::size_t>(begin), count, false, step, growth, posts);
    add_outward(static_cast<std::size_t>(end), count, true, step, growth, posts);
    std::ranges::sort(posts);
    posts.erase(std::unique(posts.begin(), posts.end()), posts.end());
    if (posts.size() <= most) return posts;
  }
}

}  // namespace neve::sim::shapes
