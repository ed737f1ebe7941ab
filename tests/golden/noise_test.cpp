/// Noise of final quality: how far a picture of snow is from one with many more samples.

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/picture/frame_builder.h"
#include "app/picture/shutter.h"
#include "app/scene/read.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "render/frame/view.h"
#include "render/image/mean_image.h"
#include "tests/render/gl_test.h"

namespace neve::test {
namespace {

using namespace app;

/// A ball before nothing, against the sun: all that is seen of it is in shade.
constexpr const char* shaded_scene = R"(
frames = 1
[solver]
cell_size = 0.02
gravity = [0, 0, 0]
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0, 0], radius = 0.15 } }
velocity = [VELOCITY, 0, 0]
[light]
direction = [0.2, 0.2, -1]
[camera]
eye = [0, 0.1, 0.9]
target = [0, 0, 0]
fov = 30
[[view]]
name = "snow"
layers = ["snow"]
[output]
size = [320, 180]
)";

/// The scene at its start, as final quality draws its view snow.
class Shaded {
 public:
  explicit Shaded(const std::string& velocity) {
    std::string text = shaded_scene;
    text.replace(text.find("VELOCITY"), 8, velocity);
    scene_ = scene::read_scene_text(text, "noise.toml");
    seeded_ = setup::seed_scene(scene_);
    setup::resolve(scene_, seeded_.particles.x.size());
    view_ = *std::find_if(scene_.views.begin(), scene_.views.end(),
                          [](const scene::View& view) { return view.name == "snow"; });
    const sim::Simulation simulation = setup::make_simulation(scene_, seeded_.particles, 1);
    snapshot_ = picture::take_snapshot(scene_, {&view_, 1}, simulation, 0);
  }
  render::Frame frame() const {
    const picture::PictureOptions options{.quality = setup::Quality::final};
    render::Frame frame = picture::FrameBuilder(scene_, seeded_, options).build(view_, snapshot_);
    frame.caption.clear();
    frame.is_transparent = true;
    return frame;
  }
  render::Moments moments(const render::Frame& frame) const {
    return picture::shutter_moments({scene_, view_, seeded_, snapshot_}, frame, 180);
  }

 private:
  scene::Scene scene_;
  setup::SeededScene seeded_;
  scene::View view_;
  picture::Snapshot snapshot_;
};

std::vector<render::Frame> all(const render::Moments& moments) {
  std::vector<render::Frame> frames;
  for (int k = 0; k < moments.count; ++k) frames.push_back(moments.at(k));
  return frames;
}

/// Moves the picture by parts of a pixel, for what is as far away as the target.
void shift(float right, float up, render::Frame& frame) {
  const render::View view = render::make_view(frame.camera, frame.width, frame.height);
  const float pixel = length(frame.camera.target - frame.camera.eye) / view.pixels_per_slope;
  const Vec3f by = (view.right * right + view.up * up) * pixel;
  frame.camera.eye = frame.camera.eye + by;
  frame.camera.target = frame.camera.target + by;
}

/// Adds the same moments with samples between those of the picture: 4x4 times as many.
void add_with_more_samples(const std::vector<render::Frame>& moments, render::Renderer& renderer,
                           render::MeanImage& mean) {
  constexpr int side = 4;
  for (int n = 0; n < side * side; ++n)
    for (render::Frame moment : moments) {
      const auto part = [&](int k) {  // two samples a pixel lie half a pixel apart
        return 0.5f * ((static_cast<float>(k) + 0.5f) / side - 0.5f);
      };
      shift(part(n % side), part(n / side), moment);
      mean.add(renderer.draw(moment));
    }
}

/// Root of the mean square of the difference, of 255, where both pictures show snow alone.
double noise_of(const render::Image& image, const render::Image& reference) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    if (image.pixels[i + 3] != 255 || reference.pixels[i + 3] != 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = double{1} * image.pixels[i + c] - reference.pixels[i + c];
      sum += d * d;
      ++count;
    }
  }
  EXPECT_GT(count, 3u * 3000);
  return std::sqrt(sum / static_cast<double>(count));
}

