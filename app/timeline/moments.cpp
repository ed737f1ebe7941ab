#include "app/timeline/moments.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <new>
#include <utility>

#include "app/output/atomic_file.h"
#include "app/record/verify.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/timeline/times.h"
#include "sim/kernels/simd.h"
#include "sim/simulation.h"

namespace neve::app::timeline {

namespace {

std::uint64_t bytes_of(const Moment& moment) {
  return moment.state.size() + moment.history.size() * sizeof(picture::PlotSample);
}

}  // namespace

Moments::Moments(StatesFolder states, Progress& progress)
    : states_(std::move(states)), progress_(&progress) {
  output::tidy_states_folder(states_.folder);
  std::vector<int> frames = output::kept_states(states_.folder);
  std::erase_if(frames, [&](int frame) {
    if (states_.trusted.contains(frame)) return false;
    const std::vector<std::string> damaged = output::read_state(states_.folder, frame).damaged;
    for (const std::string& file : damaged)
      progress.warning(file + "; the frame is simulated again");
    if (!damaged.empty()) output::remove_state(states_.folder, frame);
    return !damaged.empty();
  });
  std::optional<output::Checkpoint> found;
  for (auto frame = frames.begin(); frame != frames.end() && !found; ++frame)
    found = output::read_state(states_.folder, *frame).checkpoint;
  if (found && found->identity != states_.identity) {
    output::remove_states(states_.folder);
  } else {
    for (const int frame : frames) {
      state_bytes_[frame] = output::state_bytes(states_.folder, frame);
      if (states_.are_read) on_disk_[frame] = {};
    }
    // States were thinned before: those between are not wanted now either.
    for (std::size_t k = 1; k + 1 < frames.size() && states_.budget > 0; ++k)
      every_ = k == 1 ? frames[k] - frames[k - 1] : std::min(every_, frames[k] - frames[k - 1]);
  }
  for (const auto& [frame, steps] : output::checkpoint_steps(states_.folder))
    on_disk_[frame] = {steps};
}

void Moments::add_run(const std::filesystem::path& folder) {
  const Json run = record::read_run_json(folder);
  if (!run.is_object() || run.value("version", Json()) != version) return;
  run_ = folder;
  run_hashes_.clear();
  if (const std::optional<record::Pictures> pictures = record::listed_pictures(run))
    for (const record::FrameRecord& frame : pictures->frames)
      run_hashes_[frame.frame] = frame.state_hash;
  for (const int frame : output::kept_states(folder)) on_disk_[frame] = {0, true};
  for (const auto& [frame, steps] : output::checkpoint_steps(folder))
    on_disk_[frame] = {steps, true};
}

bool Moments::is_of_other_run(const Moment& moment) const {
  return std::ranges::any_of(moment.made.frames, [&](const record::FrameRecord& frame) {
    const auto listed = run_hashes_.find(frame.frame);
    return listed != run_hashes_.end() && listed->second != frame.state_hash;
  });
}

/// One from a file that this program may continue. @param identity  that it has to have
std::shared_ptr<const Moment> Moments::use(output::FoundCheckpoint found, int frame, bool is_of_run,
                                           const std::string& identity) {
  std::optional<output::Checkpoint>& file = found.checkpoint;
  std::string damage = found.damaged.empty() ? "" : found.damaged.front();
  const bool is_ours =
      file && file->frame == frame &&
      (is_of_run ? file->simd == sim::kernels::name(sim::kernels::chosen_simd_level())
                 : file->identity == identity);
  // A fault of one is a fault of all others.
  const auto leave_all = [&](const std::string& why) {
    std::erase_if(on_disk_, [&](const auto& kept) { return kept.second.is_of_run == is_of_run; });
    if (progress_) progress_->warning(why + "; the run is simulated from its start");
  };
  if (is_ours && !sim::Simulation::can_read(file->state)) {
    leave_all(file->file.string() + ": another build of neve has written it in a way of its own");
    return nullptr;
  }
  if (is_ours) try {
      auto moment = std::make_shared<const Moment>(to_moment(*std::move(file)));
      if (!is_of_run || !is_of_other_run(*moment)) return moment;
      leave_all(moment->file.string() +
                ": it is of another run, which has taken the place of the one that is read");
      return nullptr;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      if (is_of_run) throw;
      damage = error.what();
    }
  if (progress_ && !damage.empty()) progress_->warning(damage + "; the frame is simulated again");
  return nullptr;
}

/// Reads from DIR/checkpoint, or else from DIR/states. A frame without either is forgotten.
std::shared_ptr<const Moment> Moments::read(int frame, double time, double fps) {
  const OnDisk file = on_disk_.at(frame);
  const std::filesystem::path& folder = file.is_of_run ? run_ : states_.folder;
  std::shared_ptr<const Moment> moment;
  if (file.steps > 0)
    moment =
        use(output::find_checkpoint(folder, frame + 1), frame, file.is_of_run, states_.checkpoints);
  // A checkpoint of an interrupted run may lie inside a frame.
  if (moment && is_not_after(moment->time(fps), time)) return moment;
  const bool is_later = moment != nullptr;
  moment = use(output::read_state(folder, frame), frame, file.is_of_run, states_.identity);
  if (!moment && !file.is_of_run) state_bytes_.erase(frame);
  if (!moment && !is_later) on_disk_.erase(frame);
  return moment;
}

std::shared_ptr<const Moment> Moments::find(double time, double fps, int after, std::size_t steps) {
  settle();
  std::shared_ptr<const Moment> best;
  const int last = frame_at(time, fps);
  if (const auto later = in_memory_.upper_bound(last); later != in_memory_.begin())
    if (const auto& newest = std::prev(later)->second; newest->frame > after) {
      best = newest;
      after = newest->frame;
      steps = newest->steps;
    }
  for (auto place = on_disk_.upper_bound(last); place != on_disk_.begin();) {
    const auto [frame, file] = *--place;
    if (frame < after || (frame == after && file.steps <= steps)) break;
    const auto moment = read(frame, time, fps);
    if (moment && (frame > after || moment->steps > steps)) return moment;
    place = on_disk_.lower_bound(frame);
  }
  return best;
}

std::shared_ptr<const Moment> Moments::find_newest(double fps) {
  return find(std::numeric_limits<double>::infinity(), fps);
}

bool Moments::wants(int frame) const {
  if (budget_ > 0) return true;
  return states_.are_wanted && stopped_.empty() && frame > 0 && !state_bytes_.contains(frame) &&
         (frame % every_ == 0 || frame == states_.last_frame);
}

void Moments::keep(Moment moment) {
  if (!states_.folder.empty()) return keep_on_disk(std::move(moment));
  const int frame = moment.frame;
  if (const auto old = in_memory_.find(frame); old != in_memory_.end())
    bytes_ -= bytes_of(*old->second);
  bytes_ += bytes_of(moment);
  in_memory_.insert_or_assign(frame, std::make_shared<const Moment>(std::move(moment)));
  thin();
}

/// One at a time is written: memory holds two of them at most.
void Moments::keep_on_disk(Moment moment) {
  settle();
  const int frame = moment.frame;
  thin_states(moment.state.size(), frame);
  if (!wants(frame)) return;
  written_frame_ = frame;
  writing_ = std::async(std::launch::async,
                        [folder = states_.folder,
                         state = to_checkpoint(std::move(moment), states_.identity, states_.simd)] {
                          return output::write_state(folder, state);
                        });
}

void Moments::settle() {
  if (!writing_.valid()) return;
  try {
    state_bytes_[written_frame_] = writing_.get();
    on_disk_.insert({written_frame_, {}});
    unsynced_.push_back(states_.folder / output::state_name(written_frame_));
  } catch (const IoError& error) {
    if (states_.budget == 0) throw;
    stop_keeping(error.what());
  }
}

void Moments::bring_to_disk() {
  settle();
  std::error_code error;
  std::erase_if(unsynced_, [&](const auto& file) { return !std::filesystem::exists(file, error); });
  try {
    output::sync_files(unsynced_);
  } catch (const IoError& failure) {
    if (states_.budget == 0) throw;
    stop_keeping(failure.what());
  }
  unsynced_.clear();
}

/// The disk may be full for pictures too: they come first.
void Moments::stop_keeping(const std::string& why) {
  stopped_ = why;
  for (const auto& [frame, bytes] : state_bytes_)
    if (const auto file = on_disk_.find(frame);
        file != on_disk_.end() && file->second.steps == 0 && !file->second.is_of_run)
      on_disk_.erase(file);
  state_bytes_.clear();
  output::remove_states(states_.folder);
  if (progress_)
    progress_->warning(why +
                       "; the run continues without states: to draw it otherwise, it will be "
                       "simulated again");
}

/// Doubles the gaps between states until they and another one are within the budget; the newest
/// stays.
void Moments::thin_states(std::uint64_t size, int newest) {
  if (states_.budget == 0 || !stopped_.empty()) return;
  if (size > states_.budget) {
    stopped_ =
        "one takes " + bytes_text(size) + ", more than the budget of " + bytes_text(states_.budget);
    return;
  }
  const auto total = [&] {
    std::uint64_t bytes = wants(newest) ? size : 0;
    for (const auto& [frame, own] : state_bytes_) bytes += own;
    return bytes;
  };
  // Room is kept for as many as will come, before they are written.
  const std::uint64_t frames_to_come =
      static_cast<std::uint64_t>(std::max(0, states_.last_frame - newest));
  while (every_ < states_.last_frame &&
         (total() > states_.budget || frames_to_come / static_cast<std::uint64_t>(every_) >
                                          (states_.budget - total()) / size)) {
    every_ *= 2;
    for (auto state = state_bytes_.begin(); state != state_bytes_.end();) {
      const int frame = state->first;
      if (frame % every_ == 0) {
        ++state;
        continue;
      }
      output::remove_state(states_.folder, frame);
      if (const auto file = on_disk_.find(frame);
          file != on_disk_.end() && file->second.steps == 0 && !file->second.is_of_run)
        on_disk_.erase(file);
      state = state_bytes_.erase(state);
    }
  }
}

std::optional<StatesKept> Moments::kept() const {
  if (states_.folder.empty() || (state_bytes_.empty() && !states_.are_wanted)) return std::nullopt;
  StatesKept kept{{}, 0, states_.budget, every_, stopped_};
  for (const auto& [frame, bytes] : state_bytes_) {
    kept.frames.push_back(frame);
    kept.bytes += bytes;
  }
  return kept;
}

void Moments::forget_after(int frame, std::size_t steps) {
  const auto is_later = [&](std::size_t moment_steps) { return moment_steps > steps; };
  auto it = in_memory_.lower_bound(frame);
  if (it != in_memory_.end() && it->first == frame && !is_later(it->second->steps)) ++it;
  for (; it != in_memory_.end(); it = in_memory_.erase(it)) bytes_ -= bytes_of(*it->second);
  // The state of the frame itself is earlier than a checkpoint inside the next one.
  if (const auto here = on_disk_.find(frame);
      here != on_disk_.end() && is_later(here->second.steps))
    here->second.steps = 0;
  on_disk_.erase(on_disk_.upper_bound(frame), on_disk_.end());
}

void Moments::forget(const Moment& here) {
  if (const auto kept = in_memory_.find(here.frame);
      kept != in_memory_.end() && kept->second->steps == here.steps) {
    bytes_ -= bytes_of(*kept->second);
    in_memory_.erase(kept);
  }
  const auto file = on_disk_.find(here.frame);
  if (file == on_disk_.end()) return;
  if (here.is_frame_end())
    on_disk_.erase(file);
  else if (file->second.steps == here.steps)
    file->second.steps = 0;  // the end of the frame before it
}

std::vector<int> Moments::frames() const {
  std::set<int> all;
  for (const auto& [frame, file] : on_disk_) all.insert(frame);
  for (const auto& [frame, moment] : in_memory_) all.insert(frame);
  return {all.begin(), all.end()};
}

/// Takes out the moment whose neighbours are closest to each other, the oldest of such: gaps double
/// from the beginning on, and stay even.
void Moments::thin() {
  while (bytes_ > budget_ && in_memory_.size() > 2) {
    auto victim = std::next(in_memory_.begin());
    int smallest = std::next(victim)->first - in_memory_.begin()->first;
    for (auto it = std::next(victim); std::next(it) != in_memory_.end(); ++it) {
      const int gap = std::next(it)->first - std::prev(it)->first;
      if (gap >= smallest) continue;
      smallest = gap;
      victim = it;
    }
    bytes_ -= bytes_of(*victim->second);
    in_memory_.erase(victim);
  }
}

}  // namespace neve::app::timeline
