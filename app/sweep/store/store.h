#pragma once
/// Status of each run on disk: DIR/runs/0000/status.json, small and atomic, no database.

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/setup/plan.h"
#include "app/support/json.h"

namespace neve::app::sweep {
struct Run;
}

namespace neve::app::sweep::store {

enum class RunState {
  pending,
  running,
  ok,
  diverged,       ///< a rule of a healthy run broke
  failed,         ///< it ended with an error
  refused,        ///< more than a limit of its scene allows
  timeout,        ///< longer than [limits] timeout
  crashed,        ///< ended by a signal
  out_of_memory,  ///< more than [limits] memory, or than there was
  interrupted     ///< stopped with the sweep; continues next time
};
const char* name(RunState state);

struct RunStatus {
  RunState state = RunState::pending;
  std::string key;           ///< hash of scene, version, frames
  std::string simulation;    ///< the same without what only its pictures depend on
  std::string reason;        ///< one line; "" for ok
  std::string short_reason;  ///< for a tile
  int exit_code = 0, signal = 0;
  int attempts = 0;               ///< number of starts
  double seconds = 0;             ///< of the attempts that made the result, not of abandoned ones
  std::uint64_t peak_memory = 0;  ///< bytes, of the same
  long pid = 0;                   ///< while it runs
  std::string host;
  /// Attempts of its common beginning, which failed, and with it the run; 0: it began.
  int failed_beginning = 0;
  /// The `simulation` and `drawings` of run.json when it ended. Other commands may replace both.
  std::string states;
  std::map<std::string, std::string> drawings;
  bool is_damaged = false;  ///< there is a file, and it is not as neve wrote it
};

/// "0007"
std::string run_folder_name(int number);
std::filesystem::path runs_folder(const std::filesystem::path& sweep);

/// Returns the folder of a beginning of forked runs: beginning for the first seed, then
/// beginning_2.
std::filesystem::path beginning_folder(const std::filesystem::path& sweep, const Run& beginning);

/// Reads the status of a run; pending if its file is missing or broken.
RunStatus read_status(const std::filesystem::path& run_folder);
/// @throws IoError
void write_status(const std::filesystem::path& run_folder, const RunStatus& status);

/// Keeps what the run that has ended says of itself, to be compared with later.
void note_record(const Json& run_json, RunStatus& status);
/// True if run.json is of another simulation than the one that the sweep made.
bool is_of_other_simulation(const RunStatus& status, const Json& run_json);
/// Says that another command has simulated or drawn the run otherwise since; "" where it is as the
/// sweep made it, and in folders of earlier versions.
std::string difference_of_record(const RunStatus& status, const Json& run_json);

/// True if nothing is left to do, unless failed runs are to be run again.
bool is_finished(RunState state);
/// True for a run that ended otherwise than ok.
bool has_failed(RunState state);
/// True for an end by its own record, run.json: ok, or diverged once it had begun.
bool has_record(const RunStatus& status);

/// Pictures of a run that exist, from its first frame on. @param known  so many have been seen
int frames_made(const std::filesystem::path& run_folder, const std::string& view,
                const setup::FrameRange& frames, int known = 0);

/// States of runs that are to be made again.
using Retry = std::set<RunState>;
/// "all", or names of states as in "timeout,crashed". @throws UsageError
Retry parse_retry(const std::string& text);

/// A run that the folder of a sweep has.
struct KnownRun {
  std::string folder, key, simulation;
  bool is_finished = false;
  bool has_states = false;  ///< of its frames
};

/// Lists the runs that have a folder, in the order of their folders.
std::vector<KnownRun> known_runs(const std::filesystem::path& sweep);

/// Name of the lock that the sweep which makes a run has on its folder; the run has one of its own.
inline constexpr const char* run_lock = ".sweep.lock";

}  // namespace neve::app::sweep::store
