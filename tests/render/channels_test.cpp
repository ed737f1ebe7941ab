/// Channels of a picture: each holds what it says, and the file gives it back.

#include "render/channels/channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "both_ways.h"
#include "render/frame/colormap.h"
#include "render/image/exr.h"
#include "render/image/exr_header.h"
#include "render/image/jpeg.h"
#include "render/image/mean_image.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

using channels::Pass;

const std::set<Pass> all_passes = {Pass::depth,  Pass::position, Pass::normal,   Pass::albedo,
                                   Pass::direct, Pass::indirect, Pass::emission, Pass::shadow,
                                   Pass::motion, Pass::id,       Pass::body,     Pass::collider};

/// Everything at rest, all in body 0.
channels::Request request_for(const Frame& frame) {
  channels::Request request;
  request.passes = all_passes;
  request.before = request.after = frame.camera;
  request.interval = 0.1f;
  request.velocity.resize(frame.points.position.size());
  request.body.resize(frame.points.position.size());
  request.meshes.resize(frame.meshes.size());
  request.grounds.resize(frame.grounds.size());
  return request;
}

class Drawn {
 public:
  Drawn(gl::Context& context, const Frame& frame, const channels::Request& request,
        ParticlePath path = ParticlePath::cpu)
      : picture_(decode_exr(
            encode_exr(Renderer(context, {}, nullptr, path).draw_channels(frame, request)))) {}

  float at(const std::string& channel, int x, int y) const {
    return all(channel).at(static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                           static_cast<std::size_t>(x));
  }
  std::vector<float> all(const std::string& channel) const {
    const ExrChannel* found = picture_.find(channel);
    EXPECT_NE(found, nullptr) << channel;
    return found ? numbers_of(*found) : std::vector<float>(1u << 20);
  }
  std::array<std::vector<float>, 3> vectors(const std::string& layer) const {
    return {all(layer + ".X"), all(layer + ".Y"), all(layer + ".Z")};
  }
  const ExrPicture& picture() const { return picture_; }

 private:
  ExrPicture picture_;
};

/// One sphere of radius 0.2 m at the middle of a picture that is one metre high there.
Frame one_sphere() {
  Frame frame = small_frame();
  frame.points.radius = 0.2f;
  frame.points.spacing = 0.3f;
  frame.points.position = {{0, 0, 0}};
  frame.points.id = {77};
  return frame;
}

TEST(Channels, DepthAndPositionAreThoseOfASphere) {
  OPEN_OR_SKIP(context, "auto");
  for (const int samples : {1, 2}) {
    Frame frame = one_sphere();
    frame.supersampling = samples;
    const Drawn drawn(*context, frame, request_for(frame));
    int seen = 0;
    const std::vector<float> z = drawn.all("depth.Z"), x = drawn.all("position.X"),
                             y = drawn.all("position.Y"), height = drawn.all("position.Z");
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (z[i] == channels::nothing_depth) continue;
      ++seen;
      // The eye is 2 m before the centre and looks along -z.
      EXPECT_NEAR(height[i], 2 - z[i], 1e-5f);
      EXPECT_NEAR(length(Vec3f{x[i], y[i], height[i]}), 0.2f, 1e-4f);
    }
    // A disc of 0.4 m, seen from 2 m, in a picture of 90 pixels a metre: a share of rounding.
    EXPECT_NEAR(seen, 3.14159f * 18.1f * 18.1f, 70) << samples;
    EXPECT_NEAR(drawn.at("depth.Z", 60, 45), 1.8f, 1e-3f);
  }
}

TEST(Channels, NormalsAreOfUnitLengthAndPointOutwards) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = one_sphere();
  const Drawn drawn(*context, frame, request_for(frame));
  const std::vector<float> z = drawn.all("depth.Z");
  const std::array normal = drawn.vectors("normal"), position = drawn.vectors("position");
  for (std::size_t i = 0; i < z.size(); ++i) {
    const Vec3f n = {normal[0][i], normal[1][i], normal[2][i]};
    const Vec3f p = {position[0][i], position[1][i], position[2][i]};
    if (z[i] == channels::nothing_depth) {
      EXPECT_EQ(length(n), 0);
      continue;
    }
    // Half floats have 11 bits.
    EXPECT_NEAR(length(n), 1, 2e-3f);
    EXPECT_NEAR(dot(n, p), 0.2f, 5e-4f);
  }
}

