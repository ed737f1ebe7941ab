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
  // The movie is lossy, with a limited range.
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

/// The first bytes of a file of a format, and the place where they begin.
std::pair<std::size_t, std::string> signature_of(app::output::MovieFormat format) {
  switch (format) {
    case app::output::MovieFormat::h264:
    case app::output::MovieFormat::h265:
      return {4, "ftypisom"};
    case app::output::MovieFormat::vp9:
      return {0, "\x1a\x45\xdf\xa3"};
    case app::output::MovieFormat::prores:
      return {4, "ftypqt"};
    case app::output::MovieFormat::gif:
      return {0, "GIF89a"};
    case app::output::MovieFormat::webp:
      return {8, "WEBPVP8X"};
  }
  return {};
}

TEST_F(Movie, EveryFormatHoldsEveryFrameAlsoEqualOnes) {
  for (const app::output::MovieFormat format : app::output::all_movie_formats) {
    const Fixture f;
    write_pictures(f.folder, 3, 8);
    for (const int equal : {5, 6})
      fs::copy_file(app::output::frame_path(f.folder, "v", 4),
                    app::output::frame_path(f.folder, "v", equal),
                    fs::copy_options::overwrite_existing);
    app::output::MovieRequest wanted = request(f.folder, 3, 8);
    wanted.style.format = format;
    wanted.file = app::output::movie_path(f.folder, "v", format);
    const app::output::MovieResult result = app::output::write_movie(wanted);
    ASSERT_EQ(result.outcome, app::output::MovieOutcome::written)
        << app::output::name(format) << ": " << result.reason;
    const auto [at, begin] = signature_of(format);
    EXPECT_EQ(test::read_text(wanted.file).substr(at, begin.size()), begin)
        << app::output::name(format);
    EXPECT_EQ(file_count(f.folder), 2u) << app::output::name(format) << ": a file is left";
    const std::string film = test::read_text(wanted.file);
    fs::remove(app::output::frame_path(f.folder, "v", 7));
    EXPECT_EQ(app::output::write_movie(wanted).outcome, app::output::MovieOutcome::failed)
        << app::output::name(format) << ": a frame is missing";
    EXPECT_EQ(test::read_text(wanted.file), film) << app::output::name(format) << ": it stays";
  }
}

TEST_F(Movie, MoviesSayThatTheirColoursAreThoseOfBt709) {
  const auto ffprobe = app::output::find_program("ffprobe");
  if (!ffprobe) SKIP_OR_FAIL("no ffprobe in PATH (Debian: ffmpeg)");
  for (const app::output::MovieFormat format : app::output::all_movie_formats) {
    if (format == app::output::MovieFormat::gif || format == app::output::MovieFormat::webp)
      continue;  // they are RGB
    const Fixture f;
    write_pictures(f.folder, 0, 1);
    app::output::MovieRequest wanted = request(f.folder, 0, 1);
    wanted.style.format = format;
    wanted.file = app::output::movie_path(f.folder, "v", format);
    wanted.fps = 24000.0 / 1001;
    ASSERT_EQ(app::output::write_movie(wanted).outcome, app::output::MovieOutcome::written);
    const auto told =
        app::output::run_process(*ffprobe,
                                 {"-v", "error", "-show_entries",
                                  "stream=color_space,color_transfer,color_primaries,r_frame_rate",
                                  "-of", "csv=p=0", wanted.file.string()},
                                 f.folder);
    EXPECT_EQ(told.output.find("bt709,bt709,bt709,24000/1001"), 0u)
        << app::output::name(format) << ": " << told.output << told.errors;
  }
}

TEST_F(Movie, LessQualityIsASmallerFileAndTheRateIsThatOfTheStyle) {
  const Fixture f;
  unsigned noise = 1;
  for (int frame = 0; frame < 6; ++frame) {
    render::Image image{64, 48, 3, {}};
    for (int k = 0; k < 64 * 48 * 3; ++k)
      image.pixels.push_back(
          static_cast<std::uint8_t>((noise = noise * 1664525 + 1013904223) >> 24));
    app::output::write_file(app::output::frame_path(f.folder, "v", frame),
                            render::encode_png(image));
  }
  const auto size_with = [&](app::output::MovieFormat format, int quality) {
    app::output::MovieRequest wanted = request(f.folder, 0, 5);
    wanted.style = {format, quality, 4};
    wanted.file = app::output::movie_path(f.folder, "v", format);
    EXPECT_EQ(app::output::write_movie(wanted).outcome, app::output::MovieOutcome::written)
        << app::output::name(format);
    return fs::file_size(wanted.file);
  };
  for (const app::output::MovieFormat format : app::output::all_movie_formats) {
    const auto low = size_with(format, 30);
    EXPECT_LT(1.1 * static_cast<double>(low), static_cast<double>(size_with(format, 95)))
        << app::output::name(format);
    if (format == app::output::MovieFormat::webp) continue;  // ffmpeg reads none
    const app::output::ProcessResult told = app::output::run_process(
        *app::output::find_program("ffmpeg"),
        {"-i", app::output::movie_path(f.folder, "v", format).string()}, f.folder);
    EXPECT_NE(told.errors.find("Duration: 00:00:01.50"), std::string::npos) << told.errors;
  }
}

TEST(MovieWithoutFfmpeg, AMovieThatWasAskedForIsAnErrorBeforeThePictures) {
  const TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  const auto problem = [](const app::output::MovieStyle& style, double fps) -> std::string {
    try {
      app::output::available_movie(style, fps);
    } catch (const app::Error& error) {
      return error.what();
    }
    return {};
  };
  app::output::MovieStyle style{app::output::MovieFormat::h265};
  ::setenv("PATH", folder.path().c_str(), 1);
  EXPECT_EQ(problem(style, 24), "") << "nobody asked for it";
  style.is_chosen = true;
  const std::string no_ffmpeg = problem(style, 24);
  fs::permissions(folder.write("ffmpeg", "#!/bin/bash\necho ' V....D libx264   H.264'\n"),
                  fs::perms::owner_all);
  style.has_format = true;
  const std::string no_encoder = problem(style, 24);
  style.format = app::output::MovieFormat::h264;
  EXPECT_EQ(problem(style, 24), "");
  // Nobody named a format: the first one that is installed counts.
  folder.write("ffmpeg",
               "#!/bin/bash\necho ' V....D prores_ks   ProRes'; echo ' V....D gif   GIF'\n");
  const app::output::MovieStyle usual;
  const app::output::MovieStyle other = app::output::available_movie(usual, 24);
  const std::string no_h264 = problem(style, 24);
  style.format = app::output::MovieFormat::gif;
  const std::string too_fast = problem(style, 60);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(no_ffmpeg.find("ffmpeg, which makes movies, is not in PATH"), std::string::npos);
  EXPECT_NE(no_encoder.find("has no encoder libx265"), std::string::npos) << no_encoder;
  EXPECT_EQ(other.format, app::output::MovieFormat::prores);
  EXPECT_NE(other_format_text(usual, other).find("movies are prores"), std::string::npos);
  EXPECT_NE(no_h264.find("that this one makes: prores, gif"), std::string::npos) << no_h264;
  EXPECT_NE(too_fast.find("at most 50 frames a second"), std::string::npos) << too_fast;
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
  EXPECT_EQ(result.reason, "ffmpeg was stopped: it took too long");
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
