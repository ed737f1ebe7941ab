#pragma once
/// `neve view` as a person uses it, whose hand is a script.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/record/picture_record.h"
#include "app/support/errors.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {

class ViewByScript : public Cli {
 protected:
  app::output::ProcessResult view(const std::string& script,
                                  const std::vector<std::string>& more = {}) {
    folder.write("clicks.json", script);
    std::vector<std::string> words{"view",  "scene.toml", "--replay", "clicks.json",
                                   "--out", "out",        "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  /// neve render makes the same picture from its record.
  void expect_made_again(const std::string& file) {
    const auto done = neve({"render", file, "--out", "again", "--no-movie", "--replace"});
    ASSERT_EQ(done.exit_code, 0) << done.errors;
    const app::record::PictureRecord record =
        app::record::read_picture_record((folder / file).string());
    const auto pixels = [&](const std::filesystem::path& picture) {
      const render::Image image = render::decode_png(app::output::read_file(picture));
      return std::pair(image.channels, image.pixels);
    };
    EXPECT_EQ(pixels(folder / file),
              pixels(app::output::frame_path(folder / "again", record.view, record.frame)))
        << file;
  }

  /// Files of the output folder whose names begin and end so.
  std::vector<std::string> files(const std::string& begin, const std::string& end) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(end)) found.push_back(name);
    }
    return found;
  }
};

#define SKIP_WITHOUT_GL(result) \
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors)

}  // namespace neve::test
