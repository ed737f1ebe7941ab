/// report.html in a real browser: what a person does there with mouse and keys, and how much work
/// it is for a large sweep.

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "app/sweep/sheet/report.h"
#include "tests/support/chromium.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

using app::sweep::store::Manifest;
using app::sweep::store::RunResult;
using app::sweep::store::RunState;

void write_picture(const std::filesystem::path& file, int red, int green) {
  render::Image image{16, 9, 3, {}};
  for (int k = 0; k < 16 * 9; ++k)
    for (const int part : {red, green, 90}) image.pixels.push_back(static_cast<std::uint8_t>(part));
  const std::vector<std::uint8_t> png = render::encode_png(image);
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
}

/// Metrics that depend on the levels of a run, so that a test can foresee who is kept.
RunResult result_of(const app::sweep::Run& run, int frame_count) {
  RunResult result;
  result.status.state = RunState::ok;
  for (int frame = 0; frame < frame_count; ++frame) result.frames.push_back(frame);
  const double x = run.coordinates[0], y = run.coordinates[1];
  for (std::size_t m = 0; m < app::sweep::store::metric_infos().size(); ++m)
    result.metrics.emplace_back(m == 0 ? x + 10 * y : std::sin(double(m) + x) + 0.1 * y);
  return result;
}

/// A made sweep on a grid of a logarithmic axis, a choice and more.
struct MadeSweep {
  Manifest manifest;
  std::vector<RunResult> results;

  /// @param sizes of the axes: stiffness, transfer, and further numbers
  MadeSweep(const std::vector<int>& sizes, int frame_count) {
    manifest.version = "1";
    manifest.title = "Test </script><img src=x onerror=alert(1)> & \"quotes\"";
    manifest.scene_file = "scene.toml";
    manifest.view = "particles";
    manifest.tile_width = 16;
    manifest.tile_height = 9;
    for (std::size_t a = 0; a < sizes.size(); ++a) add_axis(a, sizes[a]);
    int count = 1;
    for (const int size : sizes) count *= size;
    for (int k = 0; k < count; ++k) add_run(k, sizes);
    for (const app::sweep::Run& run : manifest.runs) results.push_back(result_of(run, frame_count));
  }

  void fail(std::size_t run, const std::string& reason) {
    results[run].status.state = RunState::diverged;
    results[run].status.reason = reason;
    results[run].frames = {0};
  }

  /// The page, with a picture for each frame: red from the run, green from the frame.
  std::string write(const TemporaryFolder& folder) const {
    for (std::size_t k = 0; k < results.size(); ++k)
      for (const int frame : results[k].frames) {
        char name[16];
        std::snprintf(name, sizeof name, "%04d.png", frame);
        write_picture(folder / ("runs/" + manifest.runs[k].folder + "/particles/" + name),
                      40 * int(k % 6) + 20, 60 * frame);
      }
    const auto layout = app::sweep::sheet::layout_sheet(manifest, false, 8192);
    return "file://" + folder
                           .write("report.html", app::sweep::sheet::report_html(
                                                     "out/a b.cdb", manifest, results, layout, {}))
                           .string();
  }

 private:
  std::string value_of(std::size_t axis, int level) const {
    static const char* const transfers[] = {"flip", "apic", "mls"};
    if (axis == 1) return transfers[level % 3];
    return axis == 0 ? std::to_string(std::lround(1000 * std::pow(10, 0.5 * level)))
                     : std::to_string(level + 1);
  }
  void add_axis(std::size_t a, int size) {
    static const char* const names[] = {"stiffness", "transfer", "friction", "seed"};
    const std::string address = std::string("a.") + names[a];
    manifest.parameters.push_back(
        {address, names[a], a == 0 ? "Pa" : "", a == 1 ? "choice" : "number"});
    app::sweep::store::AxisLabels axis{names[a], {}, {address}};
    for (int k = 0; k < size; ++k) axis.values.push_back(value_of(a, k));
    manifest.axes.push_back(axis);
  }
  void add_run(int k, const std::vector<int>& sizes) {
    app::sweep::Run run;
    run.index = k;
    run.folder = app::sweep::store::run_folder_name(k);
    for (std::size_t a = sizes.size(); a-- > 0; k /= sizes[a])
      run.coordinates.insert(run.coordinates.begin(), k % sizes[a]);
    for (std::size_t a = 0; a < sizes.size(); ++a) {
      const std::string value = value_of(a, run.coordinates[a]);
      run.settings.push_back({manifest.parameters[a].address, a == 1 ? '"' + value + '"' : value});
    }
    manifest.runs.push_back(run);
  }
};

