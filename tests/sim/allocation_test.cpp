/// A step in steady state asks for no memory, and a simulation needs what was estimated.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include "tests/support/snow.h"

namespace {

std::atomic<std::size_t> allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  if (void* p = std::aligned_alloc(alignment, whole > 0 ? whole : alignment)) return p;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) {
  return counted(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
// std::stable_sort asks for its buffer so; what deletes it is defined here too.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return counted(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
// Inlined, GCC would see free() beside the new that it knows, and call them mismatched.
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

std::size_t allocations_in_steps(Simulation& simulation, double dt, int warm_up, int steps) {
  for (int k = 0; k < warm_up; ++k) simulation.step(dt);
  const std::size_t before = allocations;
  for (int k = 0; k < steps; ++k) simulation.step(dt);
  return allocations - before;
}

SolverSettings coarse() {
  SolverSettings s;
  s.cell_size = 0.02;
  return s;
}

/// One particle per cell, in flight together and past each other.
ParticleArrays spray() {
  ParticleArrays p = box_of_snow({0, 0.2, 0}, {0.4, 0.6, 0.4}, 0.02);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> speed(-0.3, 0.3);
  for (Vec3d& v : p.v) v = {2 + speed(random), -3 + speed(random), speed(random)};
  return p;
}

TEST(Memory, StepsOfPackedSnowAllocateNothing) {
  const ParticleArrays p = ball_of_snow({0.01, 0.17, -0.02}, 0.13, 0.01, {0.3, -4, 0.1});
  for (const Transfer transfer : {Transfer::flip, Transfer::asflip})
    for (const int threads : {1, 2}) {
      SolverSettings settings = coarse();
      settings.transfer = transfer;
      Simulation simulation(settings, {Material{}}, {plane({0, 0.013, 0}, {0, 1, 0}, 0.5)}, p,
                            threads);
      EXPECT_EQ(allocations_in_steps(simulation, 1e-4, 64, 64), 0u) << threads << " threads";
    }
}

/// Blocks come and go in flight, so that a buffer may grow by a quarter once in a while.
TEST(Memory, StepsOfSprayAllocateNextToNothing) {
  for (const int threads : {1, 2}) {
    Simulation simulation(coarse(), {Material{}}, {plane({0, 0.013, 0}, {0, 1, 0}, 0.5)}, spray(),
                          threads);
    EXPECT_LE(allocations_in_steps(simulation, 1e-4, 96, 64), 2u) << threads << " threads";
  }
}

TEST(Memory, PackedSnowTakesLessThanThreeHundredBytesPerParticle) {
  // 97336 particles, 8 per cell.
  const ParticleArrays p = box_of_snow({0, 0, 0}, {0.46, 0.46, 0.46}, 0.01);
  Simulation simulation(coarse(), {Material{}}, {}, p, 2);
  for (int k = 0; k < 4; ++k) simulation.step(1e-4);
  const double bytes = static_cast<double>(simulation.memory_bytes());
  EXPECT_LT(bytes, 300 * static_cast<double>(p.x.size()));
  EXPECT_LT(bytes, static_cast<double>(estimate_memory(p.x.size(), 8, coarse(), 2)));
}

/// MLS keeps one number a node and component where FLIP keeps two, also from the start on.
TEST(Memory, StepsOfMlsTakeLessThanThoseOfFlip) {
  const ParticleArrays p = box_of_snow({0, 0, 0}, {0.2, 0.2, 0.2}, 0.01);
  const auto bytes_of = [&](Transfer transfer) {
    SolverSettings settings = coarse();
    settings.transfer = transfer;
    Simulation simulation(settings, {Material{}}, {}, p, 1);
    simulation.step(1e-4);
    return static_cast<double>(simulation.memory_bytes());
  };
  EXPECT_LT(bytes_of(Transfer::mls), 0.9 * bytes_of(Transfer::flip));
}

TEST(Memory, OneParticleFarAwayTakesOneBlock) {
  const ParticleArrays near = box_of_snow({0, 0, 0}, {0.2, 0.2, 0.2}, 0.01);
  ParticleArrays both = near;
  both.x.push_back({20000, 0, 0});
  both.v.push_back(Vec3d::Zero());
  both.m.push_back(near.m[0]);
  both.V0.push_back(near.V0[0]);
  Simulation a(coarse(), {Material{}}, {}, near, 1), b(coarse(), {Material{}}, {}, both, 1);
  EXPECT_LT(b.memory_bytes(), a.memory_bytes() + 100000);
}

}  // namespace
