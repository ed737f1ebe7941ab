#include "sim/shapes/mesh_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/shapes/mesh_columns.h"

namespace neve::sim::shapes {
namespace {

/// Triangles that are looked at for one question, before the answer is taken from what was seen:
/// meshes of other people may have all triangles in one another's way.
constexpr std::size_t max_tests = 40'000'000;

/// Lines that find out whether anything overlaps, and those that measure how much.
constexpr int first_lines = 4096, all_lines = 65536;

/// Overlaps below this share of a volume are rounding, of parts that touch.
constexpr double min_overlap = 1e-7;

/// Winding numbers by part.
using PartCounts = std::vector<std::pair<std::uint32_t, int>>;

void add(PartCounts& counts, std::uint32_t part, int w) {
  const auto known = std::ranges::find(counts, part, &PartCounts::value_type::first);
  if (known == counts.end())
    counts.emplace_back(part, w);
  else if ((known->second += w) == 0)
    counts.erase(known);
}

class Parts {
 public:
  Parts(SolidMesh& mesh, const std::vector<std::uint32_t>& part, std::size_t count)
      : mesh_(mesh),
        part_(part),
        bounds_(bounds_of(mesh)),
        columns_(mesh.vertices, mesh.triangles, bounds_),
        containers_(count),
        volume_(count, 0.0),
        turn_(count, 1),
        share_(count, 1),
        count_(count, 0) {
    missing_.from = 0.5 * (bounds_.min + bounds_.max);  // keeps digits, as enclosed_by_faces()
  }

  void turn_outward();
  void measure();

 private:
  std::array<Vec3d, 3> corners(std::uint32_t t) const {
    const Triangle& c = mesh_.triangles[t];
    return {mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]};
  }
  void find_volumes();
  void find_containers();
  void find_shares();
  std::vector<std::uint32_t> parts_around(const Vec3d& p, std::uint32_t but);
  bool contains(std::uint32_t outer, std::uint32_t inner) const {
    return std::ranges::binary_search(containers_[inner], outer);
  }
  bool do_cross(const PartCounts& around);
  /// False, and nothing is added, where the line would take too long.
  bool measure_line(const Vec3d& p);
  bool is_inside(int depth) const {
    return mesh_.inside == Inside::odd ? depth % 2 != 0 : depth > 0;
  }
  /// @param area  m2, of the cross section of a line
  void find_moments(double area);
  double volume_error(int n, double area) const;

