#pragma once
/// Clocks, and the state of the machine during a measurement.

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "app/bench/bench.h"
#include "app/support/clock.h"
#include "app/support/errors.h"

namespace neve::app::bench {

/// Seconds since it was made.
class Stopwatch {
 public:
  double wall() const;
  /// CPU time of all threads of this process. It does not include the time that other programs
  /// had their cores.
  double cpu() const;

 private:
  static double cpu_now();
  Clock::time_point start_ = Clock::now();
  double cpu_start_ = cpu_now();
};

/// Measures the share of the machine that other processes used meanwhile.
class OtherLoad {
 public:
  OtherLoad();
  /// 0 to 1 of all cores; 0 where the system does not tell.
  double share() const;

 private:
  struct Counters {
    double own = 0, busy = 0, all = 0;  ///< s
  };
  static Counters now();
  Counters start_;
};

/// A folder for temporary files.
class ScratchFolder {
 public:
  /// @throws IoError
  ScratchFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "neve-bench-XXXXXX").string();
    if (!::mkdtemp(path.data())) throw IoError("cannot make the folder " + path, path);
    path_ = path;
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Why the figures of this build mean nothing; empty when they do.
std::string build_fault();

/// @throws Error with exit_interrupted after Ctrl-C
void stop_if_interrupted();

/// Seconds from the start to the end of a `neve render` of its own, which writes into folder/out.
/// @param what  named where it fails @throws Error
double seconds_of_render(const std::string& what, const std::filesystem::path& folder,
                         const BenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace neve::app::bench