class ReportPage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!find_chromium().empty()) browser = std::make_unique<Chromium>();
  }
  static void TearDownTestSuite() { browser.reset(); }
  void SetUp() override {
    if (!browser) SKIP_OR_FAIL(no_chromium);
    browser->exceptions.clear();
  }
  void TearDown() override {
    if (!browser) return;
    EXPECT_EQ(browser->exceptions, "") << "the page's script failed";
  }

  void open(const MadeSweep& sweep, int width = 1280, int height = 800) {
    browser->resize(width, height);
    browser->open(sweep.write(folder));
    ASSERT_TRUE(becomes("document.body && document.body.dataset.ready === 'yes'"));
  }

  Json value(const std::string& expression) { return browser->evaluate(expression); }
  std::string text_of(const std::string& selector) {
    return value("document.querySelector('" + selector + "').textContent");
  }
  bool becomes(const std::string& expression) {
    for (int k = 0; k < 400; ++k) {
      if (value("Boolean(" + expression + ")") == true) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    return false;
  }
  /// Waits until the page has drawn what changed: it learns one picture later what came into sight.
  void settle() {
    value(
        "(async () => { for (let k = 0; k < 4; ++k) await new Promise(requestAnimationFrame); "
        "})()");
  }
  void press(const std::string& name, int number) {
    browser->key(true, name, name, number);
    browser->key(false, name, name, number);
    settle();
  }
  void press_right() { press("ArrowRight", 39); }
  void focus(const std::string& selector) {
    value("document.querySelector('" + selector + "').focus()");
  }
  /// A place of an element in the window, shares of its size from its upper left corner.
  std::pair<double, double> place_of(const std::string& selector, double x, double y) {
    const std::string element = "document.querySelector('" + selector + "')";
    value(element + ".scrollIntoView({block: 'center'})");
    settle();
    const Json box =
        value("(() => { const r = " + element +
              ".getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; })()");
    return {box[0].get<double>() + x * box[2].get<double>(),
            box[1].get<double>() + y * box[3].get<double>()};
  }
  void click(const std::string& selector) {
    const auto [x, y] = place_of(selector, 0.5, 0.5);
    browser->click(x, y);
    settle();
  }
  /// Drags from one place of an element to another.
  void drag(const std::string& selector, double x0, double y0, double x1, double y1,
            int steps = 8) {
    const auto [ax, ay] = place_of(selector, x0, y0);
    const auto [bx, by] = place_of(selector, x1, y1);
    browser->drag(ax, ay, bx, by, steps);
    settle();
  }
  /// The colour in the middle of an element, as it is on the screen.
  std::vector<int> colour_at(const std::string& selector, double x = 0.5, double y = 0.5) {
    const auto [px, py] = place_of(selector, x, y);
    const render::Image shot = browser->screenshot();
    const std::size_t at =
        (std::size_t(py) * shot.width + std::size_t(px)) * std::size_t(shot.channels);
    return {shot.pixels[at], shot.pixels[at + 1], shot.pixels[at + 2]};
  }
  std::string picture() {
    return value("document.querySelector('[data-plate=b] img').getAttribute('src')");
  }
  void wait_for_pictures() {
    ASSERT_TRUE(
        becomes("[...document.querySelectorAll('#plates img[src]')]"
                ".every(i => i.complete && i.naturalWidth > 0)"));
    settle();
  }
  /// Returns the number of tiles in the page, once they are in sight: others are not drawn.
  int tiles() {
    place_of("#tiles", 0.5, 0.5);
    return value("document.querySelectorAll('.tile').length");
  }
  int lines() {
    place_of("#table-box", 0.5, 0.5);
    return value("document.querySelectorAll('#table tbody tr[data-at]').length");
  }

  TemporaryFolder folder;
  static inline std::unique_ptr<Chromium> browser;
};

