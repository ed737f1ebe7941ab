/// Results of kernels for the samples of the view snow: the same on each instruction set.

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <random>

#include "render/light/light_fields.h"
#include "render/snow/grain_noise.h"
#include "render/snow/layer.h"
#include "snow_support.h"

namespace neve::render {
namespace {

using snow::Body;

/// Returns the kernels of each instruction set that this machine runs.
std::vector<const cpu::DrawKernels*> all_kernels() {
  std::vector<const cpu::DrawKernels*> kernels{&cpu::draw_baseline};
  if (&cpu::chosen_draw_kernels() != &cpu::draw_baseline)
    kernels.push_back(&cpu::chosen_draw_kernels());
  return kernels;
}

/// The two grains nearest to a place, from all there are.
/// @param along  their positions by axis
std::array<std::uint32_t, 2> nearest_of_all(const std::array<std::vector<float>, 3>& along,
                                            std::size_t count, Vec3f place) {
  std::array<std::uint64_t, 2> key{~0ull, ~0ull};
  for (std::uint32_t p = 0; p < count; ++p) {
    const Vec3f away = place - Vec3f{along[0][p], along[1][p], along[2][p]};
    const std::uint64_t own =
        std::uint64_t{std::bit_cast<std::uint32_t>(dot(away, away))} << 32 | p;
    key[1] = std::min(key[1], std::max(key[0], own));
    key[0] = std::min(key[0], own);
  }
  return {static_cast<std::uint32_t>(key[0]), static_cast<std::uint32_t>(key[1])};
}

TEST(Snow, NearestGrainsAreThoseOfAll) {
  const Body body = snow::make_body(torn_snow(160, 100).points, {}, nullptr);
  const float cell = body.field.cell;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> away(-cell, cell);
  constexpr int count = 500;
  std::vector<std::uint32_t> block;
  std::array<std::vector<float>, 3> node, world;
  std::vector<Vec3f> places;
  while (places.size() < count) {
    const Vec3f place = body.grains.grain[random() % body.grains.grain.size()].position +
                        Vec3f{away(random), away(random), away(random)};
    const snow::FieldPlace at = snow::find_place(body, place);
    if (at.block == surface::no_block) continue;
    places.push_back(place);
    block.push_back(at.block);
    for (int axis = 0; axis < 3; ++axis) {
      node[static_cast<std::size_t>(axis)].push_back(at.node[axis]);
      world[static_cast<std::size_t>(axis)].push_back(place[axis]);
    }
  }
  for (const cpu::DrawKernels* k : all_kernels()) {
    std::vector<std::uint32_t> first(count), second(count);
    std::vector<float> first_squared(count), second_squared(count);
    const auto& along = body.grains.along;
    k->find_nearest({count,
                     block.data(),
                     {node[0].data(), node[1].data(), node[2].data()},
                     {world[0].data(), world[1].data(), world[2].data()},
                     reinterpret_cast<const std::uint32_t(*)[27]>(body.field.near.data()),
                     body.grains.first.data(),
                     {along[0].data(), along[1].data(), along[2].data()},
                     first.data(),
                     second.data(),
                     first_squared.data(),
                     second_squared.data()});
    int sure = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const auto [nearest, next] = nearest_of_all(along, body.grains.grain.size(), places[n]);
      // Grains are looked for up to a node away at least, and up to three at most.
      if (first[n] == surface::no_block || first_squared[n] > cell * cell) continue;
      EXPECT_EQ(first[n], nearest) << k->simd;
      if (second[n] == surface::no_block || second_squared[n] > cell * cell) continue;
      ++sure;
      EXPECT_EQ(second[n], next) << k->simd;
    }
    EXPECT_GT(sure, count / 4);
  }
}

TEST(Snow, AmongGrainsEquallyNearThatOfTheLowerNumberComesFirst) {
  // One row of cubes with grains on both sides of a place, at whole distances: many are equally
  // near, side by side in a vector, in one lane of several, and in several vectors.
  const std::uint32_t near[27] = {cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, 0};
  std::mt19937 random(11);
  for (int round = 0; round < 400; ++round) {
    const std::size_t count = round % 40;
    std::array<std::vector<float>, 3> along;
    for (std::vector<float>& a : along) {
      for (std::size_t p = 0; p < count; ++p)
        a.push_back(static_cast<float>(static_cast<int>(random() % 5) - 2));
      a.resize(count + snow::grain_margin);
    }
    // All of them in the cube of the place; the others are empty.
    std::vector<std::uint32_t> first(cpu::cubes_per_block + 1, 0);
    const std::size_t cube = 1 << 4 | 1 << 2 | 1;
    std::fill(first.begin() + cube + 1, first.end(), static_cast<std::uint32_t>(count));
    const auto [expected, next] = nearest_of_all(along, count, {});
    const std::uint32_t block = 0;
    const float node = 3, world = 0;
    for (const cpu::DrawKernels* k : all_kernels()) {
      std::uint32_t nearest = 0, second = 0;
      float nearest_squared = 0, second_squared = 0;
      k->find_nearest({1,
                       &block,
                       {&node, &node, &node},
                       {&world, &world, &world},
                       &near,
                       first.data(),
                       {along[0].data(), along[1].data(), along[2].data()},
                       &nearest,
                       &second,
                       &nearest_squared,
                       &second_squared});
      EXPECT_EQ(nearest, expected) << k->simd << ' ' << round;
      EXPECT_EQ(second, next) << k->simd << ' ' << round;
    }
  }
}

TEST(Snow, NearLightInLanesIsThatOfOnePlace) {
  const Body body = snow::make_body(torn_snow(160, 100).points, {}, nullptr);
  const snow::SnowLight light{normalized(Vec3f{0.3f, 0.8f, -0.4f}), 1, 1, false};
  light::LightVolume open;  // all light arrives from afar
  const Vec3i cells = open.grid.size;
  open.light.assign(static_cast<std::size_t>(2 * cells.x * cells.y * cells.z), 65535);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> along(-0.5f, 8.5f), unit(-1, 1);
  const auto near = std::make_unique<snow::NearField>();
  constexpr std::size_t count = 50, size = 64;
  int shaded = 0;
  for (std::uint32_t block = 0; block < body.field.block.size(); block += 3) {
    near->take(body.field, block);
    std::array<std::array<float, size>, 3> place{}, normal{}, found{};
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3f outward = normalized(Vec3f{unit(random), unit(random), unit(random)});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis][n] = along(random);
        normal[axis][n] = outward[static_cast<int>(axis)];
      }
    }
    for (const cpu::DrawKernels* k : all_kernels()) {
      k->light_near({count,
                     near->values(),
                     {place[0].data(), place[1].data(), place[2].data()},
                     {normal[0].data(), normal[1].data(), normal[2].data()},
                     light.toward,
                     found[0].data(),
                     found[1].data(),
                     found[2].data()});
      for (std::size_t n = 0; n < count; ++n) {
        snow::SnowPlace at;
        at.block = block;
        at.node = {place[0][n], place[1][n], place[2][n]};
        const Vec3f outward{normal[0][n], normal[1][n], normal[2][n]};
        const snow::Exposure one = snow::expose(body, open, light, at, outward);
        const snow::Exposure lanes =
            snow::expose(open, light, at, outward, {found[0][n], found[1][n], found[2][n]});
        EXPECT_EQ(one.sun, lanes.sun) << k->simd;
        EXPECT_EQ(one.through, lanes.through) << k->simd;
        EXPECT_EQ(one.crevice, lanes.crevice) << k->simd;
        shaded += one.sun < 0.9f && one.crevice < 0.9f ? 1 : 0;
      }
    }
  }
  EXPECT_GT(shaded, 100);
}

