/// The layout of output folders, and the encoding worker.

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
