#pragma once
/// Moments of a run that are kept: to continue from them, or to look at them without simulating.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/support/progress.h"
#include "app/timeline/moment.h"

namespace neve::app::timeline {

/// The states of the frames that a render draws, in DIR/states. Another drawing of the same
/// simulation, with other views, sizes, colours or cameras, takes its frames from there.
struct StatesFolder {
  std::filesystem::path folder;  ///< DIR
  std::string identity;          ///< of the simulation; states of another one are removed
  std::string checkpoints;       ///< identity of those beside them, in DIR/checkpoint
  std::string simd;
  bool are_read = true;     ///< not where laws are checked between steps
  bool are_wanted = false;  ///< also where there are none yet
};

class Moments {
 public:
  /// None.
  Moments() = default;
  /// In memory. @param budget  bytes of all together; the first and the last are always kept,
  /// those between more and more thinly
  explicit Moments(std::uint64_t budget) : budget_(budget) {}
  /// @param progress  outlives it: told of damaged states
  Moments(StatesFolder states, Progress& progress);

  /// Adds those of a run that exists, in DIR/checkpoint and DIR/states: they are read where they
  /// are, if this program would have made the same bits.
  void add_run(const std::filesystem::path& folder);

  /// The newest one that is not later than a time; null without one. Damaged files are passed over.
  /// @param after, steps  frame and steps that the moment is to be after
  /// @throws IoError for a file of a run with numbers that no run has written
  std::shared_ptr<const Moment> find(double time, double fps, int after = -1,
                                     std::size_t steps = 0);
  std::shared_ptr<const Moment> find_newest(double fps);

  /// True where the end of a frame is worth keeping. The start is made again faster than it is read
  /// from DIR/states.
  bool wants(int frame) const;
  /// Keeps the end of a frame, in the place of the one with its number. @throws IoError
  void keep(Moment moment);

  /// Forgets those of later frames; files stay.
  void forget_after(int frame);

  bool has(int frame) const { return on_disk_.contains(frame) || in_memory_.contains(frame); }
  /// Numbers of their frames, in order.
  std::vector<int> frames() const;
  std::uint64_t bytes() const { return bytes_; }  ///< in memory
  std::uint64_t budget() const { return budget_; }

 private:
  void thin();
  std::shared_ptr<const Moment> read(int frame, double time, double fps);
  std::shared_ptr<const Moment> use(output::FoundCheckpoint found, int frame,
                                    const std::string& identity);

  std::uint64_t budget_ = 0, bytes_ = 0;
  std::map<int, std::shared_ptr<const Moment>> in_memory_;
  std::map<int, std::size_t> on_disk_;  ///< frames; steps of a checkpoint, 0 of a state alone
  std::filesystem::path run_;           ///< that they are read from; empty: none
  StatesFolder states_;                 ///< that they are written to; empty: none
  Progress* progress_ = nullptr;        ///< of these
};

}  // namespace neve::app::timeline
