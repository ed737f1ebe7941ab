#pragma once
/// Pictures of two states against each other, with one camera and one light.

#include <array>
#include <string>
#include <vector>

#include "app/compare/series.h"
#include "app/compare/sides.h"
#include "app/picture/frame_builder.h"
#include "app/scene/scene.h"
#include "app/timeline/timeline.h"
#include "render/renderer.h"

namespace neve::app::compare {

class PairPainter {
 public:
  /// @param options, pair, renderer outlive the painter
  /// @throws UsageError for a view that A does not have
  PairPainter(const PairOptions& options, const Pair& pair, render::Renderer& renderer);

  /// Takes both states at a frame, and adds to the moment what is measured on them.
  /// @param modes  that will be drawn
  void take(const timeline::Timeline& a, const timeline::Timeline& b,
            const std::vector<Mode>& modes, PairMoment& moment);

  render::Image draw(Mode mode) const;

  /// @throws LimitError for a picture of a mode that is too large to be drawn
  void check_sizes(const std::vector<Mode>& modes) const;

 private:
  struct Taken {
    scene::Scene scene;
    const setup::SeededScene* seeded = nullptr;
    picture::Snapshot snapshot;
  };
  scene::View view_for(Mode mode) const;
  Taken take_side(const timeline::Timeline& timeline, const std::vector<Mode>& modes) const;
  /// The frames of A and B for a mode; the camera and light are A's.
  std::array<render::Frame, 2> frames_for(Mode mode) const;
  render::Image draw_with_words(std::vector<render::Image> images, Mode mode) const;
  std::string line_for(Mode mode) const;

  const PairOptions& options_;
  const Pair& pair_;
  render::Renderer& renderer_;
  scene::View view_;
  double range_ = 0;           ///< m, displacement that has the last colour
  double full_density_ = 400;  ///< kg/m3
  Taken a_, b_;
  Displacement displacement_;
  MassDifference mass_;
};

/// Words about one of the two runs.
struct StripWords {
  std::string title;   ///< "A   out/soft"
  std::string values;  ///< "hardening = 5"
};

/// Returns the size of the picture that with_strip() makes of so many images of this size.
scene::PictureSize size_with_strip(const scene::PictureSize& image, int count);

/// @param images  of one size: two beside each other, or one that shows both
/// @param line    below them
/// @param colors  of the titles
render::Image with_strip(const std::vector<render::Image>& images,
                         const std::array<StripWords, 2>& words, const std::string& line,
                         render::Renderer& renderer);

/// A picture of the left part of one and the right part of another of its size.
/// @param share  of the width that is from the left one, 0 to 1
render::Image wiped(const render::Image& left, const render::Image& right, double share);

/// Takes alpha out: the image is laid over a plain colour.
render::Image opaque(render::Image image);

}  // namespace neve::app::compare
