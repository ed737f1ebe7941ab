#include "app/view/session/view_sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "app/options/arguments.h"
#include "app/output/process.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::view::session {

namespace {

namespace fs = std::filesystem;

constexpr int max_sweep_runs = 100;
constexpr double sweep_grace = 10;  // s
constexpr auto sweep_interval = std::chrono::milliseconds(300);

std::vector<std::string> axes_of(const SweepRequest& request) {
  std::vector<std::string> axes;
  for (const SweepAxis& axis : request.axes) axes.push_back(axis.address + "=" + axis.values);
  return axes;
}

/// Counts the values in "5, 10, 20", roughly: lists in lists count as more.
std::size_t values_of(const SweepAxis& axis) {
  return 1 + static_cast<std::size_t>(std::count(axis.values.begin(), axis.values.end(), ','));
}

}  // namespace

void ViewSweep::start(const SweepPlace& place, record::RunRecord run, timeline::Moment moment,
                      double fps, const SweepRequest& request,
                      const std::vector<std::string>& longer_steps) {
  if (is_running()) throw UsageError("", "a sweep is in progress", "wait for it, or stop it");
  if (request.axes.empty()) throw UsageError("", "no parameter is chosen", "find one to vary");
  const int start = moment.scene ? scene::number_of(*moment.scene, 0) : 0;
  // DIR/vary_0012, or with a number where there is one already.
  const fs::path here =
      output::free_path(place.folder, fmt::format("vary_{:04}", start + moment.frame), "");
  sweep::plan::SweepOptions options;
  options.file = (here / "start").string();
  options.from = moment.frame / fps;
  options.axes = axes_of(request);
  options.threads = place.threads;
  options.backend = place.backend;
  if (request.has_longer_steps) options.overrides = longer_steps;
  options.frames = setup::FrameRange{setup::FrameRange::from_start, start + request.last_frame};
  options.out = (here / "sweep.cdb").string();
  // A line of tiles would be as wide as the picture, and they small.
  if (const std::size_t count = request.axes.size() == 1 ? values_of(request.axes[0]) : 0;
      count > 3)
    options.wrap = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::error_code error;
  int runs = 0;
  try {
    timeline::write_origin(options.file, std::move(run), std::move(moment));
    // A wrong request is refused here, before a process starts.
    runs = static_cast<int>(sweep::plan::plan_sweep(options).runs.size());
    if (runs > max_sweep_runs)
      throw UsageError("", fmt::format("{} runs are more than {}", runs, max_sweep_runs),
                       "give fewer values, or use neve sweep in a terminal");
    sweep_.emplace(options, program_, here / "log", sweep_grace);
    progress_ = {};
    progress_.command = options::shell_line(options::words_of(options));
  } catch (...) {
    fs::remove_all(here, error);
    throw;
  }
  progress_.state = ViewSweepProgress::State::running;
  progress_.runs = runs;
  progress_.folder = options.out;
}

void ViewSweep::look() {
  const std::optional<sweep::jobs::SweepProgress> found = sweep_->progress();
  if (!found) return;
  const RunCounts counts = found->counts();
  progress_.ok = counts.finished - counts.failed;
  progress_.failed = counts.failed;
  progress_.share = found->share();
}

void ViewSweep::end(int code) {
  using State = ViewSweepProgress::State;
  const bool is_whole = code == exit_ok || code == exit_runs_failed;
  progress_.state = is_whole                 ? State::done
                    : code == exit_resumable ? State::stopped
                                             : State::failed;
  if (progress_.state == State::failed) progress_.error = sweep_->error();
  if (progress_.state == State::failed && progress_.error.empty())
    progress_.error = fmt::format("the sweep ended with exit code {}", code);
  sweep_.reset();
}

bool ViewSweep::poll() {
  if (!sweep_) return false;
  const auto now = sweep::jobs::Child::Clock::now();
  if (now - looked_at_ < sweep_interval) return false;
  looked_at_ = now;
  const std::optional<int> code = sweep_->poll();
  try {
    look();
  } catch (const std::exception&) {
    // A file that is just being replaced: the next look sees it.
  }
  if (code) end(*code);
  return true;
}

std::filesystem::path ViewSweep::pack() const {
  const fs::path file = progress_.folder.parent_path() / "sweep.tar";
  const std::optional<fs::path> tar = output::find_program("tar");
  if (!tar) throw IoError("cannot pack the sweep: the program tar is not installed", file.string());
  const output::ProcessResult done = output::run_process(
      *tar,
      {"--exclude=states", "-cf", file.filename().string(), progress_.folder.filename().string()},
      fs::absolute(file.parent_path()));
  if (done.exit_code != 0) throw IoError("cannot pack the sweep: " + done.errors, file.string());
  return file;
}

void ViewSweep::stop() {
  if (sweep_) sweep_->stop();
}

}  // namespace neve::app::view::session
