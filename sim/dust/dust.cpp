#include "sim/dust/dust.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "sim/base/hash.h"
#include "sim/types/errors.h"

namespace neve::sim::dust {

namespace {

/// Cells of air that anything may cross in a step.
constexpr double cells_per_step = 1.5;
/// kg/m3, of air: the weight of dust over it lifts or sinks it.
constexpr double air_density = 1.2;

double spacing_of(const DustSettings& settings, double cell_size) {
  return settings.air_cell * cell_size;
}

/// A box around the dust and the snow that air and dust may have to do with.
struct Reach {
  Vec3d low = Vec3d::Constant(1e300), high = Vec3d::Constant(-1e300);

  bool is_empty() const { return !(low.x() <= high.x()); }
  void take(const Vec3d& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
};

Reach reach_of(std::span<const SnowGrain> snow, const std::vector<Mote>& motes,
               const DustSettings& settings) {
  // Spray feels the air whatever the speed that sheds dust.
  constexpr double slow_spray = 0.75;  // m/s
  const double moving = 0.5 * settings.speed,
               slowest = settings.spray_drag > 0 ? std::min(moving, slow_spray) : moving;
  Reach reach;
  for (const SnowGrain& grain : snow)
    if (grain.x.allFinite() && (grain.v - settings.wind).norm() > slowest) reach.take(grain.x);
  for (const Mote& mote : motes) reach.take({mote.x[0], mote.x[1], mote.x[2]});
  return reach;
}

/// m/s2 per cell: buoyancy g, times the density of dust over that of air.
std::vector<float> lift_of(const std::vector<Mote>& motes, const AirBox& box, double strength) {
  std::vector<float> lift;
  if (strength == 0 || box.is_empty()) return lift;
  lift.assign(box.count(), 0);
  const double per_mass = strength / (air_density * std::pow(box.spacing, 3));
  for (const Mote& mote : motes) {
    const Vec3d place = box.place({mote.x[0], mote.x[1], mote.x[2]});
    if (!box.contains(place)) continue;
    const Vec3i cell = place.cast<int>();
    lift[box.index(cell.x(), cell.y(), cell.z())] += static_cast<float>(per_mass * mote.m);
  }
  return lift;
}

struct SavedHead {
  DustProgress progress;
  DustTotals totals;
  double spacing;
  std::int64_t low[3], size[3];
  std::uint64_t motes;
};
static_assert(std::has_unique_object_representations_v<DustTotals> || sizeof(DustTotals) == 48);
static_assert(sizeof(SavedHead) == 8 * 17 && sizeof(Mote) == 80);

[[noreturn]] void refuse(const std::string& why) {
  throw SavedStateError("the dust of the saved state " + why);
}

/// A box that no run has would ask for any memory.
AirBox checked_box(const SavedHead& head) {
  AirBox box{head.spacing, {0, 0, 0}, {0, 0, 0}};
  double cells = 1;
  bool is_empty = true;
  for (int a = 0; a < 3; ++a) {
    const double side = static_cast<double>(head.size[a]), low = static_cast<double>(head.low[a]);
    if (!(side >= 0 && side <= max_air_cells) || !(std::abs(low) <= 1e9)) refuse("has no such box");
    cells *= side;
    is_empty = is_empty && head.size[a] == 0;
    box.low[a] = static_cast<int>(head.low[a]);
    box.size[a] = static_cast<int>(head.size[a]);
  }
  if (!(head.spacing > 0 && std::isfinite(head.spacing)) || cells > max_air_cells ||
      (cells == 0 && !is_empty))
    refuse("has no such box");
  return box;
}

}  // namespace

double longest_step(const DustSettings& settings, double cell_size, double speed) {
  const double crossing =
      cells_per_step * spacing_of(settings, cell_size) / std::max({speed, settings.speed, 1e-9});
  return std::min(Dust::max_step, crossing);
}

bool Dust::is_due(double time, double end, const DustSettings& settings, double cell_size) const {
  const double longest = longest_step(settings, cell_size, progress_.fastest),
               rest = end - progress_.time;
  const double step = rest > 0 ? rest / std::ceil(rest / longest - 1e-6) : longest;
  return time - progress_.time >= step * (1 - 1e-9);
}

void Dust::advance(double time, std::span<const SnowGrain> snow, const DustScene& scene) {
  const DustSettings& settings = scene.settings;
  const double dt = time - progress_.time;
  progress_.time = time;
  if (!(dt > 0)) return;
  const std::uint64_t step = ++progress_.steps;
  const Reach reach = reach_of(snow, cloud_.motes, settings);
  if (reach.is_empty()) {
    air_.cover({spacing_of(settings, scene.cell_size), {0, 0, 0}, {0, 0, 0}}, settings.wind);
    progress_.fastest = 0;
    return;
  }
  air_.cover(
      air_box_around(reach.low, reach.high, spacing_of(settings, scene.cell_size), air_.box()),
      settings.wind);
  air_.see(snow, scene.solids, scene.pool);
  const double g = scene.gravity.norm();
  const Vec3d up = g > 0 ? Vec3d(-scene.gravity / g) : Vec3d::Zero();
  air_.step(dt, settings.wind, up, lift_of(cloud_.motes, air_.box(), settings.buoyancy * g),
            scene.pool);
  const Surroundings around{settings, scene.solids, scene.gravity, time, dt, step};
  cloud_.move(air_, Gusts(air_.box().spacing, std::max(settings.speed, 0.1)), around, scene.pool);
  cloud_.shed(snow, air_, around, scene.cell_size);
  progress_.fastest = air_.largest_speed();
  for (const SnowGrain& grain : snow)
    if (const double speed = grain.v.norm(); speed < 1e6)
      progress_.fastest = std::max(progress_.fastest, speed);
}

void Dust::start_at(double time) {
  const DustTotals totals = cloud_.totals;
  *this = {};
  cloud_.totals = totals;
  progress_.time = time;
}

DustArrays Dust::arrays() const {
  DustArrays out;
  out.totals = cloud_.totals;
  out.air_spacing = air_.box().spacing;
  for (const Mote& mote : cloud_.motes) {
    out.x.emplace_back(mote.x[0], mote.x[1], mote.x[2]);
    out.v.emplace_back(mote.v[0], mote.v[1], mote.v[2]);
    out.m.push_back(mote.m);
    out.age.push_back(mote.age);
    out.id.push_back(mote.key);
  }
  return out;
}

std::uint64_t Dust::hash() const {
  std::uint64_t sum = 0;
  for (const Mote& mote : cloud_.motes) sum += mix64(hash_bytes(&mote, sizeof mote));
  return sum;
}

std::size_t Dust::memory_bytes() const {
  return air_.memory_bytes() + sizeof(Mote) * cloud_.motes.capacity();
}

std::vector<std::uint8_t> Dust::save() const {
  SavedHead head{};
  head.progress = progress_;
  head.totals = cloud_.totals;
  head.spacing = air_.box().spacing;
  for (int a = 0; a < 3; ++a) {
    head.low[a] = air_.box().low[a];
    head.size[a] = air_.box().size[a];
  }
  head.motes = cloud_.motes.size();
  std::vector<std::uint8_t> bytes;
  const auto put = [&](const void* data, std::size_t size) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
  };
  put(&head, sizeof head);
  put(cloud_.motes.data(), sizeof(Mote) * cloud_.motes.size());
  for (const std::vector<float>& field : air_.faces()) put(field.data(), 4 * field.size());
  return bytes;
}

void Dust::restore(std::span<const std::uint8_t> bytes) {
  SavedHead head{};
  if (bytes.size() < sizeof head) refuse("is truncated");
  std::memcpy(&head, bytes.data(), sizeof head);
  const AirBox box = checked_box(head);
  const std::size_t field_bytes = 4 * box.count();
  if (head.motes > bytes.size() / sizeof(Mote) ||
      bytes.size() != sizeof head + head.motes * sizeof(Mote) + 3 * field_bytes)
    refuse("has a different length than it says");
  const std::uint8_t* next = bytes.data() + sizeof head;
  const auto take = [&](void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, next, size);
    next += size;
  };
  Cloud cloud;
  cloud.totals = head.totals;
  cloud.motes.resize(head.motes);
  take(cloud.motes.data(), sizeof(Mote) * head.motes);
  for (const Mote& mote : cloud.motes)
    for (int a = 0; a < 3; ++a)
      if (!std::isfinite(mote.x[a]) || !std::isfinite(mote.v[a])) refuse("is not finite");
  FaceVelocities faces;
  for (std::vector<float>& field : faces) {
    field.resize(box.count());
    take(field.data(), field_bytes);
    for (const float value : field)
      if (!std::isfinite(value)) refuse("is not finite");
  }
  if (!std::isfinite(head.progress.time) || !std::isfinite(head.progress.fastest))
    refuse("is not finite");
  progress_ = head.progress;
  cloud_ = std::move(cloud);
  air_.restore(box, std::move(faces));
}

}  // namespace neve::sim::dust
