#pragma once
/// The pictures of a run: views and mosaics with plate, shutter and channels.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/health/diagnosis.h"
#include "app/output/picture_writer.h"
#include "app/picture/frame_builder.h"
#include "app/run/passes.h"
#include "app/run/render_job.h"
#include "app/scene/scene.h"
#include "app/timeline/timeline.h"
#include "render/image/cube_lut.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace neve::app::run {

class Drawing {
 public:
  /// @param job, seeded, renderer  outlive it
  /// @param record  of all pictures, see picture_record()
  Drawing(const RenderJob& job, const setup::SeededScene& seeded, render::Renderer& renderer,
          record::PictureRecord record);

  /// Views that are drawn by themselves.
  std::vector<std::string> views() const;

  /// Reads the state at the end of a frame: the run may move on while it is drawn.
  picture::Snapshot read(const timeline::Timeline& timeline, std::uint64_t state_hash);
  /// Returns the scene that was read last.
  const scene::Scene& scene() const { return scene_; }

  struct Files {
    std::vector<output::Picture> pictures;  ///< of views, then of mosaics
    std::vector<output::WriteTask> channels;
  };
  Files draw(const picture::Snapshot& snapshot);

  /// The pictures of words before the first pictures of a run. @param record  of it
  std::vector<output::Picture> draw_slates(const record::RunRecord& record);

  /// The state that broke a rule, with the culprits marked, and the slice through them; pictures,
  /// but no frames.
  std::vector<output::Picture> draw_incident(const timeline::Timeline& timeline,
                                             const sim::Divergence& divergence,
                                             const health::Diagnosis& diagnosis);

 private:
  picture::Snapshot take(const timeline::Timeline& timeline, const std::vector<scene::View>& views,
                         int frame, std::uint64_t state_hash);
  /// Frames while the shutter is open; none without motion blur.
  render::Moments shutter_frames(const scene::View& view, const render::Frame& frame,
                                 const picture::Snapshot& snapshot) const;
  /// The mean of the moments, or the frame where there are none.
  render::Image draw_mean(const render::Frame& frame, const render::Moments& moments,
                          const std::optional<render::Image>& plate);
  output::WriteTask draw_channels(const picture::MotionSource& source, const render::Frame& frame,
                                  const render::Moments& moments);
  record::PictureRecord record_of(const std::string& view) const;
  /// Returns the text of a picture that no frame makes again. @param lines  names and texts
  render::PngText sheet_text(const std::string& what, const std::string& view,
                             const std::vector<std::pair<std::string, std::string>>& lines,
                             const std::string& again) const;
  output::Picture picture_of(const std::string& view, render::Image image) const;

  const RenderJob& job_;
  const setup::SeededScene& seeded_;
  render::Renderer& renderer_;
  record::PictureRecord record_;
  scene::Scene scene_;  ///< the job's with the changes made so far
  picture::FrameBuilder builder_;
  std::optional<render::CubeLut> lut_;        ///< of --lut
  std::optional<PassReader> passes_;          ///< of --passes
  std::vector<picture::PlotSample> history_;  ///< of the snapshot that was read
  std::vector<render::channels::PointNumbers> pass_numbers_;
};

/// Words of a slate besides those of the scene.
struct SlateWords {
  int number = 0;                       ///< of the slate
  std::string view;                     ///< or mosaic
  std::vector<std::string> parameters;  ///< lines, see picture::FrameBuilder::slate
};

/// @param like  a picture of the view: its size and channels
render::Image draw_slate(const scene::Scene& scene, const SlateWords& words,
                         const render::Image& like, render::Renderer& renderer);

/// The file of a frame: "street/%04d.png" with the number in the place of %04d; a name without a
/// place is one picture for all frames. @throws UsageError for any other use of %
std::filesystem::path plate_path(const std::string& pattern, int frame);

/// Reads the plate of a job: a PNG, a JPEG, or the RGB or Y of an OpenEXR file in linear light;
/// alpha lies over black. @return RGB @throws IoError; Error when it is none of them, not of the
/// size of the view, or a picture names it that was not made with it; LimitError
render::Image read_plate(const RenderJob& job, int frame, const std::string& view,
                         const scene::PictureSize& size);

/// Reads the plates of all frames for every view: a wrong one is found before the run, and before
/// what it replaces is gone. A run that is continued may have no more than those it needs.
/// @throws as read_plate
void check_plates(const RenderJob& job);

/// The look of --lut. @throws IoError; Error when it is no .cube file
render::CubeLut read_lut(const std::string& file);

}  // namespace neve::app::run
