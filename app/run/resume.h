#pragma once
/// The way back into a run that ended early.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/record/picture_record.h"
#include "app/setup/plan.h"
#include "app/support/progress.h"
#include "app/timeline/moment.h"

namespace neve::app::run {

struct Resumption {
  timeline::Moment moment;  ///< of the newest checkpoint
  /// Frames before it with pictures that are missing or damaged, in order.
  std::vector<int> flawed{};
  std::vector<std::string> warnings{};  ///< of what made the part until then, already said
};

/// Begins each of these warnings.
inline const std::string earlier_part = "the earlier part of the run";
/// RunRecord::simulation of a run whose parts different instructions or programs have made: no
/// command has it, so none adds anything made from the start.
std::string simulation_in_parts();

/// Finds the newest checkpoint that is whole; damaged ones are named and passed over. Compares the
/// pictures up to it with the run's own list. Empty without a checkpoint: the run starts at its
/// beginning.
/// @param record   of this run, for the views that have pictures
/// @param picture  of any view and frame: its record makes the run again
/// @param frames   that are to have pictures
/// @param may_differ  a run that is drawn otherwise is no error: empty then, the same simulation is
/// drawn from its states
/// @throws UsageError when the run in the folder is another one
std::optional<Resumption> find_resumption(const std::filesystem::path& folder,
                                          const record::RunRecord& record,
                                          const record::PictureRecord& picture,
                                          setup::FrameRange frames, bool may_differ,
                                          Progress& progress);

}  // namespace neve::app::run