  SolidMesh& mesh_;
  const std::vector<std::uint32_t>& part_;
  Bounds bounds_;
  Columns columns_;
  std::vector<std::vector<std::uint32_t>> containers_;  ///< of each part, in order
  std::vector<double> volume_;                          ///< m3, of each part, as it was wound
  std::vector<int> turn_;   ///< of each part, how it is wound: 1 outward, -1 inward
  std::vector<int> share_;  ///< how often the faces of each part count in the moments: -1, 0, 1
  std::size_t tests_ = 0;
  std::vector<int> count_;  ///< of each part, its winding number about a place; 0 between places
  std::vector<std::uint32_t> seen_;
  // Sums of lengths over lines, m.
  double wrong_ = 0;  ///< that the faces together count wrong
  double crossed_ = 0, inside_out_ = 0;
  double missed_ = 0;           ///< that the faces by their shares count wrong, more or less
  Moments missing_;             ///< what the faces by their shares lack, over m2
  double missing_squares_ = 0;  ///< m2, of what they lack on each line
  std::vector<std::tuple<double, int, std::uint32_t>> meetings_;
  std::vector<std::uint32_t> chain_;
};

void Parts::find_volumes() {
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> origin(volume_.size(), none);
  for (std::uint32_t t = 0; t < part_.size(); ++t) {
    if (origin[part_[t]] == none) origin[part_[t]] = mesh_.triangles[t][0];
    const Vec3d& o = mesh_.vertices[origin[part_[t]]];
    const auto [a, b, c] = corners(t);
    volume_[part_[t]] += (a - o).dot((b - o).cross(c - o)) / 6;
  }
}

/// Finds the other parts that have p inside, in order.
std::vector<std::uint32_t> Parts::parts_around(const Vec3d& p, std::uint32_t but) {
  seen_.clear();
  const auto [begin, end] = columns_.at(p);
  tests_ += static_cast<std::size_t>(end - begin);
  for (const std::uint32_t* t = begin; t != end; ++t) {
    if (part_[*t] == but) continue;
    const auto [a, b, c] = corners(*t);
    const int w = winding(a, b, c, p);
    if (w == 0 || meeting_x(a, b, c, p) <= p.x()) continue;
    if (count_[part_[*t]] == 0) seen_.push_back(part_[*t]);
    count_[part_[*t]] += w;
  }
  tests_ += seen_.size();
  std::vector<std::uint32_t> around;
  for (const std::uint32_t part : seen_)
    if (std::exchange(count_[part], 0) != 0) around.push_back(part);
  std::ranges::sort(around);
  return around;
}

/// Finds the parts around the middle of every triangle of a part.
void Parts::find_containers() {
  std::vector<bool> is_begun(volume_.size(), false);
  std::vector<std::uint32_t> common;
  for (std::uint32_t t = 0; t < part_.size(); ++t) {
    std::vector<std::uint32_t>& containers = containers_[part_[t]];
    if (is_begun[part_[t]] && containers.empty()) continue;
    if (tests_ > max_tests) {
      containers.clear();
      continue;
    }
    const auto [a, b, c] = corners(t);
    std::vector<std::uint32_t> around = parts_around((a + b + c) / 3, part_[t]);
    if (is_begun[part_[t]]) {
      common.clear();
      std::ranges::set_intersection(containers, around, std::back_inserter(common));
      containers = common;
    } else {
      containers = std::move(around);
    }
    is_begun[part_[t]] = true;
  }
  tests_ = 0;
}

void Parts::turn_outward() {
  find_volumes();
  if (volume_.size() > 1) find_containers();
  std::vector<std::uint32_t> order(volume_.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto is_larger = [&](std::uint32_t a, std::uint32_t b) {
    const double va = std::abs(volume_[a]), vb = std::abs(volume_[b]);
    return va != vb ? va > vb : a < b;
  };
  std::sort(order.begin(), order.end(), is_larger);
  std::vector<bool> is_inward(volume_.size()), is_solid(volume_.size(), true);
  for (const std::uint32_t p : order) {
    is_inward[p] = volume_[p] < 0;
    const auto around = std::ranges::max_element(containers_[p], is_larger, {});
    // max_element by is_larger: the smallest, which is the nearest around it.
    if (around != containers_[p].end() && mesh_.inside == Inside::positive)
      is_solid[p] = is_solid[*around] == (is_inward[p] == is_inward[*around]);
    if (around != containers_[p].end() && mesh_.inside == Inside::odd)
      is_solid[p] = containers_[p].size() % 2 == 0;
    const bool is_nested = !containers_[p].empty();
    mesh_.reading.cavities += is_nested && !is_solid[p];
    mesh_.reading.nested += is_nested && is_solid[p] && is_solid[*around];
    mesh_.reading.turned_parts += is_inward[p] && !is_nested;
  }
  const bool is_even_odd = mesh_.inside == Inside::odd;
  for (std::size_t p = 0; p < turn_.size(); ++p) turn_[p] = is_solid[p] || is_even_odd ? 1 : -1;
  find_shares();
  for (std::size_t t = 0; t < part_.size(); ++t)
    if (is_inward[part_[t]] == (is_solid[part_[t]] || is_even_odd))
      std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
}

/// Faces of a part lie between what is around the part and what is in it. Only if one of these is
/// inside, and the other is not, do they bound anything.
void Parts::find_shares() {
  for (std::size_t p = 0; p < share_.size(); ++p) {
    int around = 0;
    for (const std::uint32_t other : containers_[p]) around += turn_[other];
    share_[p] = turn_[p] * ((is_inside(around + turn_[p]) ? 1 : 0) - (is_inside(around) ? 1 : 0));
  }
}

/// True if two of the parts around a place are not in one another, or one of them occurs twice.
bool Parts::do_cross(const PartCounts& around) {
  tests_ += around.size();
  chain_.clear();
  for (const auto& [part, w] : around) {
    if (w > 1) return true;
    chain_.push_back(part);
  }
  // Each is in the one before, from the outermost to the innermost.
  std::ranges::sort(chain_, {},
                    [&](std::uint32_t part) { return std::pair(containers_[part].size(), part); });
  for (std::size_t k = 1; k < chain_.size(); ++k)
    if (!contains(chain_[k - 1], chain_[k])) return true;
  return false;
}

bool Parts::measure_line(const Vec3d& p) {
  const double before[] = {wrong_, crossed_, inside_out_, missed_};
  const Moments missing_before = missing_;
  meetings_.clear();
  const auto [begin, end] = columns_.at(p);
  tests_ += static_cast<std::size_t>(end - begin);
  for (const std::uint32_t* t = begin; t != end; ++t) {
    const auto [a, b, c] = corners(*t);
    if (const int w = winding(a, b, c, p))
      meetings_.emplace_back(meeting_x(a, b, c, p), w, part_[*t]);
  }
  std::sort(meetings_.begin(), meetings_.end());
  PartCounts around;
  int depth = 0, counted = 0;
  for (std::size_t k = 0; k + 1 < meetings_.size(); ++k) {
    const auto& [from, w, part] = meetings_[k];
    depth -= w;
    counted -= w * share_[part];
    add(around, part, -w);
    tests_ += around.size();
    if (tests_ > max_tests) {
      std::tie(wrong_, crossed_, inside_out_, missed_) =
          std::tie(before[0], before[1], before[2], before[3]);
      missing_ = missing_before;
      return false;
    }
    const double length = std::get<0>(meetings_[k + 1]) - from;
    if (length <= 0) continue;
    if (const int lacking = (is_inside(depth) ? 1 : 0) - counted; lacking != 0) {
      missed_ += length * std::abs(lacking);
      missing_.add_rod({from + 0.5 * length, p.y(), p.z()}, length, lacking);
    }
    if (depth == 0 || depth == 1) continue;
    wrong_ += length * ((is_inside(depth) ? 1 : 0) - depth);
    if (depth < 0 && mesh_.inside == Inside::positive) inside_out_ += length;
    if (depth > 1 && do_cross(around)) crossed_ += length;
  }
  const double lacking = missing_.volume - missing_before.volume;
  missing_squares_ += lacking * lacking;
  return true;
}

/// Lines at the points of a sequence that fills a square evenly, however many are taken.
/// Source: Roberts, The Unreasonable Effectiveness of Quasirandom Sequences (R2), 2018.
void Parts::measure() {
  mesh_.volume = enclosed_by_faces(mesh_);
  constexpr double golden = 1.32471795724474602596;
  const Vec3d size = bounds_.max - bounds_.min;
  int n = 0;
  for (; n < all_lines && tests_ < max_tests; ++n) {
    if (n == first_lines && wrong_ == 0) break;
    const double u = std::fmod(0.5 + n / golden, 1), v = std::fmod(0.5 + n / (golden * golden), 1);
    if (!measure_line(bounds_.min + Vec3d(0, u * size.y(), v * size.z()))) break;
  }
  const double area = size.y() * size.z() / std::max(n, 1);
  find_moments(area);
  if (n > 0 && std::abs(wrong_) * area <= min_overlap * std::abs(mesh_.volume)) return;
  // The faces by their shares are exact for parts in one another, and lines find what they lack.
  if (mesh_.moments) mesh_.volume = mesh_.moments->volume;
  mesh_.reading.volume_error = volume_error(n, area);
  mesh_.reading.crossed = crossed_ * area / mesh_.volume;
  mesh_.reading.inside_out = inside_out_ * area / mesh_.volume;
}

/// Standard error of the volume by n lines, as a share of it: one line says nothing of parts in
/// one another's way.
double Parts::volume_error(int n, double area) const {
  if (n < 2) return volume_.size() > 1 ? 1 : 0;
  const double mean = missing_.volume / n;
  return std::sqrt(n * std::max(missing_squares_ / n - mean * mean, 0.0)) * area /
         std::abs(mesh_.volume);
}

void Parts::find_moments(double area) {
  const bool are_measured = missed_ * area > min_overlap * std::abs(mesh_.volume);
  if (!are_measured && std::ranges::count(share_, 1) == std::ssize(share_)) return;
  Moments all;
  all.from = missing_.from;
  for (std::uint32_t t = 0; t < part_.size(); ++t) {
    if (share_[part_[t]] == 0) continue;
    const auto [a, b, c] = corners(t);
    all.add_tetrahedron(a, b, c, share_[part_[t]]);
  }
  if (are_measured) all.add(missing_, area);
  mesh_.moments = all;
}

}  // namespace

double enclosed_by_faces(const SolidMesh& mesh) {
  const Bounds b = bounds_of(mesh);
  const Vec3d origin = 0.5 * (b.min + b.max);  // keeps digits of meshes far from their origin
  double volume = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d u = mesh.vertices[i] - origin, v = mesh.vertices[j] - origin;
    volume += u.dot(v.cross(mesh.vertices[k] - origin)) / 6;
  }
  return volume;
}

void read_parts(SolidMesh& mesh, const std::vector<std::uint32_t>& part, std::size_t part_count) {
  const Bounds b = bounds_of(mesh);
  if (((b.max - b.min).array() <= 0).any()) return;  // flat: no volume
  Parts parts(mesh, part, part_count);
  parts.turn_outward();
  parts.measure();
}

}  // namespace neve::sim::shapes
