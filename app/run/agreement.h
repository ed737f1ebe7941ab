#pragma once
/// A picture that comes alone may be anyone's: what it costs to make again is said before, and who
/// opened it agrees.

#include <string>

#include "app/record/picture_record.h"
#include "app/run/render_job.h"
#include "app/setup/plan.h"

namespace neve::app::run {

/// What making a scene's frames again takes, roughly and from its numbers alone.
struct AgainCost {
  double seconds = 0;
  double particle_steps = 0;
  std::uint64_t memory = 0;  ///< bytes

  /// "about 3 min 20 s: 24 frames, 2.1e+09 particle steps, 310 MiB"
  std::string text(int last_frame) const;
};

/// @param changes  made while the run ran
AgainCost cost_again(const scene::Scene& scene, const setup::Plan& plan, std::size_t changes);

/// What `neve info` says of a picture: its cost, or why that is not known before its files are
/// read.
std::string again_text(const record::PictureRecord& record, const std::string& file);

/// Asks on the terminal where a job makes a picture again that lies in no folder of a run and takes
/// more than a minute or 500 MB.
/// @param is_agreed      by --yes
/// @param picture_bytes  of memory beside the plan @throws LimitError where nobody agrees
void require_agreement(const RenderJob& job, const setup::Plan& plan, bool is_agreed,
                       double picture_bytes = 0);

}  // namespace neve::app::run
