#include "app/sweep/jobs/slurm_jobs.h"

#include <fmt/core.h>

#include <sstream>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

fs::path jobs_path(const fs::path& folder) {
  return folder / "slurm" / "jobs.json";
}

}  // namespace

std::string job_number(const std::string& answer) {
  std::istringstream lines(answer);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    const std::string number = trimmed(line.substr(0, line.find(';')), " \t\r");
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos)
      found = number;
  }
  if (found.empty())
    throw Error(exit_io,
                fmt::format("sbatch answered \"{}\"; expected a line with the number of a job",
                            trimmed(answer, " \t\r\n")),
                "sbatch", "a job may be queued all the same: squeue --me lists it");
  return found;
}

std::vector<QueuedJob> queued_jobs(const fs::path& folder) {
  std::vector<QueuedJob> jobs;
  try {
    for (const Json& job : output::read_json(jobs_path(folder)))
      jobs.push_back({job.at("job").get<std::string>(), job.at("runs").get<std::vector<int>>(),
                      job.at("is_beginning").get<bool>(), job.value("offset", 0)});
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return {};
  }
  return jobs;
}

void write_queued_jobs(const fs::path& folder, const std::vector<QueuedJob>& jobs) {
  Json list = Json::array();
  for (const QueuedJob& job : jobs)
    list.push_back({{"job", job.number},
                    {"runs", job.runs},
                    {"is_beginning", job.is_beginning},
                    {"offset", job.offset}});
  output::write_file(jobs_path(folder), to_text(list) + "\n");
}

}  // namespace neve::app::sweep::jobs