TEST_F(ReportPage, ArrowKeysWalkAlongEveryAxisAndThroughTime) {
  MadeSweep sweep({3, 3, 2}, 3);
  sweep.manifest.first_number = 1;
  sweep.manifest.runs[6].settings.push_back({"fps", "12"});
  open(sweep);
  EXPECT_EQ(picture(), "runs/0000/particles/0002.png");
  EXPECT_EQ(text_of("#moment-text"), "frame 2, 0.042 s") << "frame 1 is at 0 s";
  focus("#axis-0");
  press_right();
  EXPECT_EQ(picture(), "runs/0006/particles/0002.png");
  EXPECT_EQ(text_of("#moment-text"), "frame 2, 0.083 s") << "its frames are longer";
  EXPECT_EQ(value("document.querySelector('#axis-0').getAttribute('aria-valuetext')"), "3162");
  focus("#axis-1");
  press_right();
  EXPECT_EQ(picture(), "runs/0008/particles/0002.png");
  EXPECT_EQ(value("document.querySelector('#axis-1').getAttribute('aria-valuetext')"), "apic");
  focus("#moment");
  press("ArrowLeft", 37);
  EXPECT_EQ(picture(), "runs/0008/particles/0001.png");
  wait_for_pictures();
  const std::vector<int> colour = colour_at("#plates");
  EXPECT_NEAR(colour[0], 100, 3);  // 40 * (8 % 6) + 20
  EXPECT_NEAR(colour[1], 60, 3);
  EXPECT_EQ(text_of("#nearest"), "");
  EXPECT_EQ(text_of("#shown-title"), "run 8");
  // The parameters and metrics beside it are of this run.
  EXPECT_EQ(value("[...document.querySelectorAll('#facts tbody tr')].slice(0, 4).map(r => "
                  "r.cells[2].textContent).join(' ')"),
            "3162 apic 1 11");
}

TEST_F(ReportPage, RunsWithoutAGridShowTheNearestOneAndSaySo) {
  MadeSweep sweep({4, 3}, 1);
  for (app::sweep::Run& run : sweep.manifest.runs) run.coordinates.clear();
  sweep.manifest.axes.clear();
  sweep.manifest.runs.erase(sweep.manifest.runs.begin() + 4);  // stiffness 3162, apic
  sweep.results.erase(sweep.results.begin() + 4);
  open(sweep);
  focus("#axis-0");
  press_right();
  EXPECT_EQ(text_of("#nearest"), "");
  focus("#axis-1");
  press_right();
  const std::string text = text_of("#nearest");
  EXPECT_NE(text.find("There is no run here; the nearest is run "), std::string::npos) << text;
  EXPECT_NE(text.find("instead of 3162"), std::string::npos) << text;
}

TEST_F(ReportPage, TwoRunsBesideEachOtherHaveTheWholeWidthAndNothingIsEmptyBelowThem) {
  open(MadeSweep({3, 3}, 2), 1400, 860);
  const auto box = [&](const std::string& part, const char* side) {
    return value("Math.round(document.querySelector('" + part + "').getBoundingClientRect()." +
                 side + ")")
        .get<int>();
  };
  EXPECT_LT(box("#plates", "right"), box("#sliders", "left"));
  click("[data-pin=a]");
  EXPECT_EQ(box("#plates", "width"), box("#walk", "width"));
  EXPECT_LE(box("#sliders", "top") - box("#stage", "bottom"), 40);
  EXPECT_LT(box("#sliders", "bottom"), 860) << "both pictures are seen while a slider moves";
  EXPECT_LE(box("#facts", "top") - box("#sliders", "top"), 30)
      << "the facts are beside the sliders";
  EXPECT_LT(box("#sliders", "right"), box("#facts", "left"));
}

