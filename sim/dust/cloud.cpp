#include "sim/dust/cloud.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/hash.h"

namespace neve::sim::dust {

namespace {

/// Particles of dust from a particle of snow that sheds all it may while it is strained by 1.
constexpr double births_per_strain = 1;
/// Dust stays in the air where friction at the ground whirls it up faster than it sinks (Rouse
/// number 1); the friction velocity is about a tenth of the speed of the air (law of the wall).
constexpr double holding_speed = 10;
/// Share of a cell of air that is snow, from which on dust that comes to rest in it is gone.
constexpr double packed_fill = 0.6;

double ramp(double value, double threshold) {
  if (!(threshold > 0)) return value > 0 ? 1 : 0;
  return std::clamp(value / threshold - 1, 0.0, 1.0);
}

/// Returns a uniform number in [-1, 1).
double centred(std::uint64_t hash) {
  return 2 * unit_double(hash) - 1;
}

/// Three independent normal numbers. Source: Box and Muller (1958).
Vec3d normal_numbers(std::uint64_t key) {
  const auto radius = [&](std::uint64_t n) {
    return std::sqrt(-2 * std::log(1 - unit_double(mix64(key, n))));
  };
  const auto angle = [&](std::uint64_t n) {
    return 2 * std::numbers::pi * unit_double(mix64(key, n));
  };
  const double r = radius(1), a = angle(2);
  return {r * std::cos(a), r * std::sin(a), radius(3) * std::cos(angle(4))};
}

Vec3d vector(const double* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

enum class Fate : std::uint8_t { airborne, settled, faded };

/// The step of one particle of dust.
struct Flight {
  const Air& air;
  const Gusts& gusts;
  const Surroundings& around;
  Vec3d up;
  double drag_time;  ///< s, in which dust takes on the speed of the air

  Vec3d air_velocity(const Vec3d& x) const {
    const DustSettings& s = around.settings;
    const Vec3d u = air.velocity(x, s.wind);
    const double gust = s.turbulence * (u - s.wind).norm();
    return gust > 0 ? Vec3d(u + gust * gusts.at(x, around.time)) : u;
  }

  Fate take(Mote& mote) const {
    const DustSettings& s = around.settings;
    const double dt = around.dt;
    Vec3d x = vector(mote.x), v = vector(mote.v);
    // Exact in air of one velocity, for any dt.
    const Vec3d u = air_velocity(x), carried = u - s.settling_speed * up;
    const double left = drag_time > 0 ? std::exp(-dt / drag_time) : 0;
    x += dt * carried + drag_time * (1 - left) * (v - carried);
    v = carried + left * (v - carried);
    if (s.diffusion > 0)
      x += std::sqrt(2 * s.diffusion * dt) * normal_numbers(mix64(mote.key, around.step));
    Fate fate = leave_solid(u, x, v);
    if (fate == Fate::airborne && air.fill(x) > packed_fill && is_slow(u - air.snow_velocity(x)))
      fate = Fate::settled;
    mote.age += dt;
    if (fate == Fate::airborne && mote.life > 0 && mote.age > mote.life) fate = Fate::faded;
    for (int a = 0; a < 3; ++a) {
      mote.x[a] = x[a];
      mote.v[a] = v[a];
    }
    return fate;
  }

  bool is_slow(const Vec3d& speed) const {
    return speed.norm() < holding_speed * around.settings.settling_speed;
  }

  /// Dust that comes into a solid settles where the air is slow, and slides along it otherwise.
  Fate leave_solid(const Vec3d& u, Vec3d& x, Vec3d& v) const {
    if (!air.is_near_solid(x)) return Fate::airborne;
    // Two solids may meet there.
    for (int turn = 0; turn < 3; ++turn) {
      const Surface surface = around.solids.at(x);
      if (!(surface.distance < 0)) return Fate::airborne;
      if (is_slow(u - surface.velocity)) return Fate::settled;
      x += 1.001 * -surface.distance * surface.normal;
      const double into = (v - surface.velocity).dot(surface.normal);
      if (into < 0) v -= into * surface.normal;
    }
    return around.solids.at(x).distance < 0 ? Fate::settled : Fate::airborne;
  }
};

/// A particle of snow that sheds dust in a step: at a strain of 1 it would shed all of its dust.
struct Shed {
  double strain;
  std::size_t grain;
};

/// A particle of dust about to be born, of a mass in kg.
struct Birth {
  std::uint32_t id;  ///< of the snow
  std::size_t grain;
  double m;
};

std::vector<Shed> sheds_of(std::span<const SnowGrain> snow, const Air& air,
                           const Surroundings& around) {
  const DustSettings& s = around.settings;
  std::vector<Shed> sheds;
  for (std::size_t k = 0; k < snow.size(); ++k) {
    const SnowGrain& grain = snow[k];
    if (!(grain.dust > 0)) continue;
    const double speed = (grain.v - s.wind).norm();
    if (!(speed > s.speed)) continue;
    const double rate = air.strain_rate(grain.x);
    const double strain = rate * around.dt * shedding(s, speed, rate, grain.J_P, air.fill(grain.x));
    if (strain > 0) sheds.push_back({strain, k});
  }
  return sheds;
}

/// Returns a place near the snow, and outside of solids.
Vec3d place_of_birth(const SnowGrain& grain, const Solids& solids, double spacing,
                     std::uint64_t key) {
  Vec3d x = grain.x;
  for (int a = 0; a < 3; ++a)
    x[a] += spacing * centred(mix64(key, 100 + static_cast<std::uint64_t>(a)));
  if (solids.at(x).distance >= 0) return x;
  const Surface surface = solids.at(grain.x);
  return surface.distance < 0 ? Vec3d(grain.x - 1.001 * surface.distance * surface.normal)
                              : grain.x;
}

}  // namespace

double shedding(const DustSettings& settings, double speed, double strain_rate, double J_P,
                double fill) {
  if (J_P < settings.min_J_P) return 0;
  const double open = std::clamp(2 * (1 - fill), 0.0, 1.0);
  return open * ramp(speed, settings.speed) * ramp(strain_rate, settings.strain_rate);
}

void Cloud::shed(std::span<const SnowGrain> snow, const Air& air, const Surroundings& around,
                 double snow_spacing) {
  const auto most = static_cast<std::size_t>(around.settings.particles);
  if (motes.size() >= most) return;
  const std::vector<Shed> sheds = sheds_of(snow, air, around);
  double expected = 0;
  for (const Shed& shed : sheds) expected += births_per_strain * shed.strain;
  // Births take at most a share of the room that is left: it never ends.
  const auto left = static_cast<double>(most - motes.size());
  const double allowed = left * left / static_cast<double>(most);
  const double thinned = expected > allowed ? allowed / expected : 1;
  std::vector<Birth> births;
  for (const Shed& shed : sheds) {
    const SnowGrain& grain = snow[shed.grain];
    const double chance = 1 - std::exp(-births_per_strain * thinned * shed.strain);
    // The mass is what the strain asks for, however few are born.
    if (unit_double(mix64(mix64(around.step, 77), grain.id)) < chance)
      births.push_back({grain.id, shed.grain, grain.m * grain.dust * shed.strain / chance});
  }
  std::sort(births.begin(), births.end(),
            [](const Birth& a, const Birth& b) { return a.id < b.id; });
  for (const Birth& birth : births) {
    if (motes.size() >= most) break;
    const SnowGrain& grain = snow[birth.grain];
    const std::uint64_t key = ++totals.born;
    const Vec3d x = place_of_birth(grain, around.solids, snow_spacing, key);
    const double mean_life = around.settings.life;
    const double life = mean_life > 0 ? -mean_life * std::log(1 - unit_double(mix64(key, 200))) : 0;
    totals.born_mass += birth.m;
    motes.push_back(
        {{x.x(), x.y(), x.z()}, {grain.v.x(), grain.v.y(), grain.v.z()}, birth.m, 0, life, key});
  }
}

void Cloud::move(const Air& air, const Gusts& gusts, const Surroundings& around, ThreadPool& pool) {
  const double g = around.gravity.norm();
  const Flight flight{air, gusts, around, g > 0 ? Vec3d(-around.gravity / g) : Vec3d::Zero(),
                      g > 0 ? around.settings.settling_speed / g : 0};
  std::vector<Fate> fates(motes.size());
  pool.ranges(motes.size(), pool.thread_count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) fates[k] = flight.take(motes[k]);
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < motes.size(); ++k) {
    if (fates[k] == Fate::airborne) {
      motes[kept++] = motes[k];
    } else if (fates[k] == Fate::settled) {
      ++totals.settled;
      totals.settled_mass += motes[k].m;
    } else {
      ++totals.faded;
      totals.faded_mass += motes[k].m;
    }
  }
  motes.resize(kept);
}

}  // namespace neve::sim::dust
