#pragma once
/// Jobs that a sweep has queued with Slurm, on disk as soon as their numbers are known.

#include <filesystem>
#include <string>
#include <vector>

namespace neve::app::sweep::jobs {

struct QueuedJob {
  std::string number;
  std::vector<int> runs;      ///< of an array, by their indices; of other jobs none
  bool is_beginning = false;  ///< an array of common beginnings; runs are theirs
  int offset = 0;             ///< of an array: task t is the run offset + t
};

/// The number of a job in the answer of sbatch --parsable, "4711" or "4711;cluster", behind
/// whatever a site prints in front. @throws Error without one, with the answer
std::string job_number(const std::string& answer);

/// Reads the queued jobs from FOLDER/slurm/jobs.json; returns none if that cannot be read.
std::vector<QueuedJob> queued_jobs(const std::filesystem::path& folder);
/// @throws IoError
void write_queued_jobs(const std::filesystem::path& folder, const std::vector<QueuedJob>& jobs);

}  // namespace neve::app::sweep::jobs
