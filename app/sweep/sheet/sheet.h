#pragma once
/// Contact sheets: all runs in one picture, with the words that tell them apart.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/sweep/sheet/moments.h"
#include "app/sweep/sheet/seals.h"
#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/store/results.h"
#include "render/renderer.h"

namespace neve::app::sweep::sheet {

class SheetMaker {
 public:
  /// With seeds, each point has one tile: its first run.
  /// @param predictions  of the points; none without --predict
  /// @param legends shared by all tiles; they and the renderer must outlive it
  SheetMaker(std::filesystem::path folder, const store::Manifest& manifest,
             const std::vector<store::RunResult>& results,
             const std::vector<predict::Prediction>& predictions,
             const std::vector<render::Legend>& legends, render::Renderer& renderer);

  /// Every run of a page at a frame. A run that got less far shows where it stopped, dark, and says
  /// why; one without a picture says that and why.
  render::Image sheet(int frame, std::size_t page);

  const std::vector<SheetPage>& pages() const { return pages_; }

  /// Some moments of every run side by side, one run below the other; several pictures where one
  /// cannot hold all runs.
  std::vector<render::Image> strips();

 private:
  struct Tile {
    const Run* run;
    const store::RunResult* result;
    int frame;
    int x, y;  ///< px
  };

  /// Tiles of points that were made at full resolution show that run.
  void show_full_runs(const store::Manifest& manifest);
  render::Image compose(const SheetLayout& layout, const std::vector<Tile>& tiles,
                        render::Frame& words) const;
  render::Image tile_picture(const Tile& tile, int width, int height, bool is_late) const;
  void add_tile_words(const SheetLayout& layout, const Tile& tile, bool is_late,
                      render::Frame& words) const;
  void add_missing(const SheetLayout& layout, const Tile& tile, render::Frame& words) const;
  void add_seal(const SheetLayout& layout, const Tile& tile, render::Frame& words) const;
  void add_star(const SheetLayout& layout, const Tile& tile, render::Frame& words) const;
  void add_state(const SheetLayout& layout, const Tile& tile, render::Frame& words) const;
  /// A line in the middle of a tile.
  void add_middle(const SheetLayout& layout, const Tile& tile, const std::string& text,
                  const std::array<std::uint8_t, 3>& color, render::Frame& words) const;
  /// @param first, count  runs
  store::Manifest strip_grid(const std::vector<int>& frames, std::size_t first,
                             std::size_t count) const;
  render::Image strips_of(const std::vector<int>& frames, const SnowInPictures& snow,
                          std::size_t first, const SheetLayout& layout, const std::string& heading);
  render::Frame frame_of(const SheetLayout& layout, const std::string& line) const;

  std::filesystem::path folder_;
  store::Manifest manifest_;               ///< of the runs that have a tile
  std::vector<store::RunResult> results_;  ///< theirs
  int newest_ = 0;                         ///< the last frame that one of them has a picture of
  Seals seals_;
  std::string counts_;  ///< "12 runs, 1 failed", of all runs
  const std::vector<render::Legend>& legends_;
  render::Renderer& renderer_;
  store::Manifest head_;   ///< without runs
  store::Manifest named_;  ///< with a label on each tile
  std::vector<SheetPage> pages_;
};

}  // namespace neve::app::sweep::sheet