TEST_F(ReportPage, TwoRunsArePinnedAndTheirDifferenceIsBlackWhereTheyAreTheSame) {
  open(MadeSweep({3, 3}, 1));
  click("[data-pin=a]");
  EXPECT_EQ(value("state.mode"), "side");
  focus("#axis-1");
  press_right();
  wait_for_pictures();
  EXPECT_NEAR(colour_at("[data-plate=a] img")[0], 20, 3);
  EXPECT_NEAR(colour_at("[data-plate=b] img")[0], 60, 3);
  EXPECT_NE(text_of("#compare-text").find("A: run 0. B: run 1"), std::string::npos);
  click("[data-pin=b]");
  focus("#axis-0");
  press_right();
  EXPECT_EQ(picture(), "runs/0001/particles/0000.png") << "a pinned run stays";
  click("[value=difference] + span");
  wait_for_pictures();
  // |60 - 20| = 40, four times as bright; the other colours are the same.
  std::vector<int> colour = colour_at("#plates");
  EXPECT_NEAR(colour[0], 160, 6);
  EXPECT_EQ(colour[1], 0);
  EXPECT_EQ(colour[2], 0);
  click("[data-pin=b]");
  focus("#axis-0");
  press("Home", 36);
  focus("#axis-1");
  press("Home", 36);
  wait_for_pictures();
  colour = colour_at("#plates");
  EXPECT_EQ(colour, (std::vector<int>{0, 0, 0})) << "a run and itself";
  click("[data-pin=a]");
  EXPECT_EQ(value("state.mode"), "one");
}

TEST_F(ReportPage, BrushesFilterSheetAndTable) {
  open(MadeSweep({3, 3}, 1));
  EXPECT_EQ(tiles(), 9);
  EXPECT_EQ(lines(), 9);
  // The first axis is the stiffness: its upper half keeps the greatest value.
  const double x = 0.5 / value("parallel.shown.length").get<double>();
  drag("#parallel", x, 0.3, x, 0.05);
  EXPECT_EQ(text_of("#count"), "3 of 9 runs");
  EXPECT_EQ(tiles(), 3);
  EXPECT_EQ(lines(), 3);
  EXPECT_EQ(value("[...document.querySelectorAll('#table tbody tr[data-at]')].every(r => "
                  "r.cells[1].textContent === '10000')"),
            true);
  // A filter by keys does the same.
  value("document.getElementById('filter-column').value = 2");
  focus("#filter-low");
  for (const char c : std::string("flip")) browser->type_letter(c);
  press("Enter", 13);
  value("document.getElementById('filter-form').requestSubmit()");
  settle();
  EXPECT_EQ(text_of("#count"), "1 of 9 runs");
  EXPECT_EQ(value("document.querySelectorAll('#brushes button').length"), 3);
  click("#brushes button:last-child");
  EXPECT_EQ(text_of("#count"), "9 runs");
  EXPECT_EQ(tiles(), 9);
  // The scatter plot of stiffness and spread: its lower left corner has three runs of nine.
  drag("#scatter", 0.07, 0.9, 0.18, 0.01);
  EXPECT_EQ(text_of("#count"), "3 of 9 runs");
  drag("#scatter", 0.07, 0.9, 0.18, 0.75);
  EXPECT_EQ(text_of("#count"), "1 of 9 runs");
  EXPECT_EQ(value("rows[state.kept[0]].run"), 0);
}

