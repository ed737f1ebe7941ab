#pragma once
/// The target of the comparison of two runs: a folder, or one file.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/compare/pair_options.h"
#include "app/output/file_hash.h"
#include "app/output/folder_lock.h"
#include "app/output/movie.h"
#include "app/record/run_json.h"
#include "app/support/json.h"
#include "render/image/image.h"

namespace neve::app::compare {

enum class TargetKind { folder, picture, movie, table };

class Target {
 public:
  /// @throws UsageError for a file that cannot hold the modes, or the folder of a run
  explicit Target(const PairOptions& options);
  /// Removes the pictures of a movie that is alone.
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  TargetKind kind() const { return kind_; }
  /// Modes that are to be made; all where none is named and the target is a folder.
  const std::vector<Mode>& modes() const { return modes_; }
  bool has(Mode mode) const;
  void leave_out(Mode mode);

  /// Chooses the format of movies before the pictures, see available_movie().
  /// @param fps  of the scenes @throws IoError, UsageError where movies cannot be made as asked for
  void check_movies(double fps) { movie_ = output::available_movie(movie_, fps); }
  /// Takes the folder and removes the files that an earlier comparison wrote there.
  /// @param frames  numbers of the pictures to come
  /// @throws UsageError where some are of other runs or will not be made again, or others have made
  /// what has their names, without --replace
  void begin(const setup::FrameRange& frames);
  /// @param text  what made it
  void add(Mode mode, int frame, const render::Image& image, const render::PngText& text);
  /// Movies of all modes, with rate and time code of a scene. @return warnings @throws IoError
  /// where a movie alone cannot be made
  std::vector<std::string> add_movies(const scene::Scene& scene);
  void add_metrics(const std::string& csv, const std::optional<render::Image>& picture,
                   const render::PngText& text);
  /// Lists the files in compare.json, with their hashes; only in a folder.
  /// @param is_whole  all frames that were to come are there
  void finish(bool is_whole);

  std::vector<std::filesystem::path> files() const;

 private:
  std::filesystem::path folder_of(Mode mode) const;
  std::set<std::string> files_to_come(const setup::FrameRange& frames) const;
  /// @param lost  files of the earlier one
  void refuse_loss(const Json& earlier, record::FileHashes lost,
                   const setup::FrameRange& frames) const;
  void refuse_foreign(const record::FileHashes& made, const setup::FrameRange& frames) const;
  void write_list(bool is_whole, const std::set<std::string>& begun) const;

  std::filesystem::path out_;
  std::string a_, b_;  ///< as they were named
  bool replaces_;
  TargetKind kind_;
  std::vector<Mode> modes_;
  output::MovieStyle movie_;
  std::optional<output::FolderLock> lock_;
  std::filesystem::path scratch_;  ///< pictures of a movie that is alone
  std::optional<int> first_;       ///< number of the first frame that was added
  int last_ = 0;                   ///< of the last one
  std::vector<output::WrittenFile> files_;
};

}  // namespace neve::app::compare
