/// Movies: the right number of frames, or none and a reason.

#include "app/output/movie.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "app/output/sequence.h"
#include "render/image/image.h"
#include "tests/support/needs.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

namespace fs = std::filesystem;
using test::file_count;
using test::TemporaryFolder;

/// Odd sides, as yuv420p cannot hold them.
void write_pictures(const fs::path& folder, int first, int last) {
  for (int frame = first; frame <= last; ++frame) {
    render::Image image;
    image.width = 33, image.height = 17;
    image.pixels.assign(33 * 17 * 3, static_cast<std::uint8_t>(20 * (frame % 10)));
    app::output::write_file(app::output::frame_path(folder, "v", frame), render::encode_png(image));
  }
}

app::output::MovieRequest request(const fs::path& folder, int first, int last) {
  return {folder / "v", folder / "v.mp4", first, last, 24};
}

/// A folder whose name is full of what shells and patterns treat specially.
struct Fixture {
  TemporaryFolder outer;
  fs::path folder = outer / "a %d 'b' $(c)";
  Fixture() { fs::create_directories(folder / "v"); }
};

class Movie : public testing::Test {
 protected:
  void SetUp() override {
    if (!app::output::find_program("ffmpeg")) SKIP_OR_FAIL("no ffmpeg in PATH (Debian: ffmpeg)");
  }
};

TEST_F(Movie, MovieOfTransparentPicturesHasAPlainBackground) {
  const Fixture f;
  for (int frame = 0; frame < 2; ++frame) {
    render::Image image{32, 16, 4, std::vector<std::uint8_t>(32 * 16 * 4)};
    // White on the left, nothing on the right.
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      if (i / 4 % 32 < 16) image.pixels[i] = 255;
    app::output::write_file(app::output::frame_path(f.folder, "v", frame),
                            render::encode_png(image));
  }
  app::output::MovieRequest wanted = request(f.folder, 0, 1);
  wanted.has_alpha = true;
  const app::output::MovieResult result = app::output::write_movie(wanted);
  ASSERT_EQ(result.outcome, app::output::MovieOutcome::written) << result.reason;
  const fs::path still = f.folder / "still.png";
  const app::output::ProcessResult decoded =
      app::output::run_process(*app::output::find_program("ffmpeg"),
                               {"-v", "error", "-i", wanted.file.string(), "-frames:v", "1",
                                "-update", "1", "-pix_fmt", "rgb24", "-y", still.string()},
                               f.folder);
  ASSERT_EQ(decoded.exit_code, 0) << decoded.errors;
  const std::string bytes = test::read_text(still);
  const render::Image image =
      render::decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  const auto green = [&](int x) {
    return int{image.pixels.at(static_cast<std::size_t>(3 * (8 * 32 + x) + 1))};
  };
  // Lossy, and limited range.
  EXPECT_NEAR(green(4), 255, 6);
  EXPECT_NEAR(green(27), 0x4b, 6);
}

TEST_F(Movie, MovieHoldsEveryFrameOfOddSizeFromAStrangeFolder) {
  const Fixture f;
  write_pictures(f.folder, 3, 8);
  const app::output::MovieResult result = app::output::write_movie(request(f.folder, 3, 8));
  EXPECT_EQ(result.outcome, app::output::MovieOutcome::written) << result.reason;
  EXPECT_GT(fs::file_size(f.folder / "v.mp4"), 0u);
  EXPECT_EQ(file_count(f.folder), 2u) << "a temporary file is left";
}

TEST_F(Movie, MovieContinuesPastFrame9999) {
  const Fixture f;
  write_pictures(f.folder, 9998, 10001);
  EXPECT_EQ(app::output::write_movie(request(f.folder, 9998, 10001)).outcome,
            app::output::MovieOutcome::written);
}

TEST_F(Movie, MovieIgnoresPicturesBehindTheLastFrame) {
  const Fixture f;
  write_pictures(f.folder, 0, 9);
  EXPECT_EQ(app::output::write_movie(request(f.folder, 0, 4)).outcome,
            app::output::MovieOutcome::written);
}

TEST_F(Movie, MovieIsNotKeptWhenAPictureIsEmptyOrMissing) {
  for (const bool is_missing : {false, true}) {
    const Fixture f;
    write_pictures(f.folder, 0, 7);
    fs::remove(f.folder / "v/0004.png");
    if (!is_missing) app::output::write_file(f.folder / "v/0004.png", std::string_view());
    const app::output::MovieResult result = app::output::write_movie(request(f.folder, 0, 7));
    EXPECT_EQ(result.outcome, app::output::MovieOutcome::failed);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(file_count(f.folder), 1u) << "something else than the pictures is left";
  }
}

TEST(MovieWithoutFfmpeg, AnFfmpegThatHangsIsStopped) {
  const TemporaryFolder folder;
  const Fixture f;
  write_pictures(f.folder, 0, 1);
  fs::permissions(folder.write("ffmpeg", "#!/bin/bash\nexec /bin/sleep 600\n"),
                  fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.path().c_str(), 1);
  app::output::MovieRequest slow = request(f.folder, 0, 1);
  slow.longest = 0.3;
  const app::output::MovieResult result = app::output::write_movie(slow);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.outcome, app::output::MovieOutcome::failed);
  EXPECT_EQ(result.reason, "ffmpeg was stopped: it took far too long");
  EXPECT_EQ(file_count(f.folder), 1u) << "something else than the pictures is left";
}

TEST(MovieWithoutFfmpeg, AMissingFfmpegIsNoError) {
  const TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.path().c_str(), 1);
  const app::output::MovieResult result = app::output::write_movie(request(folder.path(), 0, 1));
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.outcome, app::output::MovieOutcome::no_ffmpeg);
}

}  // namespace
}  // namespace neve::app
