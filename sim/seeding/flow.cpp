#include "sim/seeding/flow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "sim/base/hash.h"
#include "sim/seeding/sampling.h"
#include "sim/seeding/sampling_blocks.h"
#include "sim/seeding/seeding.h"
#include "sim/shapes/variation.h"

namespace neve::sim::seeding {

namespace {

/// Key of emitters, apart from the keys of bodies.
constexpr std::uint64_t emitter_key = 0x656d6974;

/// Candidates for one place. In a shape that fills this share of its box one of 64 is inside: it
/// never happens that all of so many are outside.
constexpr int max_candidates = 8192;
constexpr double min_share = 1.0 / 64;

/// Candidates and places for a shape that fills less: they are found once and reused in turn, in a
/// tenth of a second, a second for a mesh.
constexpr std::uint64_t pool_candidates = 1 << 20;
constexpr std::size_t pool_places = 1 << 14;

double share_of(const Emitter& emitter, double cell_size) {
  return cell_size * cell_size * cell_size / emitter.particles_per_cell;
}

/// Places that a birth tries.
constexpr int tries_per_birth = 8;

/// Returns a time, or the end of the emitter where that is earlier.
double open_until(const Emitter& emitter, double time) {
  return emitter.end ? std::min(time, *emitter.end) : time;
}

/// Births until a time; the first and the last are inside start to end.
/// @param mass    kg, of each
/// @param waited  s, for which the clock of the emitter stood still
double births_until(const Emitter& emitter, double mass, double time, double waited = 0) {
  const double until = open_until(emitter, time) - waited;
  if (!(until > emitter.start)) return 0;
  return std::floor(emitter.rate / mass * (until - emitter.start) + 0.5);
}

double fraction(double x) {
  return x - std::floor(x);
}

bool fills(const shapes::Bounds& box, double volume) {
  return volume >= min_share * (box.max - box.min).prod();
}

/// The c-th point of a sequence that fills the unit cube evenly, however long it is: multiples of
/// the powers of 1/g, where g^4 = g + 1. Source: Roberts, The Unreasonable Effectiveness of
/// Quasirandom Sequences (2018).
Vec3d even_point(std::uint64_t key, std::uint64_t c) {
  constexpr double g = 1.2207440846057594754;
  const auto n = static_cast<double>(c);
  Vec3d point;
  double step = 1;
  for (std::uint64_t a = 0; a < 3; ++a) {
    step /= g;
    point[static_cast<Eigen::Index>(a)] = fraction(unit_double(mix64(key, a)) + n * step);
  }
  return point;
}

/// Returns points that are evenly spread over the unit ball.
std::vector<Vec3d> points_in_ball() {
  constexpr std::size_t wanted = 32;
  std::vector<Vec3d> points;
  for (std::uint64_t c = 0; points.size() < wanted; ++c) {
    const Vec3d point = 2 * even_point(0, c) - Vec3d::Ones();
    if (point.squaredNorm() <= 1) points.push_back(point);
  }
  return points;
}

/// Packed snow of 33 particles at random places has up to so much more than the mean, and an
/// undisturbed stream is not to be withheld. A body appears up to where other snow begins.
constexpr double max_packing = 1.15, max_filled_of_body = 0.5;

/// A stream is looked for as far as this from its shape, in radii, in so many steps.
constexpr double max_shift = 2;
constexpr int shifts = 8;

/// 1/s, of the volume of an emitter with a rate.
double share_carried_away(const Emitter& emitter, const shapes::Solid& solid,
                          const Vec3d& gravity) {
  const double speed = emitter.velocity.norm(), g = gravity.norm();
  const double by_velocity = speed > 0 ? speed / solid.extent(emitter.velocity) : 0;
  // The snow farthest from the centre leaves by its spin within about two radians.
  const double by_spin = 0.5 * emitter.angular_velocity.norm();
  // For snow born at rest with the same rate everywhere, momentum asks for v^2 = g y / 1.5 at a
  // depth y and for the density rate / V sqrt(1.5 y / g).
  const double by_gravity = g > 0 ? std::sqrt(g / (1.5 * solid.extent(gravity))) : 0;
  return std::max(by_velocity + by_spin, by_gravity);
}

/// kg/s, see natural_rate(); of an emitter with a rate.
double carried_away(const Emitter& emitter, const Material& material, const shapes::Solid& solid,
                    const Vec3d& gravity) {
  return density_at_birth(emitter, material) * solid.volume() *
         share_carried_away(emitter, solid, gravity);
}

}  // namespace

double natural_rate(const Emitter& emitter, const Material& material, const Vec3d& gravity) {
  if (emitter.rate == 0) return std::numeric_limits<double>::infinity();
  return carried_away(emitter, material, shapes::Solid(emitter.shape), gravity);
}

double birth_period(const Emitter& emitter, const Material& material, double cell_size) {
  return density_at_birth(emitter, material) * share_of(emitter, cell_size) / emitter.rate;
}

std::uint64_t count_emitted(const Emitter& emitter, const Material& material, double cell_size,
                            double time) {
  const double share = share_of(emitter, cell_size);
  double count = 0;
  if (emitter.rate > 0)
    count = births_until(emitter, density_at_birth(emitter, material) * share, time);
  else if (time >= emitter.start)
    count = std::max(1.0, std::ceil(shapes::Solid(emitter.shape).volume() / share));
  return static_cast<std::uint64_t>(std::min(count, max_particles));
}

EmitterStream::EmitterStream(const Emitter& emitter, std::size_t number, const Material& material,
                             std::uint64_t seed, double cell_size)
    : emitter_(emitter),
      material_(material),
      key_(mix64(mix64(mix64(seed), emitter_key), number)),
      solid_(emitter.shape),
      box_(solid_.local_bounds()),
      share_(share_of(emitter, cell_size)) {
  if (emitter.rate > 0) return;
  if (!(solid_.volume() / volume_ < max_particles))
    throw ShapeError("emitter " + emitter.name + ": more than 2^32 particles fit into it");
  require_few_blocks(solid_, Vec3d::Zero(), std::cbrt(volume_));
}

void EmitterStream::advance_to(double time, std::vector<Birth>& births, const HasRoom& has_room,
                               const std::optional<Vec3d>& gravity) {
  if (emitter_.rate == 0) {
    if (time >= emitter_.start && state_.born == 0)
      fill_whole(time - emitter_.start, births, has_room);
    return;
  }
  const double mass = density_at_birth(emitter_, material_) * volume_;
  const double period = mass / emitter_.rate;
  const auto due = [&](double waited) {
    return static_cast<std::uint64_t>(
        std::min(births_until(emitter_, mass, time, waited), max_particles));
  };
  const bool is_due = state_.born < due(state_.waited);
  const double pause = gravity && is_due ? pause_after_birth(*gravity) : 0;
  for (; state_.born < due(state_.waited); ++state_.born) {
    const double birth = emitter_.start + (static_cast<double>(state_.born) + 0.5) * period;
    // One that was waiting when the emitter closed is not born: its place would move on and on.
    if (state_.withheld > 0 && emitter_.end && state_.waited == *emitter_.end - birth) break;
    const double age = std::max(0.0, time - state_.waited - birth);
    // The shape is filled once where nothing carries the snow away.
    const bool is_full =
        std::isinf(pause) && static_cast<double>(state_.born) * volume_ >= solid_.volume();
    const std::optional<Birth> born = is_full ? std::nullopt : next_birth(age, has_room);
    if (!born) {
      state_.waited = open_until(emitter_, time) - birth;
      break;
    }
    births.push_back(*born);
    if (std::isfinite(pause)) state_.waited += pause;
  }
  state_.withheld = due(0) - state_.born;
}

bool EmitterStream::is_undisturbed(const State& state) const {
  if (state.withheld > 0 || state.waited > 0) return false;
  if (fills_whole()) return true;
  // A place that is taken costs a candidate more.
  if (!fills(box_, solid_.volume())) return state.candidate == state.born;
  EmitterStream alone = *this;
  alone.state_ = {};
  for (std::uint64_t k = 0; k < state.born; ++k) alone.next_place();
  return alone.state_.candidate == state.candidate;
}

/// Returns the time for which the clock stops after each birth, s, so that no more snow comes than
/// is carried away; infinite where nothing carries it.
double EmitterStream::pause_after_birth(const Vec3d& gravity) const {
  const double mass = density_at_birth(emitter_, material_) * volume_;
  const double natural = carried_away(emitter_, material_, solid_, gravity);
  return exceeds(emitter_.rate, natural) ? mass / natural - mass / emitter_.rate : 0;
}

std::optional<Birth> EmitterStream::next_birth(double age, const HasRoom& has_room) {
  for (int tries = 0; tries < tries_per_birth; ++tries)
    if (const Birth birth = born_at(next_place(), age); has_room(birth)) return birth;
  return std::nullopt;
}

/// Fills the shape at its time and not before: a closed emitter costs nothing, births are not kept.
void EmitterStream::fill_whole(double age, std::vector<Birth>& births, const HasRoom& has_room) {
  // The spacing is not that of volume_: a run that went back fills it a second time.
  const double spacing = std::cbrt(share_);
  std::vector<Vec3d> places = sample_jittered(solid_, spacing, key_);
  if (places.empty()) places.push_back(solid_.inner_point());
  volume_ = solid_.volume() / static_cast<double>(places.size());
  for (; state_.born < places.size(); ++state_.born) {
    const Birth birth = born_at(places[state_.born], age);
    if (has_room(birth))
      births.push_back(birth);
    else
      ++state_.withheld;
  }
}

/// Returns a place in the box around the shape: evenly spread, shaken by up to half a spacing, so
/// that no rows are seen. Places shaken out on one side come in on the other: the density is even.
Vec3d EmitterStream::next_candidate() {
  const Vec3d size = box_.max - box_.min;
  const double spacing = std::cbrt(volume_);
  const std::uint64_t c = state_.candidate++, shake = mix64(key_, c);
  const Vec3d even = even_point(key_, c);
  Vec3d y;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double moved = unit_double(mix64(shake, static_cast<std::uint64_t>(a))) - 0.5;
    y[a] = box_.min[a] + size[a] * fraction(even[a] + moved * std::min(1.0, spacing / size[a]));
  }
  return y;
}

