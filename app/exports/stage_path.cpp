#include "app/exports/stage_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "app/exports/usda.h"
#include "sim/types/math.h"

namespace neve::app::exports {

namespace {

using sim::Mat3d;
using sim::Vec3d;

/// Two quaternions are interpolated the shorter way round, so a piece has to turn by less than half
/// a turn; the point of a thing that moves on a circle stays near it with smaller ones.
constexpr double largest_turn = std::numbers::pi / 4;

/// A thing that turns faster than 32 times in a frame is a blur in any picture.
constexpr int max_pieces = 256;

int pieces_of(double turn) {
  return static_cast<int>(std::clamp(std::ceil(turn / largest_turn - 1e-9), 1.0, 1.0 * max_pieces));
}

double angle_between(const Mat3d& a, const Mat3d& b) {
  return Eigen::AngleAxisd(Mat3d(b * a.transpose())).angle();
}

/// Places between two times, of a thing whose place is known at all of them.
/// @param turn  what its speed says that it turns by
void add_known(std::vector<Place>& path, double from, double to, double turn,
               const std::function<Place(double)>& place_at) {
  constexpr int looks = 16;
  double seen = 0;
  bool is_turned = false;
  Place last = place_at(from);
  for (int k = 1; k <= looks; ++k) {
    const Place now = place_at(from + (to - from) * k / looks);
    is_turned = is_turned || now.rotation != last.rotation;
    seen += angle_between(last.rotation, now.rotation);
    last = now;
  }
  // A plane has a spin for its friction, which turns nothing.
  const int pieces = is_turned ? pieces_of(std::max(turn, seen)) : 1;
  for (int k = 1; k < pieces; ++k) path.push_back(place_at(from + (to - from) * k / pieces));
}

/// Places between two that the run says: the turn is the one that ends there and is nearest to what
/// the spins of both say, which may be several times round.
void add_between(std::vector<Place>& path, const Sample& from, const Sample& to,
                 const sim::shapes::Pose& a, const sim::shapes::Pose& b) {
  // Steps that skip colliders let them wait, whatever their spin.
  if (a.rotation == b.rotation) return;
  const double seconds = to.time - from.time;
  const Vec3d spun = 0.5 * seconds * (a.angular_velocity + b.angular_velocity);
  const Eigen::AngleAxisd shortest(Mat3d(b.rotation * a.rotation.transpose()));
  const bool has_axis = shortest.angle() > 1e-6 || spun.norm() < 1;
  const Vec3d axis = has_axis ? shortest.axis() : Vec3d(spun.normalized());
  const double round = 2 * std::numbers::pi;
  const double turn =
      shortest.angle() + round * std::round((spun.dot(axis) - shortest.angle()) / round);
  const int pieces = pieces_of(std::abs(turn));
  for (int k = 1; k < pieces; ++k) {
    const double part = 1.0 * k / pieces;
    path.push_back({from.time + part * seconds,
                    Eigen::AngleAxisd(part * turn, axis).toRotationMatrix() * a.rotation,
                    a.point + part * (b.point - a.point)});
  }
}

/// Frames between two samples where the scene alone says where its colliders are.
void add_frames(std::vector<Sample>& samples, const scene::Scene& scene, const Sample& from,
                const Sample& to) {
  if (from.is_elsewhere || to.is_elsewhere) return;
  constexpr double same = 1e-6;  // of a frame
  for (double frame = std::floor(from.time * scene.fps + same) + 1;
       frame < to.time * scene.fps - same; ++frame) {
    Sample sample{0, frame / scene.fps, placed_at(scene.colliders, frame / scene.fps)};
    const double part = (sample.time - from.time) / (to.time - from.time);
    for (const auto& [name, moved] : from.followed)
      if (const auto then = to.followed.find(name); then != to.followed.end())
        sample.followed[name] = moved + part * (then->second - moved);
    samples.push_back(std::move(sample));
  }
}

}  // namespace

std::vector<Sample> stage_samples(const scene::Scene& scene, const std::vector<Sample>& files,
                                  const std::vector<Sample>& between) {
  if (files.empty()) return {};
  std::vector<Sample> known = files;
  const double tick = 1e-6 / scene.fps;
  for (const Sample& sample : between) {
    const bool is_inside =
        sample.time > files.front().time + tick && sample.time < files.back().time - tick;
    const bool is_file = std::ranges::any_of(
        files, [&](const Sample& file) { return std::abs(file.time - sample.time) <= tick; });
    if (is_inside && !is_file) known.push_back(sample);
  }
  std::ranges::stable_sort(known, {}, &Sample::time);
  std::vector<Sample> samples;
  for (const Sample& sample : known) {
    if (!samples.empty()) {
      const Sample last = samples.back();
      add_frames(samples, scene, last, sample);
    }
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Place> collider_path(const scene::Scene& scene, const std::string& collider,
                                 const std::vector<Sample>& samples) {
  const auto own = std::ranges::find(scene.colliders, collider, &scene::Collider::name);
  const PlacedShape *placed = nullptr, *last = nullptr;
  for (auto sample = samples.begin(); sample != samples.end() && !placed; ++sample)
    placed = sample->find(collider);
  std::vector<Place> path;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const PlacedShape* now = samples[k].find(collider);
    if (now && last) {
      const Sample& before = samples[k - 1];
      const bool is_of_scene = !before.is_elsewhere && !samples[k].is_elsewhere;
      if (is_of_scene && own != scene.colliders.end())
        add_known(path, before.time, samples[k].time,
                  last->pose.angular_velocity.norm() * (samples[k].time - before.time),
                  [&](double time) {
                    const sim::shapes::Pose pose = sim::shapes::pose_at(*own, time);
                    return Place{time, pose.rotation, pose.point};
                  });
      else
        add_between(path, before, samples[k], last->pose, now->pose);
    }
    last = now;
    if (now) placed = now;
    path.push_back({samples[k].time, placed->pose.rotation, placed->pose.point});
  }
  return path;
}

std::vector<Place> path_of(const std::vector<Sample>& samples,
                           const std::function<Place(double time)>& place_at) {
  std::vector<Place> path;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) add_known(path, samples[k - 1].time, samples[k].time, 0, place_at);
    path.push_back(place_at(samples[k].time));
  }
  return path;
}

