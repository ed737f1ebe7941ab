#pragma once
/// Stars and notes that a person gave to runs of a sweep, in DIR/stars.json. A mark stays with its
/// run when the sweep gets other runs and other numbers.

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/override.h"
#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::store {

constexpr std::size_t longest_note = 2000;  ///< bytes

/// A mark as a file has it, with what tells its run from others.
struct KeptMark {
  int run = 0;  ///< its number when the mark was written: all that files of earlier versions have
  Mark mark;
  std::string key{};                        ///< Run::key
  std::vector<scene::Override> settings{};  ///< see telling_settings()
  bool is_numbered = false;                 ///< has nothing but the number
};

/// The marks in a file, by the runs that the sweep has now.
struct KeptMarks {
  Marks marks;
  std::vector<KeptMark> lost;  ///< of runs that it has no more
};

/// Values of the parameters by which the sweep tells its runs apart.
std::vector<scene::Override> telling_settings(const Manifest& manifest, const Run& run);

/// Reads the marks; none without a file. @throws Error if it is broken, IoError
KeptMarks read_marks(const std::filesystem::path& folder, const Manifest& manifest);

/// Reads marks of a file of the report; one without star and note was taken away there.
/// @throws Error if it is broken, or has no more than numbers, of runs that the sweep does not
/// have; IoError
KeptMarks read_marks_file(const std::filesystem::path& file, const Manifest& manifest);

/// Puts marks in the place of those of the same runs; removes those that were taken away.
void add_marks(const KeptMarks& more, KeptMarks& kept);

/// Removes the file where nothing is marked. @throws IoError
void write_marks(const std::filesystem::path& folder, const Manifest& manifest,
                 const KeptMarks& kept);

/// Writes the marks of the runs, for pages and scripts.
Json to_json(const Manifest& manifest, const Marks& marks);

/// "the star of hardening = 5 ...": a line for each mark without a run.
std::vector<std::string> lost_lines(const std::vector<KeptMark>& lost);

}  // namespace neve::app::sweep::store