TEST(Channels, NumbersAreThoseOfTheParticleInThePixel) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(160, 100);
  for (std::uint32_t& id : frame.points.id.edit()) id = 5 * id + 3;
  channels::Request request = request_for(frame);
  for (std::size_t i = 0; i < request.body.size(); ++i)
    request.body[i] = static_cast<std::int32_t>(i % 3);
  request.numbers = {{"v", {"X", "Y"}, {}}};
  for (std::size_t i = 0; i < request.body.size(); ++i)
    request.numbers[0].value.insert(request.numbers[0].value.end(),
                                    {static_cast<float>(i), -static_cast<float>(i)});
  const Drawn drawn(*context, frame, request);
  const std::vector<float> id = drawn.all("id.Y"), body = drawn.all("body.Y"), v = drawn.all("v.X"),
                           w = drawn.all("v.Y");
  const std::array position = drawn.vectors("position");
  int seen = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (id[i] == channels::no_number) continue;
    const auto point = static_cast<std::size_t>((id[i] - 3) / 5);
    EXPECT_EQ(v[i], static_cast<float>(point));
    EXPECT_EQ(w[i], -v[i]);
    EXPECT_EQ(body[i], static_cast<float>(point % 3));
    const Vec3f p = {position[0][i], position[1][i], position[2][i]};
    EXPECT_NEAR(length(p - frame.points.position.at(point)), frame.points.radius, 1e-4f);
    ++seen;
  }
  EXPECT_GT(seen, 1000);
}

/// Small spheres do not cover the surface of the snow: those behind it are others.
TEST(Channels, NumbersOfTheSnowSurfaceAreThoseOfAParticleThere) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(160, 100);
  frame.has_snow_surface = true;
  frame.points.radius = 0.3f * frame.points.spacing;
  const Drawn drawn(*context, frame, request_for(frame));
  const std::vector<float> id = drawn.all("id.Y"), body = drawn.all("body.Y"),
                           height = drawn.all("position.Y"), depth = drawn.all("depth.Z");
  const std::array position = drawn.vectors("position");
  int seen = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (depth[i] == channels::nothing_depth || height[i] < -0.415f) continue;
    ASSERT_NE(id[i], channels::no_number);
    EXPECT_EQ(body[i], 0);
    const Vec3f p = {position[0][i], position[1][i], position[2][i]};
    const auto point = static_cast<std::size_t>(id[i]);
    EXPECT_LE(length(p - frame.points.position.at(point)), 1.6f * frame.points.spacing);
    ++seen;
  }
  EXPECT_GT(seen, 1000);
}

TEST(Channels, MotionIsTheProjectedDisplacement) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = one_sphere();
  frame.meshes.push_back(shapes::box_mesh({0.4f, 0, 0}, {0.1f, 0.3f, 0.02f}));
  channels::Request request = request_for(frame);
  request.velocity = {{0.5f, 0.25f, 0}};
  request.meshes[0].after.offset = {0, -0.1f, 0};
  request.meshes[0].before.offset = {0, 0.1f, 0};
  for (const int samples : {1, 2}) {
    frame.supersampling = samples;
    const Drawn drawn(*context, frame, request);
    const auto expect = [&](int x, int y, float u, float v) {
      // A picture of 90 pixels shows a metre at a distance of 2 m.
      const float per_metre = 90 * 2 / drawn.at("depth.Z", x, y);
      EXPECT_NEAR(drawn.at("forward.u", x, y), u * per_metre, 0.01f);
      EXPECT_NEAR(drawn.at("forward.v", x, y), v * per_metre, 0.01f);
      EXPECT_NEAR(drawn.at("backward.u", x, y), -u * per_metre, 0.01f);
      EXPECT_NEAR(drawn.at("backward.v", x, y), -v * per_metre, 0.01f);
    };
    expect(60, 45, 0.05f, 0.025f);
    expect(96, 45, 0, -0.1f);
  }
}

TEST(Channels, MotionFollowsTheCamera) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = one_sphere();
  channels::Request request = request_for(frame);
  request.after.eye.x += 0.1f;
  request.after.target.x += 0.1f;
  const Drawn drawn(*context, frame, request);
  EXPECT_NEAR(drawn.at("forward.u", 60, 45), -0.1f * 90 * 2 / 1.8f, 0.02f);
  EXPECT_NEAR(drawn.at("backward.u", 60, 45), 0, 0.01f);
}

