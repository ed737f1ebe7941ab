#include "app/timeline/moments.h"

#include <iterator>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "app/support/version.h"
#include "app/timeline/times.h"
#include "sim/kernels/simd.h"

namespace neve::app::timeline {

namespace {

std::uint64_t bytes_of(const Moment& moment) {
  return moment.state.size() + moment.history.size() * sizeof(picture::PlotSample);
}

}  // namespace

Moments::Moments(StatesFolder states, Progress& progress)
    : states_(std::move(states)), progress_(&progress) {
  const std::vector<int> frames = output::kept_states(states_.folder);
  std::optional<output::Checkpoint> found;
  for (auto frame = frames.begin(); frame != frames.end() && !found; ++frame)
    found = output::read_state(states_.folder, *frame).checkpoint;
  const bool is_other = found && found->identity != states_.identity;
  if (is_other)
    output::remove_states(states_.folder);
  else if (states_.are_read)
    on_disk_ = {frames.begin(), frames.end()};
  for (const int frame : output::checkpoint_frames(states_.folder)) on_disk_.insert(frame);
  states_.are_wanted = states_.are_wanted || (!is_other && !frames.empty());
}

void Moments::add_run(const std::filesystem::path& folder) {
  if (record::read_run_json(folder).value("version", "") != version) return;
  run_ = folder;
  for (const int frame : output::kept_states(folder)) on_disk_.insert(frame);
  for (const int frame : output::checkpoint_frames(folder)) on_disk_.insert(frame);
}

/// From DIR/states, or else from DIR/checkpoint.
std::shared_ptr<const Moment> Moments::read(int frame) {
  const bool is_of_run = !run_.empty();
  const std::filesystem::path& folder = is_of_run ? run_ : states_.folder;
  const auto is_ours = [&](const output::FoundCheckpoint& found, const std::string& identity) {
    const std::optional<output::Checkpoint>& file = found.checkpoint;
    return file && file->frame == frame &&
           (is_of_run ? file->simd == sim::kernels::name(sim::kernels::chosen_simd_level())
                      : file->identity == identity);
  };
  output::FoundCheckpoint found = output::read_state(folder, frame);
  std::string damage = found.damaged.empty() ? "" : found.damaged.front();
  if (!is_ours(found, states_.identity)) {
    found = output::find_checkpoint(folder, frame + 1);
    if (!is_ours(found, states_.checkpoints)) found.checkpoint.reset();
  }
  if (found.checkpoint) try {
      return std::make_shared<const Moment>(to_moment(*std::move(found.checkpoint)));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      if (is_of_run) throw;
      damage = error.what();
    }
  if (progress_ && !damage.empty()) progress_->warning(damage + "; the frame is simulated again");
  return nullptr;
}

std::shared_ptr<const Moment> Moments::find(double time, double fps, int after) {
  std::shared_ptr<const Moment> best;
  const int last = frame_at(time, fps);
  if (const auto later = in_memory_.upper_bound(last); later != in_memory_.begin())
    if (const auto& newest = std::prev(later)->second; newest->frame > after) {
      best = newest;
      after = newest->frame;
    }
  for (auto frame = on_disk_.upper_bound(last); frame != on_disk_.begin();) {
    if (*--frame <= after) break;
    const auto moment = read(*frame);
    // One of an interrupted run may hold steps beyond its frame.
    if (moment && is_not_after(moment->time(fps), time)) return moment;
    if (!moment) frame = on_disk_.erase(frame);
  }
  return best;
}

std::shared_ptr<const Moment> Moments::find_newest(double fps) {
  return find(std::numeric_limits<double>::infinity(), fps);
}

bool Moments::wants(int frame) const {
  return budget_ > 0 || (states_.are_wanted && frame > 0 && !has(frame));
}

void Moments::keep(Moment moment) {
  if (!states_.folder.empty())
    return output::write_state(states_.folder,
                               to_checkpoint(std::move(moment), states_.identity, states_.simd));
  const int frame = moment.frame;
  if (const auto old = in_memory_.find(frame); old != in_memory_.end())
    bytes_ -= bytes_of(*old->second);
  bytes_ += bytes_of(moment);
  in_memory_.insert_or_assign(frame, std::make_shared<const Moment>(std::move(moment)));
  thin();
}

void Moments::forget_after(int frame) {
  for (auto it = in_memory_.upper_bound(frame); it != in_memory_.end(); it = in_memory_.erase(it))
    bytes_ -= bytes_of(*it->second);
  on_disk_.erase(on_disk_.upper_bound(frame), on_disk_.end());
}

std::vector<int> Moments::frames() const {
  std::set<int> all = on_disk_;
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