// An eye sees noise of single pixels from about three in a hundred of the light: near half grey,
// where snow in the shade is, that is 1.6 of 255.
constexpr double visible = 1.6;

TEST(Noise, FinalQualityShowsNoneOnSnowInTheShade) {
  OPEN_OR_SKIP(context, "auto");
  render::Renderer renderer(*context);
  const Shaded still("0");
  const render::Frame frame = still.frame();
  render::MeanImage reference;
  add_with_more_samples({frame}, renderer, reference);
  const double noise = noise_of(renderer.draw(frame), reference.mean());
  RecordProperty("noise", std::to_string(noise));
  EXPECT_LT(noise, visible);
  // One sample a pixel is what a preview has.
  render::Frame preview = frame;
  preview.supersampling = 1;
  EXPECT_GT(noise_of(renderer.draw(preview), reference.mean()), 1.3 * noise);
}

TEST(Noise, FinalQualityShowsNoneWhereSnowIsBlurredByItsMotion) {
  OPEN_OR_SKIP(context, "auto");
  render::Renderer renderer(*context);
  const Shaded flying("1.2");
  const render::Frame frame = flying.frame();
  const render::Moments moments = flying.moments(frame);
  ASSERT_GT(moments.count, 4);
  render::MeanImage mean, reference;
  for (const render::Frame& moment : all(picture::with_shared_samples(moments)))
    mean.add(renderer.draw(moment));
  // Twice the size moves by twice the pixels, and has twice the moments.
  render::Frame large = frame;
  large.width *= 2;
  large.height *= 2;
  std::vector<render::Frame> more = all(flying.moments(large));
  ASSERT_GT(static_cast<double>(more.size()), 1.5 * moments.count);
  for (render::Frame& moment : more) {
    moment.width = frame.width;
    moment.height = frame.height;
  }
  add_with_more_samples(more, renderer, reference);
  const double noise = noise_of(mean.mean(), reference.mean());
  RecordProperty("noise", std::to_string(noise));
  EXPECT_LT(noise, visible);
}

/// Root of the mean square by which rows differ from the mean of those three above and below, of
/// 255: contrast of the scale of grain across a motion to the side.
double grain_across(const render::Image& image) {
  constexpr int reach = 3;
  double sum = 0;
  std::size_t count = 0;
  const auto at = [&](int x, int y) {
    return image.pixels.data() + 4 * (static_cast<std::ptrdiff_t>(y) * image.width + x);
  };
  for (int y = reach; y < image.height - reach; ++y)
    for (int x = 0; x < image.width; ++x) {
      double around = 0;
      bool is_snow = true;
      for (int k = -reach; k <= reach; ++k) {
        is_snow &= at(x, y + k)[3] == 255;
        around += at(x, y + k)[1] / (2.0 * reach + 1);
      }
      if (!is_snow) continue;
      sum += (at(x, y)[1] - around) * (at(x, y)[1] - around);
      ++count;
    }
  EXPECT_GT(count, 800u);
  return std::sqrt(sum / static_cast<double>(count));
}

/// Mean of the green of snow.
double brightness_of(const render::Image& image) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    if (image.pixels[i + 3] == 255) sum += image.pixels[i + 1], ++count;
  return sum / count;
}

