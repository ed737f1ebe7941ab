#include "app/view/session/study.h"

#include <fmt/core.h>

#include <sstream>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "app/output/sequence.h"
#include "app/setup/command_text.h"
#include "app/support/errors.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/store/store.h"

namespace neve::app::view::session {

namespace {

namespace fs = std::filesystem;

constexpr int most_study_runs = 100;
constexpr auto study_interval = std::chrono::milliseconds(300);

/// DIR/vary_0012, or with a number where there is one already.
fs::path new_folder(const fs::path& folder, int frame) {
  const std::string name = fmt::format("vary_{:04}", frame);
  std::error_code error;
  fs::path path = folder / name;
  for (int k = 2; fs::exists(path, error); ++k) path = folder / fmt::format("{}_{}", name, k);
  return path;
}

std::vector<std::string> axes_of(const StudyRequest& request) {
  std::vector<std::string> axes;
  for (const StudyAxis& axis : request.axes) axes.push_back(axis.address + "=" + axis.values);
  return axes;
}

/// "sweep", "DIR/start", "--from", ...
std::vector<std::string> arguments_of(const sweep::plan::SweepOptions& options) {
  std::vector<std::string> words{"sweep", options.file, "--from",
                                 fmt::format("{}s", *options.from)};
  for (const std::string& set : options.overrides) words.insert(words.end(), {"--set", set});
  for (const std::string& axis : options.axes) words.insert(words.end(), {"-p", axis});
  words.insert(words.end(),
               {"--frames", fmt::format("{}-{}", options.frames->first, options.frames->last),
                "--out", options.out});
  return words;
}

std::string command_of(const std::vector<std::string>& arguments) {
  std::string text = "neve";
  for (const std::string& word : arguments) text += " " + setup::shell_word(word);
  return text;
}

/// The last line that says something.
std::string last_line(const fs::path& log) {
  std::string line, last;
  try {
    const std::vector<std::uint8_t> bytes = output::read_file(log);
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    while (std::getline(in, line))
      if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  } catch (const IoError&) {
    return {};
  }
  const std::string prefix = "neve: error: ";
  return last.starts_with(prefix) ? last.substr(prefix.size()) : last;
}

}  // namespace

void Study::start(const fs::path& folder, const run::Moment& moment, double time,
                  const StudyRequest& request, const std::vector<std::string>& longer_steps) {
  if (is_running()) throw UsageError("", "a study is in progress", "wait for it, or stop it");
  if (request.axes.empty()) throw UsageError("", "no parameter is chosen", "find one to vary");
  const fs::path here = new_folder(folder, moment.frame);
  sweep::plan::SweepOptions options;
  options.file = (here / "start").string();
  options.from = time;
  options.axes = axes_of(request);
  if (request.has_longer_steps) options.overrides = longer_steps;
  options.frames = setup::FrameRange{moment.frame + 1, request.last_frame};
  options.out = (here / "study.cdb").string();
  std::error_code error;
  int runs = 0;
  try {
    run::write_moment(options.file, moment);
    // A wrong request is refused here, before a process starts.
    runs = static_cast<int>(sweep::plan::plan_sweep(options).runs.size());
    if (runs > most_study_runs)
      throw UsageError("", fmt::format("{} runs are more than {}", runs, most_study_runs),
                       "give fewer values, or use neve sweep in a terminal");
    const std::vector<std::string> words = arguments_of(options);
    log_ = here / "log";
    std::vector<std::string> quiet = words;
    quiet.push_back("--quiet");
    child_.emplace(output::Command{program_, quiet, fs::current_path()}, log_,
                   sweep::jobs::ChildLimits{});
    progress_ = {};
    progress_.command = command_of(words);
  } catch (...) {
    fs::remove_all(here, error);
    throw;
  }
  progress_.state = StudyProgress::State::running;
  progress_.runs = runs;
  progress_.folder = options.out;
  manifest_.reset();
}

void Study::count_frames() {
  std::error_code error;
  if (!manifest_ && fs::exists(progress_.folder / "manifest.json", error))
    manifest_ = sweep::store::read_manifest(progress_.folder);
  if (!manifest_) return;
  double made = 0, all = 0;
  progress_.ok = progress_.failed = 0;
  for (const sweep::Run& run : manifest_->runs) {
    const fs::path folder = sweep::store::runs_folder(progress_.folder) / run.folder;
    const sweep::store::RunState state = sweep::store::read_status(folder).state;
    progress_.ok += state == sweep::store::RunState::ok;
    progress_.failed += sweep::store::has_failed(state);
    all += run.frames.count();
    int frame = run.frames.first;
    while (frame <= run.frames.last &&
           fs::exists(output::frame_path(folder, manifest_->view, frame), error))
      ++frame;
    made += sweep::store::is_finished(state) ? run.frames.count() : frame - run.frames.first;
  }
  progress_.share = made / std::max(1.0, all);
}

void Study::end(const sweep::jobs::ChildResult& result) {
  using State = StudyProgress::State;
  const bool is_whole = result.ending == sweep::jobs::Ending::exited &&
                        (result.code == exit_ok || result.code == exit_runs_failed);
  const bool is_stopped =
      result.ending == sweep::jobs::Ending::stopped || result.code == exit_resumable;
  progress_.state = is_whole ? State::done : is_stopped ? State::stopped : State::failed;
  if (progress_.state != State::failed) return;
  progress_.error = last_line(log_);
  if (progress_.error.empty())
    progress_.error = fmt::format("the study ended with exit code {}", result.code);
}

bool Study::poll() {
  if (!child_) return false;
  const auto now = sweep::jobs::Child::Clock::now();
  if (now - looked_at_ < study_interval) return false;
  looked_at_ = now;
  const std::optional<sweep::jobs::ChildResult> result = child_->poll();
  try {
    count_frames();
  } catch (const std::exception&) {
    // A file that is just being replaced: the next look sees it.
  }
  if (!result) return true;
  child_.reset();
  end(*result);
  return true;
}

std::filesystem::path Study::pack() const {
  const fs::path file = progress_.folder.parent_path() / "study.tar";
  const std::optional<fs::path> tar = output::find_program("tar");
  if (!tar) throw IoError("cannot pack the study: there is no program tar", file.string());
  const output::ProcessResult done = output::run_process(
      *tar,
      {"--exclude=states", "-cf", file.filename().string(), progress_.folder.filename().string()},
      fs::absolute(file.parent_path()));
  if (done.exit_code != 0) throw IoError("cannot pack the study: " + done.errors, file.string());
  return file;
}

void Study::stop() {
  if (child_) child_->stop();
}

}  // namespace neve::app::view::session