TEST(Channels, CollidersHaveTheirNumbers) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = one_sphere();
  frame.grounds.push_back({.point = {0, -0.3f, 0}});
  for (int k = 0; k < 300; ++k)  // two bytes of numbers
    frame.meshes.push_back(
        shapes::box_mesh({0.4f, 0, k == 299 ? 0.0f : -3.0f}, {0.1f, 0.3f, 0.1f}));
  channels::Request request = request_for(frame);
  request.grounds[0].collider = 4;
  for (std::size_t m = 0; m < 300; ++m) request.meshes[m].collider = static_cast<int>(m + 1000);
  const Drawn drawn(*context, frame, request);
  EXPECT_EQ(drawn.at("collider.Y", 96, 45), 1299);
  EXPECT_EQ(drawn.at("collider.Y", 60, 85), 4);
  EXPECT_EQ(drawn.at("collider.Y", 60, 45), channels::no_number);
  EXPECT_EQ(drawn.at("id.Y", 60, 45), 77);
  EXPECT_EQ(drawn.at("id.Y", 96, 45), channels::no_number);
}

Frame lit_scene() {
  Frame frame = rough_ball(160, 100);
  frame.meshes.push_back(shapes::box_mesh({0.35f, -0.2f, 0.3f}, {0.2f, 0.4f, 0.2f}));
  return frame;
}

/// The same snow as spheres, or as a surface.
class PartsOfLight : public testing::TestWithParam<bool> {
 protected:
  static Frame scene() {
    Frame frame = lit_scene();
    frame.has_snow_surface = GetParam();
    return frame;
  }
};
INSTANTIATE_TEST_SUITE_P(Channels, PartsOfLight, testing::Bool(), [](const auto& is_surface) {
  return is_surface.param ? "surface" : "spheres";
});

TEST_P(PartsOfLight, AddUpToTheBeauty) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = scene();
  const Drawn drawn(*context, frame, request_for(frame));
  for (const char* color : {"R", "G", "B"}) {
    const std::string dot_color = std::string(".") + color;
    const auto beauty = drawn.all(color), direct = drawn.all("direct" + dot_color),
               indirect = drawn.all("indirect" + dot_color),
               emission = drawn.all("emission" + dot_color),
               shadow = drawn.all("shadow" + dot_color);
    float darkest = 1, brightest = 0;
    for (std::size_t i = 0; i < beauty.size(); ++i) {
      // Four roundings to 11 bits.
      EXPECT_NEAR(direct[i] + indirect[i] + emission[i], beauty[i], 2e-3f * beauty[i] + 1e-4f);
      EXPECT_LE(shadow[i], 1.001f);
      darkest = std::min(darkest, shadow[i]);
      brightest = std::max(brightest, direct[i]);
    }
    EXPECT_LT(darkest, 0.3f);
    EXPECT_GT(brightest, 0.3f);
  }
}

/// A holdout hides what is behind it and shows the background, which no sun of the scene lights.
TEST_P(PartsOfLight, TheBackgroundBehindAHoldoutIsEmission) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = scene();
  frame.grounds.clear();
  frame.meshes = {shapes::box_mesh({0, -0.3f, 0}, {0.8f, 0.1f, 0.8f})};
  frame.meshes[0].is_holdout = true;
  const Drawn drawn(*context, frame, request_for(frame));
  const auto id = drawn.all("id.Y"), depth = drawn.all("depth.Z"), beauty = drawn.all("G"),
             emission = drawn.all("emission.G"), direct = drawn.all("direct.G"),
             indirect = drawn.all("indirect.G"), shadow = drawn.all("shadow.G");
  int seen = 0, shaded = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    // Pixels of the slab alone; the data of a holdout are nothing.
    if (id[i] >= 0 || depth[i] < channels::nothing_depth) continue;
    EXPECT_NEAR(emission[i], beauty[i], 2e-3f);
    EXPECT_NEAR(direct[i], 0, 1e-4f);
    EXPECT_NEAR(indirect[i], 0, 1e-4f);
    ++seen;
    shaded += shadow[i] < 0.8f;
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(shaded, 20) << "the sun's shadow on the slab";
}