/// Samples of grains, and room for whole vectors of them.
template <std::size_t size>
struct GrainSamples {
  std::array<std::uint32_t, size> grain{};
  std::array<std::array<float, size>, 3> world{};
  std::array<float, size> sample_size{};

  /// Albedo, slope, height and facet.
  using Looks = std::array<std::array<float, size>, 10>;
  Looks look(const cpu::DrawKernels& kernels, int count, float spacing, const cpu::Grain* grains,
             bool wants_facets) const {
    const snow::GrainNoise& noise = snow::grain_noise();
    Looks to{};
    kernels.look_at_grains({count,
                            spacing,
                            grains,
                            {noise.texels(0), noise.texels(1), noise.texels(2)},
                            grain.data(),
                            {world[0].data(), world[1].data(), world[2].data()},
                            sample_size.data(),
                            wants_facets,
                            {to[0].data(), to[1].data(), to[2].data()},
                            {to[3].data(), to[4].data(), to[5].data()},
                            to[6].data(),
                            {to[7].data(), to[8].data(), to[9].data()}});
    return to;
  }
};

/// Relief of a grain at its origin, which has not turned and whose seed shifts nothing.
struct SeenRelief {
  float height;
  Vec3f slope;
};

/// @param place  in spacings from the grain @param pixels  samples per spacing
SeenRelief relief_at(const cpu::DrawKernels& kernels, Vec3f place, float pixels) {
  const cpu::Grain grain{{}, 0xffffffffu, 0, {32767, 0, 0, 0}};
  GrainSamples<cpu::max_light_lanes> samples;
  for (std::size_t axis = 0; axis < 3; ++axis)
    samples.world[axis][0] = place[static_cast<int>(axis)];
  samples.sample_size[0] = 1 / pixels;
  const auto look = samples.look(kernels, 1, 1, &grain, false);
  EXPECT_EQ(look[0][0], 1.0f);
  return {look[6][0], {look[3][0], look[4][0], look[5][0]}};
}

