#pragma once
/// Runs of a sweep as a job array of Slurm.

#include <filesystem>
#include <string>
#include <vector>

#include "app/output/movie_format.h"
#include "app/support/progress.h"
#include "app/sweep/jobs/local.h"

namespace neve::app::sweep::jobs {

struct SlurmOptions {
  std::filesystem::path program;
  std::string backend = "auto";
  int jobs = 0;                      ///< tasks at once; 0: as many as Slurm gives
  int threads = 1;                   ///< of each run
  std::vector<std::string> options;  ///< further ones of sbatch, "--partition=long"
  output::MovieStyle movie{};        ///< of the sheets, which the last job makes
  bool has_review = false;           ///< links to all pictures, see CollectOptions
};

/// One array that Slurm accepts: task t is the run offset + t.
struct SlurmArray {
  int offset = 0;
  std::string tasks;      ///< "0-7,9"
  std::vector<int> runs;  ///< by their indices
};

/// Arrays for these runs with indices below the site's MaxArraySize.
std::vector<SlurmArray> split_arrays(const std::vector<int>& indices, int max_array_size);

/// Submits the unfinished ones of these runs, and a job that collects when all have ended; then
/// waits for that, with progress. Runs of jobs that an earlier call submitted and that are still
/// there are waited for, and submitted no second time. Runs that Slurm takes no job for yet are
/// submitted when another job has ended. A Ctrl-C cancels the jobs.
/// @throws Error where there is no Slurm, or it refuses
JobsResult run_slurm(const std::filesystem::path& folder, const store::Manifest& manifest,
                     const std::vector<int>& indices, const SlurmOptions& options,
                     const std::string& retry_failed, Progress& progress);

}  // namespace neve::app::sweep::jobs
