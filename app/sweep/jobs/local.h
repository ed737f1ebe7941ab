#pragma once
/// Runs of a sweep side by side on this machine.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/support/progress.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

struct LocalOptions {
  int cores = 1;
  int jobs = 0;  ///< runs side by side; 0: as many as keep the cores busy and fit into memory
  std::string backend = "auto";
  double budget = 0;              ///< s for all of them; 0: as long as they take
  std::vector<int> beginnings{};  ///< indices of common beginnings to make, whatever runs need
  store::Retry retry_failed;      ///< states of runs that are made once more
  /// One run of a sweep whose others are processes too: its common beginning was tried for all.
  bool is_one_of_many = false;
  double grace = 20;              ///< s that a run has to end when it is asked to
  std::filesystem::path program;  ///< whose `render` makes the runs
};

/// The machine failed, as by a full disk: this says nothing about a run.
struct MachineFailure {
  int code = 0;  ///< exit_io, exit_no_backend
  std::string reason;
};

struct JobsResult {
  int ok = 0, failed = 0;       ///< of all that were asked for, earlier ones included
  int started = 0;              ///< now
  bool is_interrupted = false;  ///< some run waits for the next time
  int out_of_time = 0;          ///< runs that the budget ended, or was too short for
  int elsewhere = 0;            ///< runs that another process is making
  std::string elsewhere_text;   ///< which, and who makes it, of the last of them
  int failed_beginnings = 0;    ///< of those that runs waited for
  std::optional<MachineFailure> failure;
  double seconds = 0, cpu_seconds = 0;  ///< of the whole; of all children
  double core_seconds = 0;              ///< time of the children times their threads
};

/// Runs the common beginnings of forked runs, one for each seed, unless they exist. Waits for
/// another process that makes one. Then runs the unfinished runs of these indices; each ends as a
/// state and a reason in its status.json and never ends the sweep. A run in progress elsewhere is
/// left alone. A finished run with missing or damaged pictures is made again. A Ctrl-C asks all
/// children to end and waits for them, and so does the end of the budget; a run that would not end
/// before it is not started. When the machine fails, no further run is started: the next call
/// continues, beginning with runs that have not met the failure. Runs whose common beginning fails
/// end in its state, with its reason.
JobsResult run_local(const std::filesystem::path& folder, const store::Manifest& manifest,
                     const std::vector<int>& indices, const LocalOptions& options,
                     Progress& progress);

/// True where the common beginning of forked runs exists. @param folder  of the beginning
bool has_beginning(const Run& run, const std::filesystem::path& folder);

/// Runs that have not ended, the one in question among them.
struct RunsLeft {
  int runs = 1;
  double work = 0;  ///< of all of them; 0: not known
};

/// Number of threads for a run: several where few are left, or where it alone takes a large part of
/// what is left. @param memory bytes that are free
int threads_for(const Run& run, const RunsLeft& left, int cores, double memory);

}  // namespace neve::app::sweep::jobs