/// Fast snow keeps streaks of grain, and does not look like cotton wool.
TEST(Noise, GrainRemainsWhereSnowIsBlurredByItsMotion) {
  OPEN_OR_SKIP(context, "auto");
  render::Renderer renderer(*context);
  const Shaded flying("2.4");
  const render::Frame frame = flying.frame();
  std::vector<render::Frame> moments = all(picture::with_shared_samples(flying.moments(frame)));
  ASSERT_GT(moments.size(), 12u);
  render::MeanImage with, without;
  for (render::Frame& moment : moments) {
    with.add(renderer.draw(moment));
    moment.points.blur = {};
    moment.grain_detail = 1;
    without.add(renderer.draw(moment));
  }
  const double sharp = grain_across(renderer.draw(frame)), blurred = grain_across(with.mean()),
               wool = grain_across(without.mean());
  RecordProperty("sharp", std::to_string(sharp));
  RecordProperty("blurred", std::to_string(blurred));
  RecordProperty("wool", std::to_string(wool));
  EXPECT_GT(blurred, 0.5 * sharp);
  EXPECT_GT(blurred, 1.5 * wool);
  EXPECT_LT(blurred, sharp);
  EXPECT_NEAR(brightness_of(with.mean()), brightness_of(without.mean()), 3);
}

/// A crumb that still rolls by some pixels must not make the rest cost all samples in each moment.
TEST(Noise, SomeMomentsOfMotionBlurShareTheSamplesOfAPixel) {
  const auto moments_at = [](const char* velocity, int supersampling) {
    const Shaded moving(velocity);
    render::Frame frame = moving.frame();
    frame.supersampling = supersampling;
    return all(picture::with_shared_samples(moving.moments(frame)));
  };
  EXPECT_EQ(moments_at("0.2", 1).size(), 2u);  // 1.5 pixels
  EXPECT_EQ(moments_at("0.6", 1).size(), 6u);
  const std::vector<render::Frame> slow = moments_at("0.2", 2), rolling = moments_at("0.6", 2);
  EXPECT_EQ(slow.size(), 2u);
  EXPECT_EQ(slow.front().supersampling, 2) << "two moments with all samples take less time";
  ASSERT_EQ(rolling.size(), 8u);
  for (const render::Frame& moment : rolling) {
    EXPECT_EQ(moment.supersampling, 1);
    EXPECT_EQ(moment.grain_detail, 2);
  }
}

/// Labels beside moving snow were as smeared as it.
TEST(Noise, WordsStayWhereMomentsShareSamples) {
  OPEN_OR_SKIP(context, "auto");
  render::Renderer renderer(*context);
  const Shaded flying("1.2");
  render::Frame frame = flying.frame();
  frame.labels = {{{0.03f, 0.07f, 0}, "ball"}};
  std::vector<render::Frame> moments = all(picture::with_shared_samples(flying.moments(frame)));
  ASSERT_GT(moments.size(), 4u);
  std::optional<render::Image> first;
  for (render::Frame& moment : moments) {
    moment.points = {};
    const render::Image image = renderer.draw(moment);
    if (!first) first = image;
    EXPECT_LE(render::compare(image, *first).max, 2);
  }
  EXPECT_GT(std::ranges::count_if(first->pixels, [](int sample) { return sample > 100; }), 200)
      << "no label";
}

/// Snow that stands still beside fast snow is as sharp as without motion blur.
TEST(Noise, SnowAtRestKeepsItsGrainWhereMomentsShareSamples) {
  OPEN_OR_SKIP(context, "auto");
  render::Renderer renderer(*context);
  render::Frame frame = Shaded("0").frame();
  frame.camera.eye = frame.camera.eye * 2.2f;  // grains of about a pixel and a half
  render::MeanImage shared, coarse;
  std::vector<render::Frame> moments =
      all(picture::with_shared_samples({16, [&](int) { return frame; }}));
  for (render::Frame& moment : moments) {
    shared.add(renderer.draw(moment));
    moment.grain_detail = 1;
    coarse.add(renderer.draw(moment));
  }
  const double sharp = grain_across(renderer.draw(frame)), mean = grain_across(shared.mean());
  RecordProperty("sharp", std::to_string(sharp));
  RecordProperty("shared", std::to_string(mean));
  RecordProperty("coarse", std::to_string(grain_across(coarse.mean())));
  EXPECT_NEAR(mean / sharp, 1, 0.06);
  EXPECT_LT(grain_across(coarse.mean()), 0.93 * mean);
}

}  // namespace
}  // namespace neve::test