TEST_P(PartsOfLight, SnowEmitsNone) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = scene();
  // The box lies between the sun and the snow.
  frame.meshes.push_back(shapes::box_mesh({-0.45f, 0.45f, 0.3f}, {0.3f, 0.1f, 0.3f}));
  const Drawn drawn(*context, frame, request_for(frame));
  const auto id = drawn.all("id.Y"), albedo = drawn.all("albedo.G"),
             emission = drawn.all("emission.G"), direct = drawn.all("direct.G"),
             indirect = drawn.all("indirect.G"), shadow = drawn.all("shadow.G");
  int seen = 0, shaded = 0;
  float brightest = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (id[i] < 0) continue;
    ++seen;
    EXPECT_NEAR(emission[i], 0, 1e-4f);
    EXPECT_GT(albedo[i], 0.7f);  // that of snow, whatever falls on it
    EXPECT_LE(albedo[i], 1);
    EXPECT_GT(indirect[i], 0.01f);
    brightest = std::max(brightest, direct[i]);
    if (shadow[i] < 0.7f) ++shaded;
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(shaded, 20);
  EXPECT_GT(brightest, 0.5f);
}

/// Mean of the values of particles around a place, weighted as the surface weighs their snow.
float weighted_value(const Points& points, Vec3f place) {
  const float width = 0.8f * points.spacing;  // of the kernel
  double sum = 0, total = 0;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const Vec3f away = (points.position[p] - place) * (1 / width);
    const float squared = dot(away, away);
    if (squared > 20) continue;
    const double w = std::exp(-0.5 * static_cast<double>(squared));
    sum += w * static_cast<double>(points.value[p]);
    total += w;
  }
  return static_cast<float>(sum / total);
}

float linear_of(std::uint8_t srgb) {
  const float c = static_cast<float>(srgb) / 255;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

/// Largest difference from the color of a value, in linear light.
float difference_from(ColorMap map, float value, const std::array<float, 3>& seen) {
  const Rgb8 color = map_color(map, value);
  return std::max({std::abs(linear_of(color.r) - seen[0]), std::abs(linear_of(color.g) - seen[1]),
                   std::abs(linear_of(color.b) - seen[2])});
}

TEST(SnowValues, AColorIsThatOfTheSnowAroundItsPlaceByOpenGlAndOnTheCpu) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(160, 100);
  frame.has_snow_surface = true;
  frame.grounds.clear();
  frame.points.colormap = ColorMap::viridis;
  constexpr float steepest = 2.6f;  // values a metre
  for (const Vec3f& p : frame.points.position)
    frame.points.value.edit().push_back(0.5f + 0.5f * std::sin(2 * steepest * p.x));
  frame.points.range_min = 0;
  frame.points.range_max = 1;
  // A place has the color of the grains nearest to it, whose particles are up to 1.2 spacings away,
  // and snow around a place of the surface lies on average half a spacing inside.
  const float tolerance = 1.7f * frame.points.spacing * steepest;
  for (const ParticlePath path : {ParticlePath::gl, ParticlePath::cpu}) {
    const Drawn drawn(*context, frame, request_for(frame), path);
    const std::array position = drawn.vectors("position");
    const std::array albedo{drawn.all("albedo.R"), drawn.all("albedo.G"), drawn.all("albedo.B")};
    const std::vector<float> z = drawn.all("depth.Z");
    int seen = 0, wrong = 0;
    float lowest = 1, highest = 0;
    for (std::size_t i = 0; i < z.size(); i += 3) {
      if (z[i] == channels::nothing_depth) continue;
      const float value =
          weighted_value(frame.points, {position[0][i], position[1][i], position[2][i]});
      float least = 1;
      for (int step = -40; step <= 40; ++step)
        least = std::min(least, difference_from(ColorMap::viridis,
                                                value + tolerance * static_cast<float>(step) / 40,
                                                {albedo[0][i], albedo[1][i], albedo[2][i]}));
      ++seen;
      // Bytes of square roots, eleven bits, steps between the values, and mixes of two grains.
      if (least > 0.02f) ++wrong;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    EXPECT_GT(seen, 500);
    EXPECT_LE(wrong, seen / 100);
    EXPECT_LT(lowest, 0.15f);
    EXPECT_GT(highest, 0.85f);
  }
}

/// Returns the tone of shaders/shade.frag.
float tone_mapped(float c) {
  c *= 0.8f;
  c = c * (1 + c / 4.84f) / (1 + 0.55f * c);
  return std::pow(std::min(c, 1.0f), 1 / 2.2f);
}

TEST_P(PartsOfLight, ToneMappedBeautyIsThePicture) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = scene();
  const Drawn drawn(*context, frame, request_for(frame));
  const Image picture = Renderer(*context, {}, nullptr, ParticlePath::cpu).draw(frame);
  const std::array planes = {drawn.all("R"), drawn.all("G"), drawn.all("B")};
  double sum = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const float difference = 255 * tone_mapped(planes[i % 3][i / 3]) - picture.pixels[i];
    // Half a step of rounding, half a step of dither, and rounding to 11 bits. A surface has its
    // light in 8 bits on the way to the picture.
    EXPECT_LE(std::abs(difference), GetParam() ? 1.9f : 1.3f);
    sum += difference;
  }
  EXPECT_NEAR(sum / static_cast<double>(picture.pixels.size()), 0, 0.05);
}

