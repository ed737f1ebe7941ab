#pragma once
/// The ledger of a run: its record in run.json, its files with their hashes, and which of them
/// would survive a power cut.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "app/exports/exporter.h"
#include "app/output/picture_writer.h"
#include "app/run/addition.h"
#include "app/run/drawing.h"
#include "app/run/render_job.h"
#include "app/support/progress.h"

namespace neve::app::run {

/// Begins the warning of a movie that was not made: the next command may make it.
inline const std::string no_movie = "no movie ";

class Ledger {
 public:
  /// @param job, progress  outlive it
  /// @param record  of the run as it begins
  Ledger(const RenderJob& job, const setup::SeededScene& seeded, record::RunRecord record,
         Progress& progress);

  record::RunRecord& record() { return record_; }
  const record::RunRecord& record() const { return record_; }
  /// Lists and files so far, to keep with a moment.
  /// @param frame  of the moment, counted from 0
  timeline::Made made(int frame) const;

  /// Makes the folders of views and exports. @throws IoError where something is in their place
  void make_folders();
  /// Removes the files of an earlier run. Its frames stay listed until they are made again:
  /// whenever the process is killed, run.json lists every picture that exists.
  void replace_earlier();
  /// Becomes the ledger of the same run with more pictures; removes what they replace.
  void add_to(const EarlierRun& earlier);
  /// Notes the earlier views of a run that is resumed.
  void keep_views(const EarlierRun& earlier) { run::keep_views(job_, earlier, record_); }
  /// True where the run has the pictures of a frame already, unchanged, and no exports are due.
  bool is_made(int frame) const;
  /// Takes what a run that is resumed has made until a moment. @throws IoError for a broken list
  void take(const timeline::Moment& moment);
  /// Makes the folders, of which removed files leave none, and writes run.json.
  void open();
  void write() { record::write_run_json(job_.folder, record_); }

  /// Reads the state for the exports of a frame.
  std::vector<exports::Exporter::Work> read_exports(const timeline::Timeline& timeline);
  /// Lists a frame, then lets its files be written.
  void add(const record::FrameRecord& frame, Drawing::Files drawn,
           std::vector<exports::Exporter::Work> exports);
  void write_picture(output::Picture picture) { writer_.write(std::move(picture)); }
  void note_file(const output::WrittenFile& file);

  /// Waits until everything made so far would survive a power cut.
  void bring_to_disk();
  /// Movies and the lists of exports, then everything is brought to disk. @return the movies
  std::vector<std::filesystem::path> finish(record::RunStatus status);
  /// Says so in run.json, without frames whose pictures are missing.
  void fail(const std::string& error);

 private:
  void note_written();
  void note_exports();
  output::MovieStyle style_of(const std::string& view) const;
  void write_movie(const std::string& view, const output::MovieStyle& style,
                   std::vector<std::filesystem::path>& movies);
  bool is_movie_short(const std::filesystem::path& file) const;
  void write_earlier_movies(const std::string& view, std::vector<std::filesystem::path>& movies);
  void forget_unwritten_frames();
  bool is_missing(const std::string& view, int number) const;
  void carry_status();
  bool has_all_pictures() const;

  const RenderJob& job_;
  Progress& progress_;
  record::RunRecord record_;
  exports::Exporter exporter_;
  std::optional<EarlierRun> earlier_;         ///< that pictures are added to
  bool has_added_ = false;                    ///< a frame
  std::set<std::filesystem::path> unsynced_;  ///< files that a power cut may still take
  output::PictureWriter writer_;              ///< last: stops before its inputs are destroyed
};

}  // namespace neve::app::run