Vec3d EmitterStream::next_place() {
  if (!fills(box_, solid_.volume())) {
    if (pool_.empty()) fill_pool();
    return pool_[state_.candidate++ % pool_.size()];
  }
  for (int tries = 0; tries < max_candidates; ++tries)
    if (const Vec3d y = next_candidate(); solid_.contains_local(y)) return y;
  return solid_.inner_point();
}

/// Fills the pool reproducibly: a resumed run makes it again.
void EmitterStream::fill_pool() {
  const std::uint64_t places_so_far = std::exchange(state_.candidate, 0);
  while (state_.candidate < pool_candidates && pool_.size() < pool_places)
    if (const Vec3d y = next_candidate(); solid_.contains_local(y)) pool_.push_back(y);
  if (pool_.empty()) pool_.push_back(solid_.inner_point());
  state_.candidate = places_so_far;
}

Birth EmitterStream::born_at(const Vec3d& local, double age) const {
  const Vec3d arm = solid_.rotation() * local;
  Birth birth;
  birth.v = emitter_.velocity + emitter_.angular_velocity.cross(arm);
  birth.x = solid_.center() + arm + age * birth.v;
  // The pattern comes out with the snow: earlier births have moved on by the velocity.
  const double mass = density_at_birth(emitter_, material_) * volume_;
  const double time =
      emitter_.rate == 0 ? 0 : static_cast<double>(state_.born) * mass / emitter_.rate;
  const shapes::Factors factors =
      shapes::vary(material_.variation, key_, state_.born, arm - time * emitter_.velocity);
  birth.V0 = volume_ / emitter_.J_P;
  birth.J_P = emitter_.J_P;
  birth.room = room_around(local);
  birth.m = mass * factors.density;
  birth.stiffness = factors.stiffness;
  birth.threshold = factors.threshold;
  return birth;
}

/// The stream is the shape, drawn out along the velocity. Nothing comes from behind the shape: if
/// the empty space there counted as room, snow at that face would have twice the density.
double EmitterStream::room_around(const Vec3d& local) const {
  static const std::vector<Vec3d> ball = points_in_ball();
  const double radius = room_radius * std::cbrt(volume_);
  const Vec3d along = solid_.rotation().transpose() * emitter_.velocity.stableNormalized();
  const auto is_in_stream = [&](const Vec3d& y) {
    if (solid_.contains_local(y)) return true;
    if (emitter_.rate == 0) return false;
    for (int k = 1; k <= shifts; ++k) {
      if (solid_.contains_local(y - (k * max_shift / shifts) * radius * along)) return true;
    }
    return false;
  };
  std::size_t inside = 0;
  for (const Vec3d& place : ball) inside += is_in_stream(local + radius * place);
  const double share =
      static_cast<double>(std::max<std::size_t>(1, inside)) / static_cast<double>(ball.size());
  return (fills_whole() ? max_filled_of_body : max_packing) * share * 4.0 / 3.0 * std::numbers::pi *
         radius * radius * radius;
}

}  // namespace neve::sim::seeding