std::string usd_property(const scene::Scene& scene, const std::string& declared,
                         const std::vector<std::pair<double, std::string>>& values) {
  const bool is_same = std::ranges::all_of(
      values, [&](const auto& value) { return value.second == values.front().second; });
  if (is_same) return declared + " = " + values.front().second + "\n";
  const std::string indent(declared.find_first_not_of(' '), ' ');
  std::string text = declared + ".timeSamples = {\n";
  for (const auto& [time, value] : values) {
    text += indent;
    text += "    " + usd_number(time_in_frames(scene, time)) + ": ";
    text += value + ",\n";
  }
  return text + indent + "}\n";
}

std::string usd_placed(const scene::Scene& scene, const Axes& axes,
                       const std::vector<Place>& path) {
  // These numbers are doubles, unlike those of usd_tuple(). Adding 0 turns -0 into 0.
  const auto tuple = [](std::initializer_list<double> numbers) {
    std::string text;
    for (const double x : numbers) text += (text.empty() ? "(" : ", ") + usd_number(x + 0.0);
    return text + ")";
  };
  std::vector<std::pair<double, std::string>> places, attitudes;
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  for (const Place& place : path) {
    const Vec3d x = axes.scaled(place.point);
    places.emplace_back(place.time, tuple({x.x(), x.y(), x.z()}));
    Eigen::Quaterniond q(axes.turned(place.rotation));
    q.normalize();
    // A quaternion and its negative are one attitude; programs that mix elements need neighbours.
    if (q.dot(last) < 0) q.coeffs() = -q.coeffs();
    last = q;
    attitudes.emplace_back(place.time, tuple({q.w(), q.x(), q.y(), q.z()}));
  }
  const std::string indent(12, ' ');
  return usd_property(scene, indent + "double3 xformOp:translate", places) +
         usd_property(scene, indent + "quatd xformOp:orient", attitudes) + indent +
         "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n";
}

}  // namespace neve::app::exports
