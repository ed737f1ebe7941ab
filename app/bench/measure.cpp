#include "app/bench/measure.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>

#include "app/output/process.h"
#include "app/support/interrupt.h"

namespace neve::app::bench {

namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

double Stopwatch::wall() const {
  return seconds_since(start_);
}

double Stopwatch::cpu() const {
  return cpu_now() - cpu_start_;
}

double Stopwatch::cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

OtherLoad::OtherLoad() : start_(now()) {}

OtherLoad::Counters OtherLoad::now() {
  Counters counters;
  counters.own = cpu_of(RUSAGE_SELF) + cpu_of(RUSAGE_CHILDREN);
  std::ifstream in("/proc/stat");
  std::string label;
  in >> label;  // cpu user nice system idle iowait irq softirq steal
  std::array<double, 8> ticks{};
  for (double& tick : ticks) in >> tick;
  const auto per_second = static_cast<double>(::sysconf(_SC_CLK_TCK));
  for (const double tick : ticks) counters.all += tick / per_second;
  counters.busy = counters.all - (ticks[3] + ticks[4]) / per_second;
  return counters;
}

double OtherLoad::share() const {
  const Counters end = now();
  const double all = end.all - start_.all;
  if (!(all > 0)) return 0;
  return std::clamp((end.busy - start_.busy - (end.own - start_.own)) / all, 0.0, 1.0);
}

std::string build_fault() {
#if defined(__SANITIZE_ADDRESS__)
  return "it is built with sanitizers";
#elif !defined(__OPTIMIZE__)
  return "it is built without optimisation";
#elif !defined(NDEBUG)
  return "it is built with assertions";
#else
  return {};
#endif
}

void stop_if_interrupted() {
  if (is_interrupted()) throw Error(exit_interrupted, "interrupted");
}

double seconds_of_render(const std::string& what, const std::filesystem::path& folder,
                         const BenchOptions& options, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"render"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.insert(words.end(), {"--quiet", "--out", "out", "--threads",
                             std::to_string(options.threads), "--backend", options.backend});
  const Stopwatch watch;
  const output::ProcessResult result = output::run_process("/proc/self/exe", words, folder);
  const double seconds = watch.wall();
  if (result.exit_code != exit_ok)
    throw Error(exit_internal, what + ": neve render failed: " + result.errors);
  return seconds;
}

}  // namespace neve::app::bench
