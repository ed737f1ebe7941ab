#pragma once
/// States of frames that a session passed through, to look at them again without simulating: within
/// a bounded memory, older ones more and more thinly.

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::view::session {

struct KeptFrame {
  int frame = 0;
  std::size_t steps = 0;                         ///< since the start of the run
  std::size_t steps_of_frame = 0;                ///< that the run had at the end of the frame
  std::vector<std::uint8_t> state;               ///< sim::Simulation::save
  std::shared_ptr<const scene::Scene> scene;     ///< to continue with
  std::vector<sim::shapes::Collider> colliders;  ///< as they move there
  sim::AdvanceReport advance;                    ///< since the frame before
};

class KeptFrames {
 public:
  /// @param budget bytes of all states together; the first frame and the last are kept whatever
  /// they take
  explicit KeptFrames(std::uint64_t budget) : budget_(budget) {}

  /// In the place of the one with its number.
  void add(KeptFrame frame);

  /// The last one not after this number; null if there is no such frame.
  const KeptFrame* at_or_before(int frame) const;

  /// Forgets those after this number.
  void forget_after(int frame);
  void clear();

  std::vector<int> numbers() const;
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t budget() const { return budget_; }

 private:
  void thin();

  std::uint64_t budget_;
  std::uint64_t bytes_ = 0;
  std::map<int, KeptFrame> frames_;
};

}  // namespace neve::app::view::session
