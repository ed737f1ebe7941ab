#include "app/sweep/sheet/star.h"

#include <fmt/core.h>
#include <unistd.h>

#include <iostream>

#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/progress.h"
#include "app/sweep/plan/selection.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/sheet/collect.h"
#include "app/sweep/store/stars.h"

namespace neve::app::sweep::sheet {

namespace {

void change(const StarOptions& options, const store::Manifest& manifest, store::KeptMarks& kept) {
  const int last = static_cast<int>(manifest.runs.size()) - 1;
  if (!options.read.empty()) store::add_marks(store::read_marks_file(options.read, manifest), kept);
  if (options.runs.empty()) return;
  store::Marks& marks = kept.marks;
  for (const int run : plan::parse_selection("RUNS", options.runs, last)) {
    if (options.is_removed) {
      marks.erase(run);
      continue;
    }
    store::Mark& mark = marks[run];
    mark.has_star = true;
    if (options.note) mark.note = *options.note;
  }
}

void print(const store::Manifest& manifest, const store::Marks& marks) {
  for (const auto& [run, mark] : marks)
    std::cout << fmt::format("{} {}{}{}\n", mark.has_star ? "*" : " ",
                             store::run_text(manifest.runs[static_cast<std::size_t>(run)]),
                             mark.note.empty() ? "" : ": ", mark.note);
  if (marks.empty()) std::cout << "no run has a star\n";
}

}  // namespace

void describe(options::Command& visit, StarOptions& o) {
  visit.about("sweep star",
              "Give runs of a sweep a star and a note, which stay with it: on tiles, in the table, "
              "the report and starred.png; without RUNS, list them");
  visit.other_place = plan::copied_sweep;
  visit("DIR", o.folder, options::text(""), "Output folder of a sweep").required();
  visit("RUNS", o.runs, options::text("RUNS", "3,7-9"),
        "Numbers of tiles, as the sheet and the report have them");
  visit("--note", o.note, options::text("TEXT", "\"the edge is right\""),
        "A note for these runs; \"\" takes theirs away");
  visit("--remove", o.is_removed, "Take star and note away from these runs");
  visit("--read", o.read, options::text("FILE", "stars.json"),
        "Add the stars of a file that the report has made");
  visit("--json", o.is_json, options::json_help);
}

int run_star(const StarOptions& options) {
  const bool is_changed = !options.runs.empty() || !options.read.empty();
  if (options.runs.empty() && (options.is_removed || options.note))
    throw UsageError("sweep star", "no run is named", "name some, as in neve sweep star DIR 3,7");
  if (options.is_removed && options.note)
    throw UsageError("sweep star", "--remove takes the note away, --note gives one",
                     "give one of the two");
  if (options.note && options.note->size() > store::longest_note)
    throw UsageError("--note", fmt::format("this note has {} bytes", options.note->size()),
                     fmt::format("expected {} at most; write a file for more, and its name here",
                                 store::longest_note));
  store::Manifest manifest = store::read_manifest(options.folder);
  store::KeptMarks kept = store::read_marks(options.folder, manifest);
  change(options, manifest, kept);
  manifest.marks = kept.marks;
  Progress progress(std::cerr, Verbosity::quiet, can_update_lines(STDERR_FILENO));
  if (is_changed) {
    store::write_marks(options.folder, manifest, kept);
    show_marks(options.folder, manifest, progress);
  }
  for (const std::string& line : store::lost_lines(kept.lost)) progress.warning(line);
  if (options.is_json)
    std::cout << to_text(store::to_json(manifest, manifest.marks)) << "\n";
  else
    print(manifest, manifest.marks);
  return exit_ok;
}

}  // namespace neve::app::sweep::sheet