TEST(Channels, OpenGlAndTheCpuGiveTheSame) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = lit_scene();
  const Drawn gl(*context, frame, request_for(frame), ParticlePath::gl),
      cpu(*context, frame, request_for(frame), ParticlePath::cpu);
  for (const ExrChannel& channel : cpu.picture().channels)
    EXPECT_EQ(gl.all(channel.name), cpu.all(channel.name)) << channel.name;
}

TEST(Channels, CoverIsThatOfATransparentPicture) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = one_sphere();
  frame.is_transparent = true;
  const Drawn drawn(*context, frame, request_for(frame));
  EXPECT_EQ(drawn.at("A", 60, 45), 1);
  EXPECT_EQ(drawn.at("A", 3, 3), 0);
  EXPECT_EQ(drawn.at("R", 3, 3), 0);
  EXPECT_GT(drawn.at("R", 60, 45), 0.1f);
}

TEST(Channels, LightIsAveragedOverTheMomentsOfTheShutter) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = one_sphere();
  frame.is_transparent = true;
  channels::Request request = request_for(frame);
  request.moments = {2, [&](int k) {
                       Frame moment = frame;
                       moment.points.position = {{k == 0 ? -0.3f : 0.3f, 0, 0}};
                       return moment;
                     }};
  const Drawn drawn(*context, frame, request);
  EXPECT_FLOAT_EQ(drawn.at("A", 33, 45), 0.5f);
  EXPECT_FLOAT_EQ(drawn.at("A", 87, 45), 0.5f);
  EXPECT_EQ(drawn.at("A", 60, 45), 0);
  EXPECT_EQ(drawn.at("id.Y", 60, 45), 77);
  EXPECT_EQ(drawn.at("id.Y", 33, 45), channels::no_number);
}

TEST(Channels, RequestsThatDoNotFitAreRefused) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = one_sphere();
  channels::Request request = request_for(frame);
  request.velocity.clear();
  Renderer renderer(*context);
  EXPECT_THROW(renderer.draw_channels(frame, request), std::invalid_argument);
}

TEST(Plate, StaysAsItIsWhereNothingIsBeforeItAndNoShadowFalls) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(160, 100);
  Image plate{160, 100, 3, std::vector<std::uint8_t>(160 * 100 * 3)};
  for (std::size_t i = 0; i < plate.pixels.size(); ++i)
    plate.pixels[i] = static_cast<std::uint8_t>(i * 7 % 256);
  Renderer renderer(*context);
  const Image drawn = renderer.draw_on_plate(frame, plate);
  frame.is_transparent = true;
  const Image front = renderer.draw(frame);  // with the ground, which fades out
  int same = 0, darker = 0, brighter = 0;
  for (std::size_t p = 0; p < 160 * 100; ++p) {
    if (front.pixels[4 * p + 3] == 255 && front.pixels[4 * p] > 90) continue;  // snow
    int change = 0;
    for (std::size_t c = 0; c < 3; ++c) change += drawn.pixels[3 * p + c] - plate.pixels[3 * p + c];
    same += std::abs(change) <= 3 ? 1 : 0;
    darker += change < -12 ? 1 : 0;
    brighter += front.pixels[4 * p + 3] == 0 && change > 3 ? 1 : 0;
  }
  EXPECT_GT(same, 4000);
  EXPECT_GT(darker, 200) << "the ball throws no shadow";
  EXPECT_EQ(brighter, 0);
}

TEST(Plate, OfAnotherSizeIsRefused) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image plate{8, 8, 3, std::vector<std::uint8_t>(192)};
  EXPECT_THROW(renderer.draw_on_plate(rough_ball(16, 10), plate), std::invalid_argument);
}

