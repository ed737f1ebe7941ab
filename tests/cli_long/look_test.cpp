/// docs/reports/look/compare.py, which sets pictures of neve beside pictures of VTK.

#include <algorithm>
#include <set>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class LookPage : public Cli {};

TEST_F(LookPage, ItsScriptDrawsOneStateInFourWays) {
  const auto python = python_with("vtkmodules.vtkRenderingOpenGL2");
  if (!python) SKIP_OR_FAIL("no Python with VTK; install python3-vtk9");
  if (!app::output::find_program("Xvfb")) SKIP_OR_FAIL("no Xvfb in PATH; install xvfb");
  const auto drawn = app::output::run_process(
      *python,
      {"-B", NEVE_SOURCE_DIR "/docs/reports/look/compare.py", (folder / "look").string(), "--neve",
       NEVE_BINARY, "--states", "drop", "--coarsen", "3", "--size", "192x120"},
      folder.path());
  ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "look/sheets/drop.jpg"), 4000u);
  std::set<std::string> ways;
  const app::Json key = json_of("look/key.json");
  for (const app::Json& way : key.at("drop")) ways.insert(way.get<std::string>());
  ASSERT_EQ(ways,
            (std::set<std::string>{"neve_particles", "neve_snow", "vtk_points", "vtk_surface"}));
  // One camera: the snow covers about the same pixels in all four, and looks different.
  const auto bright = [](const render::Image& image) {
    std::set<std::size_t> pixels;
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t k = 0; k < image.pixels.size(); k += channels)
      if (image.pixels[k] > 150) pixels.insert(k / channels);
    return pixels;
  };
  std::set<std::size_t> first;
  std::vector<render::Image> pictures;
  for (const std::string& way : ways) {
    pictures.push_back(
        render::decode_png(app::output::read_file(folder / ("look/drop/" + way + ".png"))));
    ASSERT_EQ(pictures.back().width, 192);
    const std::set<std::size_t> here = bright(pictures.back());
    ASSERT_GT(here.size(), 500u) << way;
    if (first.empty()) first = here;
    std::size_t both = 0;
    for (const std::size_t pixel : here) both += first.contains(pixel);
    // The light of VTK leaves a third of its surface darker than the particles of neve are.
    EXPECT_GT(both, std::min(first.size(), here.size()) * 6 / 10) << way;
  }
  for (std::size_t a = 0; a < pictures.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_NE(pictures[a].pixels, pictures[b].pixels) << a << " and " << b;
}

}  // namespace
}  // namespace neve::test