TEST(Snow, ReliefHasTheSlopeOfItsHeight) {
  for (const cpu::DrawKernels* kernels : all_kernels())
    for (const float pixels : {10.0f, 5.0f, 2.0f}) {  // one for each level of the noise
      double sum = 0, worst = 0;
      for (int n = 0; n < 500; ++n) {
        const float f = static_cast<float>(n);
        const Vec3f p = Vec3f{0.37f * f, 0.61f * f - 20, 0.93f * f} * (1 / 1.4f);
        // Central differences over a texel: exactly the table's own at its nodes, and means of them
        // between. A spacing has 1.4 units of eight texels.
        constexpr float d = 1.0f / 8 / 1.4f;
        const auto height = [&](Vec3f at) {
          return static_cast<double>(relief_at(*kernels, at, pixels).height);
        };
        const SeenRelief here = relief_at(*kernels, p, pixels);
        for (int axis = 0; axis < 3; ++axis) {
          Vec3f step{};
          step[axis] = d;
          const double slope = (height(p + step) - height(p - step)) / (2 * static_cast<double>(d));
          worst = std::max(worst, std::abs(slope - static_cast<double>(here.slope[axis])));
        }
        sum += static_cast<double>(here.height);
        EXPECT_LT(std::abs(here.height), 1.2f);
      }
      EXPECT_LT(worst, 1e-3) << pixels;  // rounding of places up to 500 units away, and of 1.4
      EXPECT_LT(std::abs(sum / 500), 0.05) << pixels;
    }
}

TEST(Snow, LooksOfGrainsDoNotDependOnTheInstructionSet) {
  constexpr std::size_t grains = 40, count = 61, size = 64;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<cpu::Grain> list(grains);
  for (cpu::Grain& grain : list) {
    grain.position = {unit(random), unit(random), unit(random)};
    grain.color = static_cast<unsigned>(random());
    grain.seed = static_cast<unsigned>(random());
    double q[4], squared = 0;
    for (double& part : q) {
      part = static_cast<double>(unit(random));
      squared += part * part;
    }
    for (int n = 0; n < 4; ++n)
      grain.turn[n] = static_cast<short>(std::lround(32767 * q[n] / std::sqrt(squared)));
  }
  GrainSamples<size> samples;
  for (std::size_t n = 0; n < size; ++n) {
    samples.grain[n] = static_cast<std::uint32_t>(random() % grains);
    for (auto& axis : samples.world) axis[n] = unit(random);
    samples.sample_size[n] = 0.01f + 0.2f * std::abs(unit(random));
  }
  std::vector<GrainSamples<size>::Looks> looks;
  int facets = 0, without = 0;
  for (const cpu::DrawKernels* k : all_kernels()) {
    const auto& to =
        looks.emplace_back(samples.look(*k, static_cast<int>(count), 0.3f, list.data(), true));
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3f facet{to[7][n], to[8][n], to[9][n]};
      const bool is_seen = 0.3f / samples.sample_size[n] > cpu::min_sparkling;
      (is_seen ? facets : without) += 1;
      EXPECT_NEAR(length(facet), is_seen ? 1 : 0, 1e-6) << k->simd;
      const float root = static_cast<float>(list[samples.grain[n]].color & 0xff) / 255;
      EXPECT_NEAR(to[0][n], root * root, 1e-6) << k->simd;
      for (std::size_t kind = 0; kind < to.size(); ++kind)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(to[kind][n]),
                  std::bit_cast<std::uint32_t>(looks[0][kind][n]))
            << k->simd << ' ' << kind;
    }
  }
  EXPECT_GT(facets, 10);
  EXPECT_GT(without, 10);
}

}  // namespace
}  // namespace neve::render