TEST_F(ReportPage, StarsAndNotesAreOnTilesInTheTableAndOfferedToTheFolder) {
  MadeSweep sweep({3, 3}, 1);
  sweep.manifest.marks[4] = {true, "as agreed"};
  open(sweep);
  value("localStorage.clear()");
  open(sweep);
  tiles();
  EXPECT_EQ(value("document.querySelectorAll('.tile .star.on').length"), 1);
  EXPECT_EQ(value("document.getElementById('unsaved').hidden"), true);
  // A star on a tile is no walk to its run.
  click(".tile[data-run=\"2\"] .star");
  EXPECT_EQ(value("rows[state.run].run"), 0);
  EXPECT_EQ(value("rows[2].mark.star"), true);
  value(
      "(() => { const note = document.getElementById('star-note'); note.value = \"it's wet\"; "
      "note.dispatchEvent(new Event('change')); })()");
  settle();
  EXPECT_EQ(value("rows[0].mark.note"), "it's wet");
  EXPECT_EQ(
      text_of("#unsaved code"),
      "neve sweep star 'out/a b.cdb' 0 --note 'it'\\''s wet' && neve sweep star 'out/a b.cdb' 2");
  lines();
  EXPECT_EQ(value("document.getElementById('run-4').cells[starColumn].textContent"),
            "\u2605 as agreed");
  // A note that the folder has is taken away by name.
  value("setMark(rows[4], {note: ''})");
  settle();
  EXPECT_NE(text_of("#unsaved code").find("sweep star 'out/a b.cdb' 4 --note ''"),
            std::string::npos);
  value("setMark(rows[4], {note: 'as agreed'})");
  settle();
  // A star that is taken away takes its note along, as the command that is offered does.
  value("toggleStar(rows[4])");
  settle();
  EXPECT_NE(text_of("#unsaved code").find("sweep star 'out/a b.cdb' 4 --remove"),
            std::string::npos);
  EXPECT_EQ(value("isSame(rows[4].mark, noMark)"), true);
  value("setMark(rows[4], {star: true, note: 'as agreed'})");
  settle();
  click("#only-stars input");
  EXPECT_EQ(text_of("#count"), "3 of 9 runs");
  click("#only-stars input");
  // Marks exist when the page is opened again; those that the folder has are not offered.
  sweep.manifest.marks[2] = {true, ""};
  open(sweep);
  EXPECT_EQ(value("rows[0].mark.star && rows[2].mark.star"), true);
  EXPECT_EQ(value("unsavedRows().map(row => row.run).join()"), "0");
  value("localStorage.clear()");
}

TEST_F(ReportPage, CellsOfTheHeatMapAreRunsAndArrowKeysMoveThere) {
  MadeSweep sweep({3, 3}, 1);
  sweep.fail(4, "too fast");
  open(sweep);
  EXPECT_EQ(value("heat.cells.map(cell => cell.runs.length).join('')"), "111111111");
  const auto [x, y] = place_of("#heat", 0.95, 0.1);
  browser->click(x, y);
  settle();
  EXPECT_EQ(value("rows[state.run].run"), 8) << "the upper right cell";
  press("ArrowLeft", 37);
  EXPECT_EQ(value("rows[state.run].run"), 5);
  press("ArrowDown", 40);
  EXPECT_EQ(value("rows[state.run].run"), 4);
  EXPECT_EQ(value("heat.cells[4].failed + ' ' + heat.cells[4].count"), "1 0");
  // The failed one is told in words and with a mark, everywhere.
  EXPECT_EQ(text_of("#shown-note"), "diverged: too fast");
  EXPECT_EQ(text_of(".tile.failed b"), "4: diverged; stiffness 3162, transfer apic");
  EXPECT_EQ(value("document.querySelectorAll('.tile .mark.failed').length"), 1);
  EXPECT_EQ(value("document.querySelectorAll('#table tr.failed').length"), 1);
  EXPECT_EQ(value("document.querySelector('[data-plate=b]').classList.contains('failed')"), true);
}

/// Cells tell the arithmetic mean, although values a factor of 20 apart have a logarithmic scale.
TEST_F(ReportPage, CellsOfSeveralRunsTellTheMeanOfTheirValues) {
  MadeSweep sweep({2, 2, 3}, 1);
  for (std::size_t k = 0; k < sweep.results.size(); ++k)
    sweep.results[k].metrics[0] = std::array{1.0, 4.0, 100.0}[k % 3];
  open(sweep);
  EXPECT_EQ(value("columns[state.colour].scale.isLog"), true);
  EXPECT_EQ(value("heat.cells[0].runs.length"), 3);
  EXPECT_EQ(value("meanText(columns[state.colour], heat.cells[0])"), "35");
}