TEST(MeanImage, OfEqualPicturesIsThePicture) {
  const Image image{2, 1, 4, {10, 200, 31, 7, 90, 3, 255, 255}};
  MeanImage mean;
  for (int k = 0; k < 5; ++k) mean.add(image);
  EXPECT_EQ(mean.mean().pixels, image.pixels);
}

TEST(MeanImage, TransparentPixelsHaveNoColour) {
  MeanImage mean;
  mean.add({1, 1, 4, {200, 100, 40, 255}});
  mean.add({1, 1, 4, {0, 0, 0, 0}});
  EXPECT_EQ(mean.mean().pixels, (std::vector<std::uint8_t>{200, 100, 40, 128}));
  EXPECT_THROW(mean.add({1, 1, 3, {0, 0, 0}}), ImageError);
}

TEST(Exr, TextAndMatricesComeBack) {
  ExrPicture picture{3, 2, {{"Z", std::vector<float>{1, 2, 3, 4, 5, 6}}}};
  picture.channels.push_back({"R", to_half(std::vector<float>{0.5f, 0, -2, 65504, 1, 7})});
  ExrHeader header;
  header.text = {{"neve:scene", "a = 1\nb = \"\xc3\xa9\"\n"}, {"neve:frame", "7"}};
  header.fps = 24;
  header.to_camera.emplace();
  const std::vector<std::uint8_t> bytes = encode_exr(picture, header);
  PngText text = header.text;
  text["oiio:ColorSpace"] = "lin_rec709";  // every file says which light it is
  EXPECT_EQ(read_exr_text(bytes), text);
  const ExrPicture read = decode_exr(bytes);
  ASSERT_EQ(read.width, 3);
  EXPECT_EQ(numbers_of(*read.find("Z")), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(numbers_of(*read.find("R")), (std::vector<float>{0.5f, 0, -2, 65504, 1, 7}));
  EXPECT_EQ(read.find("G"), nullptr);
}

/// Writes numbers over those of an attribute of a file.
template <class Number>
void set_attribute(const std::string& name, const std::string& type,
                   const std::vector<Number>& numbers, std::vector<std::uint8_t>& bytes) {
  const std::string words = name + '\0' + type + '\0';
  const auto found = std::search(bytes.begin(), bytes.end(), words.begin(), words.end());
  ASSERT_NE(found, bytes.end()) << name;
  const auto at = static_cast<std::size_t>(found - bytes.begin()) + words.size() + 4;
  std::memcpy(bytes.data() + at, numbers.data(), numbers.size() * sizeof(Number));
}

TEST(Exr, DataLieAtTheirPlaceInTheDisplayWindow) {
  const std::vector<float> numbers{1, 2, 3, 4, 5, 6};
  std::vector<std::uint8_t> bytes = encode_exr({3, 2, {{"Z", numbers}}});
  // x from -1 to 2, y from 1 to 3.
  set_attribute<std::int32_t>("displayWindow", "box2i", {-1, 1, 2, 3}, bytes);
  const ExrPicture read = decode_exr(bytes);
  ASSERT_EQ(read.width, 4);
  ASSERT_EQ(read.height, 3);
  EXPECT_EQ(numbers_of(*read.find("Z")), (std::vector<float>{0, 4, 5, 6, 0, 0, 0, 0, 0, 0, 0, 0}));
  set_attribute<std::int32_t>("displayWindow", "box2i", {0, 0, 1 << 19, 1 << 19}, bytes);
  EXPECT_THROW(decode_exr(bytes, 1e8), ImageSizeError);
  set_attribute<std::int32_t>("displayWindow", "box2i", {2, 2, 0, 0}, bytes);
  EXPECT_THROW(decode_exr(bytes), ImageError);
}

TEST(Exr, PrimariesOfOthersBecomeThoseOfRec709) {
  std::vector<std::uint8_t> bytes = encode_exr({1, 1, {{"R", std::vector<float>{1}}}});
  const ExrPicture own = decode_exr(bytes);
  EXPECT_EQ(own.to_rec709, ExrPicture{}.to_rec709);
  set_attribute<float>("chromaticities", "chromaticities",
                       {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}, bytes);
  // Source of the numbers: the config of OpenColorIO for ACES, "ACEScg to Linear Rec.709".
  const float expected[3][3] = {{1.70505f, -0.62179f, -0.08326f},
                                {-0.13026f, 1.14080f, -0.01055f},
                                {-0.02400f, -0.12897f, 1.15297f}};
  const ExrPicture read = decode_exr(bytes);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      EXPECT_NEAR(read.to_rec709[row][column], expected[row][column], 2e-4f);
  set_attribute<float>("chromaticities", "chromaticities", std::vector<float>(8, 0.3f), bytes);
  EXPECT_THROW(decode_exr(bytes), ImageError);
}

TEST(Exr, TheScreenWindowIsThatOfTheCamera) {
  const Frame frame = small_frame();
  const std::vector<std::uint8_t> bytes =
      encode_exr({1, 1, {{"R", std::vector<float>{1}}}}, channels::camera_header(frame));
  for (const ExrAttribute& attribute : read_exr_attributes(bytes)) {
    if (attribute.name != "screenWindowWidth") continue;
    float width = 0;
    std::memcpy(&width, attribute.bytes.data(), sizeof width);
    // One unit at a distance of 2 is as high as the picture.
    EXPECT_NEAR(width, 0.5f * 120 / 90, 1e-4f);
    return;
  }
  ADD_FAILURE();
}

/// The library allocates rows, tiles and tables of what a header says before it reads a number.
TEST(Exr, HeadersSayNoMoreThanTheirFileHolds) {
  const ExrPicture picture{40, 40, {{"Z", std::vector<float>(1600, 2.5f)}}};
  const std::vector<std::uint8_t> whole = encode_exr(picture);
  const auto put = [](const std::string& name, const std::string& type,
                      const std::vector<std::uint32_t>& numbers, std::vector<std::uint8_t>& bytes) {
    for (const std::string& word : {name, type}) {
      bytes.insert(bytes.end(), word.begin(), word.end());
      bytes.push_back(0);
    }
    std::vector<std::uint32_t> all{static_cast<std::uint32_t>(4 * numbers.size())};
    all.insert(all.end(), numbers.begin(), numbers.end());
    for (const std::uint32_t number : all)
      for (const int shift : {0, 8, 16, 24}) bytes.push_back(std::uint8_t(number >> shift));
  };
  const auto with = [&](const std::string& name, const std::string& type,
                        const std::vector<std::uint32_t>& numbers) {
    std::vector<std::uint8_t> bytes(whole.begin(), whole.begin() + 8);
    put(name, type, numbers, bytes);
    bytes.insert(bytes.end(), whole.begin() + 8, whole.end());
    return bytes;
  };
  constexpr double room = 1e8;
  EXPECT_NO_THROW(read_exr_text(with("ours", "box2i", {1, 2, 3, 4})));
  std::vector<std::uint8_t> tiled = with("tiles", "tiledesc", {1 << 15, 1 << 15, 0});
  // Nine bytes, the last a byte alone.
  constexpr std::size_t size_at = 8 + sizeof "tiles" + sizeof "tiledesc";
  tiled[size_at] = 9;
  tiled.erase(tiled.begin() + size_at + 4 + 9, tiled.begin() + size_at + 4 + 12);
  EXPECT_THROW(decode_exr(tiled, room), ImageSizeError);
  EXPECT_THROW(decode_exr(with("chunkCount", "int", {1u << 30}), room), ImageError);
  // The library would read these attributes from another place than the check.
  EXPECT_NO_THROW(read_exr_text(with("ours", "float", {1})));
  EXPECT_THROW(decode_exr(with("ours", "float", {1, 2}), room), ImageError);
  EXPECT_THROW(decode_exr(with("ours", "chlist", {82, 2, 0, 1, 1}), room), ImageError);
  EXPECT_THROW(decode_exr(with("ours", "m44f", {1, 2}), room), ImageError);
  EXPECT_THROW(decode_exr(with("ours", "stringvector", {1u << 30}), room), ImageError);
  EXPECT_THROW(decode_exr(with("dataWindow", "box2i", {0, 0, 3, 3}), room), ImageError) << "twice";
}

TEST(Jpeg, ManyScansAreRefused) {
  if (!can_encode_jpeg()) GTEST_SKIP() << jpeg_advice;
  std::vector<std::uint8_t> bytes =
      encode_jpeg({16, 16, 3, std::vector<std::uint8_t>(768, 90)}, 90, true);
  EXPECT_NO_THROW(decode_jpeg(bytes));
  for (int k = 0; k < 200; ++k) bytes.insert(bytes.end(), {0xff, 0xda, 0, 2});
  EXPECT_THROW(decode_jpeg(bytes), ImageError);
}

/// A JPEG with the Exif orientation of a camera.
std::vector<std::uint8_t> held(std::vector<std::uint8_t> bytes, int orientation, bool is_little) {
  std::vector<std::uint8_t> exif{0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0};
  const auto add = [&](std::size_t value, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k)
      exif.push_back(static_cast<std::uint8_t>(value >> 8 * (is_little ? k : size - 1 - k)));
  };
  for (int k = 0; k < 2; ++k) exif.push_back(is_little ? 'I' : 'M');
  for (const auto& [value, size] : std::vector<std::pair<std::size_t, std::size_t>>{
           {42, 2}, {8, 4}, {1, 2}, {0x0112, 2}, {3, 2}, {1, 4}})
    add(value, size);
  add(static_cast<std::size_t>(orientation), 2);
  add(0, 2);
  add(0, 4);
  bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
  return bytes;
}

