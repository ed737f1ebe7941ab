#include "app/timeline/moments.h"

#include <iterator>
#include <limits>
#include <new>
#include <optional>
#include <set>
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
    for (const int frame : frames) on_disk_[frame] = 0;
  for (const auto& [frame, steps] : output::checkpoint_steps(states_.folder))
    on_disk_[frame] = steps;
  states_.are_wanted = states_.are_wanted || (!is_other && !frames.empty());
}

void Moments::add_run(const std::filesystem::path& folder) {
  const Json run = record::read_run_json(folder);
  if (!run.is_object() || run.value("version", Json()) != version) return;
  run_ = folder;
  for (const int frame : output::kept_states(folder)) on_disk_[frame] = 0;
  for (const auto& [frame, steps] : output::checkpoint_steps(folder)) on_disk_[frame] = steps;
}

/// One from a file that this program may continue. @param identity  that it has to have
std::shared_ptr<const Moment> Moments::use(output::FoundCheckpoint found, int frame,
                                           const std::string& identity) {
  const bool is_of_run = !run_.empty();
  std::optional<output::Checkpoint>& file = found.checkpoint;
  std::string damage = found.damaged.empty() ? "" : found.damaged.front();
  const bool is_ours =
      file && file->frame == frame &&
      (is_of_run ? file->simd == sim::kernels::name(sim::kernels::chosen_simd_level())
                 : file->identity == identity);
  if (is_ours) try {
      return std::make_shared<const Moment>(to_moment(*std::move(file)));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      if (is_of_run) throw;
      damage = error.what();
    }
  if (progress_ && !damage.empty()) progress_->warning(damage + "; the frame is simulated again");
  return nullptr;
}

/// From DIR/checkpoint, or else from DIR/states. A frame without either is forgotten.
std::shared_ptr<const Moment> Moments::read(int frame, double time, double fps) {
  const std::filesystem::path& folder = run_.empty() ? states_.folder : run_;
  std::shared_ptr<const Moment> moment;
  if (on_disk_.at(frame) > 0)
    moment = use(output::find_checkpoint(folder, frame + 1), frame, states_.checkpoints);
  // A checkpoint of an interrupted run may lie inside a frame.
  if (moment && is_not_after(moment->time(fps), time)) return moment;
  const bool is_later = moment != nullptr;
  moment = use(output::read_state(folder, frame), frame, states_.identity);
  if (!moment && !is_later) on_disk_.erase(frame);
  return moment;
}

std::shared_ptr<const Moment> Moments::find(double time, double fps, int after, std::size_t steps) {
  std::shared_ptr<const Moment> best;
  const int last = frame_at(time, fps);
  if (const auto later = in_memory_.upper_bound(last); later != in_memory_.begin())
    if (const auto& newest = std::prev(later)->second; newest->frame > after) {
      best = newest;
      after = newest->frame;
      steps = newest->steps;
    }
  for (auto place = on_disk_.upper_bound(last); place != on_disk_.begin();) {
    const auto [frame, steps_there] = *--place;
    if (frame < after || (frame == after && steps_there <= steps)) break;
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
  std::set<int> all;
  for (const auto& [frame, steps] : on_disk_) all.insert(frame);
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