TEST_F(ReportPage, PicturesAreNamedAsTheFolderHasThem) {
  open(MadeSweep({3, 3}, 1));
  EXPECT_EQ(value("[7, -2, 12345].map(pictureName).join(' ')"), "0007.png -002.png 12345.png");
}

TEST_F(ReportPage, HeadsOfTheTableSortIt) {
  open(MadeSweep({3, 3}, 1));
  const auto runs = [&] {
    return value(
               "[...document.querySelectorAll('#table tbody tr[data-at]')].map(r => "
               "r.cells[0].textContent).join('')")
        .get<std::string>();
  };
  EXPECT_EQ(runs(), "012345678");
  click("#table th:nth-child(3) button");
  EXPECT_EQ(runs(), "147036258");
  EXPECT_EQ(value("document.querySelector('#table th:nth-child(3)').ariaSort"), "ascending");
  click("#table th:nth-child(3) button");
  EXPECT_EQ(runs(), "258036147");
  place_of("#tiles", 0.5, 0.5);
  EXPECT_EQ(value("document.querySelector('.tile').dataset.run"), "2") << "so is the sheet";
}

/// A row of three points of four seeds: spread tells the last from the others, the second breaks
/// once.
MadeSweep sweep_with_seeds() {
  MadeSweep sweep({3, 4}, 1);
  Manifest& m = sweep.manifest;
  m.seeds = 4;
  m.axes.pop_back();
  m.parameters.back() = {"seed", "seed", "", "integer"};
  for (std::size_t k = 0; k < 12; ++k) {
    m.runs[k].coordinates.pop_back();
    m.runs[k].settings.back() = {"seed", std::to_string(1 + k % 4)};
    for (std::size_t metric = 1; metric < sweep.results[k].metrics.size(); ++metric)
      sweep.results[k].metrics[metric] = 1.0 + 0.1 * double((k * 5 + metric) % 4);
    sweep.results[k].metrics[0] = (k < 8 ? 0.5 : 0.9) + 0.01 * double(k % 4);
    sweep.results[k].has_broken = k == 6;
  }
  return sweep;
}

TEST_F(ReportPage, PointsOfSeveralSeedsHaveOneTileEachAndSayWhatIsNoise) {
  open(sweep_with_seeds());
  EXPECT_EQ(tiles(), 3);
  EXPECT_EQ(lines(), 3);
  const auto all = [&](const std::string& selector) {
    return value("[...document.querySelectorAll('" + selector +
                 "')].map(e => e.textContent).join('; ')")
        .get<std::string>();
  };
  EXPECT_EQ(all(".seal em"), "holds in 4 of 4; breaks in 1 of 4: not here; holds in 4 of 4");
  EXPECT_EQ(all(".seal strong"), "b; b; a");
  EXPECT_EQ(value("document.querySelectorAll('.seal .undecided').length"), 1);
  EXPECT_NE(text_of("#seal-hint").find("too close to call"), std::string::npos);
  EXPECT_EQ(text_of("#table tbody tr[data-at] td:nth-child(7)"), "0.515 (0.5 to 0.53) b");
  EXPECT_EQ(text_of("#table th.noise"), "height (m): noise");
  // The first two share a rank and so a colour; the table keeps their order.
  EXPECT_EQ(value("colourOf(0) === colourOf(4) && colourOf(0) !== colourOf(8)"), true);
  click("#table th:nth-child(7) button");
  EXPECT_EQ(value("state.shown.join(' ')"), "0 4 8");
  click("#table th:nth-child(7) button");
  EXPECT_EQ(value("state.shown.join(' ')"), "8 0 4");
  // Two points beside each other.
  click("[data-pin=a]");
  focus("#axis-0");
  press("End", 35);
  EXPECT_NE(text_of("#compare-text").find("They differ in spread (m)."), std::string::npos)
      << text_of("#compare-text");
  press("ArrowLeft", 37);
  EXPECT_NE(text_of("#compare-text").find("Too close to call: spread (m)"), std::string::npos)
      << text_of("#compare-text");
}