TEST(Jpeg, PicturesOfATurnedCameraAreUpright) {
  if (!can_encode_jpeg()) GTEST_SKIP() << jpeg_advice;
  Image stored{32, 16, 3, std::vector<std::uint8_t>(32 * 16 * 3, 10)};
  for (std::size_t y = 0; y < 8; ++y)  // white in the upper left corner
    std::fill_n(stored.pixels.begin() + static_cast<std::ptrdiff_t>(3 * 32 * y), 3 * 8, 250);
  const std::vector<std::uint8_t> bytes = encode_jpeg(stored, 95, true);
  EXPECT_EQ(decode_jpeg(held(bytes, 9, true)).pixels, decode_jpeg(bytes).pixels) << "no such one";
  for (int orientation = 1; orientation <= 8; ++orientation)
    for (const bool is_little : {false, true}) {
      const Image image = decode_jpeg(held(bytes, orientation, is_little));
      const bool is_turned = orientation >= 5;
      ASSERT_EQ(image.width, is_turned ? 16 : 32);
      ASSERT_EQ(image.height, is_turned ? 32 : 16);
      const int quarter = (orientation - 1) % 4;  // from the upper left one, clockwise
      const int x = quarter == 1 || quarter == 2 ? image.width - 3 : 2,
                y = quarter >= 2 ? image.height - 3 : 2;
      for (const int to_x : {2, image.width - 3})
        for (const int to_y : {2, image.height - 3})
          EXPECT_EQ(pixel(image, to_x, to_y).g > 128, to_x == x && to_y == y) << orientation;
    }
}

