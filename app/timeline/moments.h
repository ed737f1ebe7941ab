#pragma once
/// Moments of a run that are kept: to continue from them, or to look at them without simulating.

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
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
  bool are_wanted = false;  ///< are written too
  /// Bytes of all together: older ones are thinned out. 0: all are kept, and one that cannot be
  /// written is an error; otherwise none is kept any more then.
  std::uint64_t budget = 0;
  int last_frame = 0;  ///< of this command
  /// Frames whose states a command that ended has brought to the disk. A power cut may have left
  /// others unfinished: those are removed, and made again where their frames are.
  std::set<int> trusted{};
};

/// States in DIR/states, as they are now.
struct StatesKept {
  std::vector<int> frames;   ///< in order
  std::uint64_t bytes = 0;   ///< of all of them
  std::uint64_t budget = 0;  ///< see StatesFolder
  int every = 1;             ///< frames from one to the next
  std::string stopped;       ///< why none is kept any more; "" while they are
};

class Moments {
 public:
  /// Keeps no moments.
  Moments() = default;
  /// Keeps moments in memory. @param budget  bytes of all together; the first and the last are
  /// always kept, those between more and more thinly
  explicit Moments(std::uint64_t budget) : budget_(budget) {}
  /// @param progress  outlives it: told of damaged states
  Moments(StatesFolder states, Progress& progress);

  /// Adds those of a run that exists, in DIR/checkpoint and DIR/states: they are read where they
  /// are, if this program would have made the same bits. Nobody holds the folder: once it is
  /// another run, whose frames are not those that run.json lists now, none of them is taken.
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
  /// Keeps the end of a frame, in the place of the one with its number; a file of DIR/states is
  /// written while the run continues. @throws IoError for this one or the one before
  void keep(Moment moment);
  /// Waits until the last one is written. @throws IoError
  void settle();
  /// Settles, and has all that were written survive a power cut. @throws IoError likewise
  void bring_to_disk();
  /// Returns the states in DIR/states, when they are settled; nothing if none are wanted.
  std::optional<StatesKept> kept() const;

  /// Forgets those of later frames, and of later steps after this one; files stay.
  void forget_after(int frame, std::size_t steps);
  /// Forgets those of this very moment, which a change has made another one; files stay.
  void forget(const Moment& here);

  bool has(int frame) const { return on_disk_.contains(frame) || in_memory_.contains(frame); }
  /// Numbers of their frames, in order.
  std::vector<int> frames() const;
  std::uint64_t bytes() const { return bytes_; }  ///< in memory
  std::uint64_t budget() const { return budget_; }

 private:
  void thin();
  void keep_on_disk(Moment moment);
  void thin_states(std::uint64_t size, int newest);
  void stop_keeping(const std::string& why);
  std::shared_ptr<const Moment> read(int frame, double time, double fps);
  std::shared_ptr<const Moment> use(output::FoundCheckpoint found, int frame, bool is_of_run,
                                    const std::string& identity);
  bool is_of_other_run(const Moment& moment) const;

  /// A file of a moment.
  struct OnDisk {
    std::size_t steps = 0;   ///< of a checkpoint; 0 of a state alone
    bool is_of_run = false;  ///< in the folder of a run that is only read
  };

  std::uint64_t budget_ = 0, bytes_ = 0;
  std::map<int, std::shared_ptr<const Moment>> in_memory_;
  std::map<int, OnDisk> on_disk_;
  std::filesystem::path run_;                 ///< that they are read from; empty: none
  std::map<int, std::uint64_t> run_hashes_;   ///< of the states that it listed, by number
  StatesFolder states_;                       ///< that they are written to; empty: none
  Progress* progress_ = nullptr;              ///< of these
  std::map<int, std::uint64_t> state_bytes_;  ///< of the states in that folder
  int every_ = 1;                             ///< frames from one state to the next
  std::string stopped_;                       ///< why no state is kept any more
  std::future<std::uint64_t> writing_;        ///< the last state, and its bytes
  int written_frame_ = 0;                     ///< of that state
  std::vector<std::filesystem::path> unsynced_;
};

}  // namespace neve::app::timeline
