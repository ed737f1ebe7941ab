#pragma once
/// Harms runs of a sweep from outside, as a system does: the program needs no hidden way to crash.

#include <signal.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <thread>

#include "app/support/json.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

/// Sends signals to runs as soon as they are under way.
class Saboteur {
 public:
  Saboteur(const std::filesystem::path& runs, std::map<std::string, int> victims)
      : thread_([this, runs, victims]() mutable {
          while (!is_done_ && !victims.empty()) {
            for (auto victim = victims.begin(); victim != victims.end();)
              victim = hit(runs / victim->first, victim->second) ? victims.erase(victim)
                                                                 : std::next(victim);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  ~Saboteur() {
    is_done_ = true;
    thread_.join();
  }

 private:
  /// Half-written files do not exist: status.json is replaced as a whole.
  static bool hit(const std::filesystem::path& run, int signal) {
    if (!std::filesystem::exists(run / "status.json")) return false;
    const app::Json status = app::parse_json(std::string_view(read_text(run / "status.json")));
    if (status["state"] != "running") return false;
    // The run itself writes run.json: before, the process may be between fork and exec.
    if (!std::filesystem::exists(run / "run.json")) return false;
    return ::kill(status["pid"].get<int>(), signal) == 0;
  }

  std::atomic<bool> is_done_ = false;
  std::thread thread_;
};

}  // namespace neve::test