TEST_F(ReportPage, ButtonsKeysAndASliderFlipThroughTheSeedsOfAllTiles) {
  for (const int width : {1280, 390}) {
    open(sweep_with_seeds(), width, 800);
    EXPECT_EQ(value("document.querySelectorAll('#draws button').length"), 4);
    focus("#axis-0");
    press_right();
    EXPECT_EQ(picture(), "runs/0004/particles/0000.png");
    click("#draws button:nth-of-type(3)");
    EXPECT_EQ(picture(), "runs/0006/particles/0000.png");
    EXPECT_EQ(text_of("#draws button:nth-of-type(3)"), "seed 3 breaks");
    EXPECT_EQ(text_of("#draws span"), "breaks in 1 of 4: here");
    EXPECT_EQ(tiles(), 3);
    EXPECT_EQ(value("[...document.querySelectorAll('.tile')].map(t => t.dataset.run).join(' ')"),
              "2 6 10");
    press("]", 221);
    EXPECT_EQ(picture(), "runs/0007/particles/0000.png");
    press("]", 221);
    EXPECT_EQ(picture(), "runs/0004/particles/0000.png") << "the first follows the last";
    focus("#axis-1");
    press_right();
    EXPECT_EQ(picture(), "runs/0005/particles/0000.png");
    EXPECT_EQ(text_of("#nearest"), "");
  }
}

TEST_F(ReportPage, CommandsAreCopiedAndOpenTheRun) {
  open(MadeSweep({3, 3}, 2));
  browser->call("Browser.grantPermissions",
                {{"permissions", {"clipboardReadWrite", "clipboardSanitizedWrite"}}});
  click("#shown-links button");
  EXPECT_TRUE(becomes("document.querySelector('#shown-links button').textContent === 'copied'"));
  EXPECT_EQ(value("navigator.clipboard.readText()"),
            "neve view 'out/a b.cdb/runs/0000/scene.toml'");
  // A browser may keep the clipboard from files.
  value("Object.defineProperty(navigator, 'clipboard', {value: undefined})");
  value("document.querySelector('#shown-links div:nth-child(2) button').focus()");
  value(
      "window.taken = ''; document.addEventListener('copy', () => { taken = "
      "document.activeElement.value; })");
  press("Enter", 13);
  click("#shown-links div:nth-child(2) button");
  EXPECT_TRUE(becomes("taken === \"neve view 'out/a b.cdb/runs/0000/particles/0001.png'\""))
      << value("taken");
  EXPECT_EQ(value("document.querySelector('#shown-links a').getAttribute('href')"),
            "runs/0000/particles/0001.png");
}

TEST_F(ReportPage, WordsOfStrangersStayText) {
  MadeSweep sweep({2, 2}, 1);
  const std::string evil = "</script><img src=x onerror=\"document.title='owned'\">";
  for (app::sweep::Run& run : sweep.manifest.runs) run.label = evil;
  sweep.manifest.axes[0].name = evil;
  sweep.manifest.axes[1].values[0] = evil;
  sweep.manifest.parameters[0].name = evil;
  sweep.manifest.scene_file = evil;
  sweep.results[0].warnings = {evil};
  sweep.fail(1, evil);
  open(sweep);
  click(".tile.failed");
  EXPECT_EQ(value("document.querySelectorAll('img[src=x], [onerror]').length"), 0);
  EXPECT_EQ(value("document.title"), sweep.manifest.title);
  EXPECT_EQ(text_of("#shown-title"), "run 1 \u00b7 " + evil);
  EXPECT_EQ(text_of("#shown-note"), "diverged: " + evil);
  EXPECT_EQ(text_of(".slider label"), evil);
}

