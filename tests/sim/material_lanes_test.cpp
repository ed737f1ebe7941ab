/// Material kernels in lanes: accurate at every SIMD level, and blind to their neighbours.

#include "tests/support/material_accuracy.h"

namespace neve::test {
namespace {

/// tests/sim_long does the same with millions.
TEST(MaterialLanes, LanesMatchTheReferenceOnNastyMatrices) {
  MaterialAccuracy<float> in_float;
  in_float.check(1, 17000);
  expect_accurate(in_float, material_error_limit<float>, false);
  MaterialAccuracy<double> in_double;
  in_double.check(1, 17000);
  expect_accurate(in_double, material_error_limit<double>, false);
}

template <class Real>
struct Bits {
  Real number[16];
  bool operator==(const Bits& other) const {
    return std::memcmp(number, other.number, sizeof number) == 0;
  }
};

/// F_E, J_P and tau, so that not even a zero's sign gets away.
template <class Real>
Bits<Real> results_of(const sim::kernels::Particle<Real>& p) {
  Bits<Real> bits;
  std::copy_n(p.F_E, 9, bits.number);
  bits.number[9] = p.J_P;
  std::copy_n(p.tau, 6, bits.number + 10);
  return bits;
}

template <class Real>
void check_independence(sim::kernels::SimdLevel level) {
  SCOPED_TRACE(std::string(sim::kernels::name(level)) + (sizeof(Real) == 4 ? " float" : " double"));
  const auto table = nasty_materials<Real>();
  NastyParticles<Real> nasty(3);
  std::vector<sim::kernels::Particle<Real>> particles;
  for (int q = 0; q < 1500; ++q) particles.push_back(nasty.make(nasty.pick(nasty_kind_count)));
  // A value that is no number may not reach a neighbour either.
  particles[100].F_E[4] = std::numeric_limits<Real>::quiet_NaN();
  particles[200].F_E[8] = std::numeric_limits<Real>::infinity();
  particles[300].J_P = std::numeric_limits<Real>::infinity();
  const std::size_t count = particles.size();

  std::vector<Bits<Real>> alone;
  for (const auto& p : particles) {
    std::vector<sim::kernels::Particle<Real>> one{p};
    update_materials(one, table, level);
    alone.push_back(results_of(one[0]));
  }
  std::vector<std::size_t> order(count);
  for (std::size_t q = 0; q < count; ++q) order[q] = q;
  const auto expect_the_same = [&](const char* what) {
    std::vector<sim::kernels::Particle<Real>> shuffled;
    for (const std::size_t q : order) shuffled.push_back(particles[q]);
    update_materials(shuffled, table, level);
    int different = 0;
    for (std::size_t q = 0; q < count; ++q)
      different += results_of(shuffled[q]) == alone[order[q]] ? 0 : 1;
    EXPECT_EQ(different, 0) << what;
  };
  expect_the_same("as they came, models mixed");
  const auto model = [&](std::size_t q) { return particles[q].model(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return model(a) < model(b); });
  expect_the_same("models apart: full batches, materials mixed");
  std::mt19937 random(8);
  for (int trial = 0; trial < 3; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return model(a) < model(b); });
    expect_the_same("shuffled within models");
  }
  // One material after the other: constants come from a single row.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return particles[a].kind < particles[b].kind;
  });
  expect_the_same("materials apart");
}

TEST(MaterialLanes, LanesDependNeitherOnNeighboursNorOnTheirPlace) {
  for (const sim::kernels::SimdLevel level :
       {sim::kernels::SimdLevel::baseline, sim::kernels::SimdLevel::avx2,
        sim::kernels::SimdLevel::avx512}) {
    if (!sim::kernels::is_available(level)) continue;
    check_independence<float>(level);
    check_independence<double>(level);
  }
}

}  // namespace
}  // namespace neve::test
