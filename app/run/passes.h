#pragma once
/// The passes of --passes: channels of OpenEXR pictures beside the PNGs.

#include <string>
#include <vector>

#include "app/exports/columns.h"
#include "app/exports/origins.h"
#include "app/picture/motion.h"
#include "app/record/picture_record.h"
#include "render/channels/channels.h"
#include "render/image/exr.h"

namespace neve::app::run {

/// A list of passes as it is meant.
struct PassList {
  std::set<render::channels::Pass> passes;
  std::vector<scene::ColorBy> values;              ///< attributes that colours show
  std::vector<scene::ExportAttribute> attributes;  ///< the others, as exports have them
};

/// Reads "depth,normal", "all" and names of attributes.
/// @return the names, without doubles, all written out @throws UsageError for an unknown name
std::vector<std::string> parse_passes(const std::string& text);

/// @param names  of parse_passes, or of a picture @throws UsageError for an unknown name
PassList pass_list(const std::vector<std::string>& names);

/// The passes that a scene can have: where the state does not say which emitter snow comes from,
/// "all" is without the pass of bodies.
/// @param names  of parse_passes, or of a picture
/// @throws UsageError for those that are asked for by name
std::vector<std::string> passes_of(const scene::Scene& scene, std::vector<std::string> names);

/// Bytes that the channels of a pixel take while they wait for the encoder.
double bytes_of_pixel(const PassList& list);

/// Views that a snapshot has to be taken for besides those that are drawn, so that it has stress.
std::vector<scene::View> views_for(const PassList& list);

/// Reads the numbers of particles for the passes of a run.
class PassReader {
 public:
  /// @param scene, seeded outlive the reader
  PassReader(const scene::Scene& scene, const setup::SeededScene& seeded, PassList list);

  const PassList& list() const { return list_; }

  /// Reads the state for a frame. @param snapshot  of the same state
  /// @return attributes of all particles of the snapshot, in its order
  std::vector<render::channels::PointNumbers> read(const picture::Snapshot& snapshot,
                                                   const sim::Simulation& simulation) const;

  /// @param frame built from the source @param numbers  of read()
  render::channels::Request request(
      const picture::MotionSource& source, const render::Frame& frame,
      const std::vector<render::channels::PointNumbers>& numbers) const;

  /// The header: the record of the picture, time, camera, and names by number.
  render::ExrHeader header(const record::PictureRecord& record, const render::Frame& frame) const;

 private:
  const scene::Scene& scene_;
  PassList list_;
  exports::Origins origins_;
  exports::Carried carried_;
};

}  // namespace neve::app::run