TEST_F(ReportPage, NothingIsWiderThanAWindowOfADeskOrAPhone) {
  MadeSweep sweep({4, 3, 3}, 2);
  sweep.fail(5, "explodes at once with a reason that is much longer than a phone is wide");
  for (const int width : {1280, 860, 390}) {
    open(sweep, width, 800);
    EXPECT_LE(value("document.documentElement.scrollWidth"), width);
    click("[data-pin=a]");
    EXPECT_LE(value("document.documentElement.scrollWidth"), width) << "two beside each other";
    EXPECT_GE(value("Math.round(document.getElementById('plates').clientWidth)"),
              width > 860 ? 700 : width - 40);
    // Every control can be named by a screen reader.
    EXPECT_EQ(value("[...document.querySelectorAll('input, select, button')].filter(e => "
                    "!(e.labels && e.labels.length) && !e.ariaLabel && !e.textContent.trim())"
                    ".length"),
              0);
  }
}

/// Milliseconds between pictures while the page does something at each of them.
constexpr const char* measure_frames = R"((async act => {
  const next = () => new Promise(requestAnimationFrame);
  const times = [];
  let before = await next();
  for (let k = 0; k < 60; ++k) {
    act(k);
    const now = await next();
    times.push(now - before);
    before = now;
  }
  times.sort((a, b) => a - b);
  return [times[30], times[57]];
}))";

TEST_F(ReportPage, LargeSweepsLoadAndDrawOnlyWhatIsInSight) {
  MadeSweep sweep({20, 5, 5}, 3);
  for (std::size_t k = 7; k < sweep.results.size(); k += 50) sweep.fail(k, "too fast");
  ASSERT_EQ(sweep.results.size(), 500u);
  open(sweep);
  wait_for_pictures();
  const double opened =
      value("performance.timing.domContentLoadedEventEnd - performance.timing.navigationStart");
  RecordProperty("open_ms", int(opened));
  std::printf("500 runs: open in %.0f ms\n", opened);
  const auto counts = [&](const char* when) {
    settle();
    // The page has the pictures of the window's height and a little more, for any number of runs.
    EXPECT_LE(value("document.querySelectorAll('img[src]').length"), 60) << when;
    EXPECT_LE(value("document.querySelectorAll('#walk *, #table *, #tiles *').length"), 2500)
        << when;
    EXPECT_LE(value("document.querySelectorAll('*').length"), 4000) << when;
  };
  counts("at the start");
  EXPECT_EQ(value("[...document.querySelectorAll('.tile img[src]')].filter(i => "
                  "i.getBoundingClientRect().top > innerHeight).length"),
            0)
      << "pictures below the window";
  place_of("#parallel", 0.5, 0.5);
  const auto frames = [&](const char* what, const std::string& act) {
    const Json times = value(std::string(measure_frames) + "(" + act + ")");
    std::printf("500 runs, %s: %.1f ms between pictures, 95 %% below %.1f ms\n", what,
                times[0].get<double>(), times[1].get<double>());
  };
  frames("a brush", "k => setBrush(1, [0.01 * k, 0.01 * k + 0.4])");
  counts("after a brush");
  // One of many changes before the next picture is drawn.
  EXPECT_LE(
      value("(async () => { await new Promise(requestAnimationFrame); const before = work.paints;"
            "for (let k = 0; k < 100; ++k) setBrush(1, [0, 0.01 * k]);"
            "await new Promise(requestAnimationFrame); await new Promise(requestAnimationFrame);"
            "return work.paints - before; })()"),
      2 * value("painters.length").get<int>());
  value("state.brushes.clear(); change('brush'); scrollTo(0, 0)");
  frames("a slider", "k => slideTo(0, k % 20)");
  counts("after a slider");
  value("document.getElementById('tiles').scrollTop = 3000");
  counts("after scrolling");
  EXPECT_LE(tiles(), 60);
}

}  // namespace
}  // namespace neve::test
