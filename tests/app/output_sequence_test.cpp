/// Output folders: what a new run removes, and what it never touches; the encoding worker.

#include "app/output/sequence.h"

#include <gtest/gtest.h>

#include "app/output/picture_writer.h"
#include "app/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

render::Image small_picture() {
  render::Image image;
  image.width = image.height = 4;
  image.pixels.assign(48, 100);
  return image;
}

TEST(Sequence, SequenceNamesFramesWithAtLeastFourDigits) {
  EXPECT_EQ(app::output::frame_path("out", "smoke", 24), fs::path("out/smoke/0024.png"));
  EXPECT_EQ(app::output::frame_path("out", "smoke", 12345), fs::path("out/smoke/12345.png"));
}

TEST(Sequence, SequenceRemovesOnlyFilesThatTheEarlierRunLists) {
  const TemporaryFolder folder;
  folder.write("run.json", R"({"views": ["particles"], "frames": [{"frame": 0}, {"frame": 1}]})");
  for (const char* name : {"particles/0000.png", "particles/0001.png", "particles/0002.png",
                           "particles/notes.txt", "particles.mp4", "smoke/0000.png", "mine.mp4"})
    folder.write(name, "x");
  EXPECT_EQ(app::output::remove_earlier_run(folder.path()), 3u);
  EXPECT_FALSE(fs::exists(folder / "particles/0000.png"));
  EXPECT_FALSE(fs::exists(folder / "particles.mp4"));
  for (const char* name :
       {"particles/0002.png", "particles/notes.txt", "smoke/0000.png", "mine.mp4", "run.json"})
    EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST(Sequence, SequenceIsNotLedOutOfItsFolder) {
  const TemporaryFolder outer;
  outer.write("victim/0000.png", "x");
  outer.write("victim.mp4", "x");
  outer.write("real/0000.png", "x");
  const fs::path run = outer / "run";
  outer.write("run/run.json",
              R"({"views": ["../victim", "/tmp", "", "..", ".", "link", 7, null, {"a": 1}],
                  "frames": [{"frame": 0}, {"frame": "0"}, {"frame": -1}, {"frame": 1e99}, 5]})");
  fs::create_directory_symlink(outer / "real", run / "link");
  EXPECT_EQ(app::output::remove_earlier_run(run), 0u);
  EXPECT_TRUE(fs::exists(outer / "victim/0000.png"));
  EXPECT_TRUE(fs::exists(outer / "victim.mp4"));
  EXPECT_TRUE(fs::exists(outer / "real/0000.png"));
}

TEST(Sequence, SequenceRemovesNothingWhenRunJsonIsMissingOrBroken) {
  const TemporaryFolder folder;
  folder.write("particles/0000.png", "x");
  EXPECT_EQ(app::output::remove_earlier_run(folder.path()), 0u);
  std::string deep(100'000, '[');
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string("3"), deep,
        std::string(R"({"views": 3, "frames": "x"})"), std::string("\xff\xfe")}) {
    folder.write("run.json", text);
    EXPECT_EQ(app::output::remove_earlier_run(folder.path()), 0u);
  }
  EXPECT_TRUE(fs::exists(folder / "particles/0000.png"));
}

TEST(PictureWriter, PictureWriterWritesEverythingInOrderOfArrival) {
  const TemporaryFolder folder;
  app::output::PictureWriter writer;
  for (int frame = 0; frame < 12; ++frame)
    writer.write({app::output::frame_path(folder.path(), ".", frame),
                  small_picture(),
                  {{"neve:frame", std::to_string(frame)}}});
  writer.finish();
  for (int frame = 0; frame < 12; ++frame) {
    const std::string bytes = test::read_text(app::output::frame_path(folder.path(), ".", frame));
    const render::PngText text =
        render::read_png_text({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_EQ(text.at("neve:frame"), std::to_string(frame));
  }
}

TEST(PictureWriter, PictureWriterReportsItsErrorsToTheCaller) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  app::output::PictureWriter writer;
  EXPECT_THROW(
      {
        for (int frame = 0; frame < 100; ++frame)
          writer.write({folder.path() / "file" / "0.png", small_picture(), {}});
        writer.finish();
      },
      IoError);
  EXPECT_THROW(writer.finish(), IoError);
}

}  // namespace
}  // namespace neve::app