TEST(Jpeg, DamagedFilesAreRefused) {
  if (!can_encode_jpeg()) GTEST_SKIP() << jpeg_advice;
  Image image{40, 30, 3, {}};
  for (int i = 0; i < 40 * 30 * 3; ++i) image.pixels.push_back(static_cast<std::uint8_t>(37 * i));
  const std::vector<std::uint8_t> whole = encode_jpeg(image, 90, true);
  EXPECT_EQ(decode_jpeg(whole).width, 40);
  for (const std::size_t size : {whole.size() / 2, whole.size() - 20, std::size_t{20}})
    EXPECT_THROW(decode_jpeg(std::span(whole).first(size)), ImageError) << size;
  EXPECT_THROW(decode_jpeg(whole, 1000), ImageSizeError);
}

TEST(Exr, DamagedFilesAreRefused) {
  const ExrPicture picture{40, 40, {{"Z", std::vector<float>(1600, 2.5f)}}};
  const std::vector<std::uint8_t> whole = encode_exr(picture);
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_THROW(decode_exr(std::span(whole).first(size)), ImageError) << size;
  EXPECT_THROW(read_exr_text(std::vector<std::uint8_t>(100, 'x')), ImageError);
  // A data window of billions of pixels.
  std::vector<std::uint8_t> vast = whole;
  const std::string word = "dataWindow";
  const auto at = std::search(vast.begin(), vast.end(), word.begin(), word.end());
  ASSERT_NE(at, vast.end());
  const std::int32_t far_away = 1 << 29;
  std::memcpy(&*at + word.size() + 1 + 6 + 4 + 8, &far_away, 4);
  std::memcpy(&*at + word.size() + 1 + 6 + 4 + 12, &far_away, 4);
  EXPECT_THROW(decode_exr(vast), ImageError);
}

}  // namespace
}  // namespace neve::render
