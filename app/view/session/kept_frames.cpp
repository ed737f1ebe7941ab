#include "app/view/session/kept_frames.h"

#include <iterator>
#include <utility>

namespace neve::app::view::session {

void KeptFrames::add(KeptFrame frame) {
  const int number = frame.frame;
  if (const auto old = frames_.find(number); old != frames_.end())
    bytes_ -= old->second.state.size();
  bytes_ += frame.state.size();
  frames_.insert_or_assign(number, std::move(frame));
  thin();
}

const KeptFrame* KeptFrames::at_or_before(int frame) const {
  const auto after = frames_.upper_bound(frame);
  return after == frames_.begin() ? nullptr : &std::prev(after)->second;
}

void KeptFrames::forget_after(int frame) {
  for (auto it = frames_.upper_bound(frame); it != frames_.end(); it = frames_.erase(it))
    bytes_ -= it->second.state.size();
}

void KeptFrames::clear() {
  frames_.clear();
  bytes_ = 0;
}

std::vector<int> KeptFrames::numbers() const {
  std::vector<int> numbers;
  for (const auto& [number, frame] : frames_) numbers.push_back(number);
  return numbers;
}

/// Takes out the frame whose neighbours are closest to each other, the oldest of such: gaps double
/// from the beginning on, and stay even.
void KeptFrames::thin() {
  while (bytes_ > budget_ && frames_.size() > 2) {
    auto victim = std::next(frames_.begin());
    int smallest = std::next(victim)->first - frames_.begin()->first;
    for (auto it = std::next(victim); std::next(it) != frames_.end(); ++it) {
      const int gap = std::next(it)->first - std::prev(it)->first;
      if (gap >= smallest) continue;
      smallest = gap;
      victim = it;
    }
    bytes_ -= victim->second.state.size();
    frames_.erase(victim);
  }
}

}  // namespace neve::app::view::session
