#include "app/run/resume.h"

#include <algorithm>
#include <new>

#include "app/output/atomic_file.h"
#include "app/output/movie_format.h"
#include "app/record/earlier.h"
#include "app/record/verify.h"
#include "app/run/identity.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "sim/simulation.h"

namespace neve::app::run {

namespace {

/// Adds the frames that run.json lists and the checkpoint does not: those after it, those that
/// later commands have drawn before its first one, and all of an earlier version. Their pictures
/// stay listed until they are made again. For a file that both list, run.json is the later one.
void add_listed(const std::filesystem::path& folder, const Json& run_json, timeline::Made& run) {
  if (run.frames.empty() && run_json.is_object()) run.exports = run_json.value("exports", Json());
  for (const record::FrameRecord& frame : record::frame_records(run_json))
    if (!std::ranges::binary_search(run.frames, frame.frame, {}, &record::FrameRecord::frame))
      record::add_frame(run.frames, frame);
  for (const auto& [file, hash] : record::file_hashes(run_json)) run.files[file] = hash;
  // Pictures are in folders. Movies are made again at the end; those of other formats stay ours.
  std::erase_if(run.files, [&](const auto& file) {
    if (file.first.find('/') != std::string::npos) return false;
    const std::string suffix = std::filesystem::path(file.first).extension().string();
    const bool is_movie = !suffix.empty() && output::movie_format_named(suffix.substr(1));
    return !is_movie || !record::has_hash(folder / file.first, file.second);
  });
}

/// @return what to warn of
std::vector<std::string> check_identity(const std::filesystem::path& folder,
                                        const output::Checkpoint& checkpoint,
                                        const record::PictureRecord& picture,
                                        const std::string& simd) {
  if (checkpoint.identity != identity_of(picture))
    throw UsageError(
        "--resume",
        "the run in " + folder.string() +
            " is a different run: " + difference_from_run(folder, picture),
        "--replace instead of --resume replaces it, or choose another folder with --out");
  if (!sim::Simulation::can_read(checkpoint.state))
    throw UsageError("--resume",
                     "another build of neve has begun the run in " + folder.string() +
                         ", and this one cannot read its states",
                     "--replace instead of --resume makes all of it again");
  std::vector<std::string> warnings;
  if (checkpoint.sources != build().sources)
    warnings.push_back(
        earlier_part +
        " was made by a program with other sources: this part may not be what that program would "
        "make; --replace instead of --resume makes all of it again");
  if (checkpoint.simd != simd)
    warnings.push_back(earlier_part + " used " + checkpoint.simd +
                       " instructions, this part uses " + simd +
                       ": the last bits will differ; use NEVE_SIMD=" + checkpoint.simd +
                       " if this machine has it");
  return warnings;
}

/// Pictures and exports up to the moment that are not as the run wrote them.
std::vector<record::Flaw> find_flaws(const std::filesystem::path& folder,
                                     const record::RunRecord& record, setup::FrameRange frames,
                                     Resumption& found) {
  const timeline::Moment& moment = found.moment;
  const int start = moment.made.first_number, reached = start + moment.frame;
  record::Pictures pictures{record.views, record.views_of_passes, moment.made.frames,
                            moment.made.files};
  std::erase_if(pictures.frames,
                [&](const record::FrameRecord& made) { return made.frame > reached; });
  std::vector<record::Flaw> flaws = record::picture_flaws(
      folder, pictures, start + frames.first, std::min(reached, start + frames.last), found.flawed);
  try {
    for (record::Flaw& flaw : record::export_flaws(folder, moment.made.exports, moment.made.files,
                                                   reached, found.flawed))
      flaws.push_back(std::move(flaw));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    timeline::refuse_moment(moment.file, error);
  }
  for (int& frame : found.flawed) frame -= start;
  std::sort(found.flawed.begin(), found.flawed.end());
  found.flawed.erase(std::unique(found.flawed.begin(), found.flawed.end()), found.flawed.end());
  return flaws;
}

}  // namespace

std::string simulation_in_parts() {
  return record::hash_of(earlier_part);
}

std::optional<Resumption> find_resumption(const std::filesystem::path& folder,
                                          const record::RunRecord& record,
                                          const record::PictureRecord& picture,
                                          setup::FrameRange frames, bool may_differ,
                                          Progress& progress) {
  output::FoundCheckpoint found = output::find_checkpoint(folder);
  for (const std::string& damaged : found.damaged)
    progress.warning(damaged + "; using an older checkpoint");
  if (!found.checkpoint) {
    progress.note("no checkpoint in " + folder.string() + ": the run starts at its first frame");
    return std::nullopt;
  }
  if (may_differ && found.checkpoint->identity != identity_of(picture)) return std::nullopt;
  std::vector<std::string> warnings =
      check_identity(folder, *found.checkpoint, picture, record.simd);
  for (const std::string& warning : warnings) progress.warning(warning);
  Resumption resumption{timeline::to_moment(*std::move(found.checkpoint)), {}, std::move(warnings)};
  timeline::Moment& moment = resumption.moment;
  add_listed(folder, record::read_run_json(folder), moment.made);
  const std::vector<record::Flaw> flaws = find_flaws(folder, record, frames, resumption);
  if (!flaws.empty())
    progress.warning(folder.string() + ": " + record::flaw_text(flaws) + "; made again");
  return resumption;
}

}  // namespace neve::app::run
