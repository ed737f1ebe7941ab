#pragma once
/// A picture that comes alone may be anyone's: what it costs to make again, and which files it
/// reads elsewhere, is said before, and who opens it agrees.

#include <cstddef>
#include <string>
#include <vector>

#include "app/record/picture_record.h"
#include "app/scene/scene.h"
#include "app/setup/plan.h"

namespace neve::app::timeline {

enum class Agreement {
  asked,    ///< on the terminal; refused where nobody can be asked
  given,    ///< by --yes, or because nothing is made
  refused,  ///< whoever opened the picture cannot be asked, as by dropping it into a window
};

/// The cost of making a scene's frames again, roughly and from its numbers alone.
struct AgainCost {
  double seconds = 0;
  double particle_steps = 0;
  std::uint64_t memory = 0;  ///< bytes

  /// "about 3 min 20 s: 24 frames, 2.1e+09 particle steps, 310 MiB"
  std::string text(int last_frame) const;
};

/// Returns what `neve info` says of making a picture again: its cost, or why that is not known
/// before its files are read.
std::string again_text(const record::PictureRecord& record, const std::string& file);

/// Requires agreement to more than a minute or 500 MB for a picture that is in no folder of a run.
/// @param scene  of the picture, with the edits of who opened it
/// @param last   frame that is made, counted from 0
/// @throws LimitError for more than the limits allow, and where nobody agrees
void require_agreement(const record::PictureRecord& record, const std::string& file,
                       const scene::Scene& scene, int last, Agreement agreement);

/// Requires agreement to files outside of the folder of a picture that is in no folder of a run.
/// @throws LimitError where nobody agrees
void require_agreement(const std::string& file, const std::vector<std::string>& outside,
                       Agreement agreement);

}  // namespace neve::app::timeline
