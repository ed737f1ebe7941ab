/// The command line of `neve compare`.

#include <filesystem>
#include <memory>

#include "app/cli/command_line_parts.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

/// Values that CLI11 hands over as text.
struct CompareTexts {
  std::optional<std::string> frames, size, range, progress;
  std::vector<std::string> modes;
  bool is_quiet = false;
  MovieTexts movie;
};

std::string mode_names() {
  std::vector<std::string> names;
  for (const compare::Mode mode : compare::all_modes()) names.emplace_back(compare::name(mode));
  return joined(names, ", ");
}

CompareOptions finished_compare(const CLI::App& command, CompareOptions options,
                                const CompareTexts& texts) {
  compare::PairOptions& pictures = options.pictures;
  pictures.a = options.a;
  pictures.b = options.b;
  if (command.count("--out") > 0 && pictures.out.empty())
    throw UsageError("--out", "names no folder or file",
                     "expected a folder, or a file .png, .mp4, .webm, .mov, .gif, .webp or .csv");
  for (const char* flag : {"--mode", "--frames", "--view", "--size", "--wipe", "--range", "--movie",
                           "--movie-quality", "--movie-fps"})
    if (pictures.out.empty() && command.count(flag) > 0)
      throw UsageError(flag, "has no use without pictures",
                       "give --out DIR, --out x.png or --out x.mp4 too");
  for (const std::string& mode : texts.modes) pictures.modes.push_back(compare::mode_named(mode));
  if (texts.frames) pictures.frames = setup::parse_frames(*texts.frames);
  pictures.movie = finished_movie(texts.movie);
  if (texts.size) pictures.size = setup::parse_size(*texts.size);
  if (texts.range) pictures.range = setup::finite_number(*texts.range);
  if (texts.range && !(pictures.range && *pictures.range > 0))
    throw UsageError("--range", "cannot use \"" + *texts.range + "\"",
                     "expected metres, as in --range 0.1");
  if (!(pictures.wipe >= 0 && pictures.wipe <= 1))
    throw UsageError("--wipe", "cannot use " + rough_text(pictures.wipe),
                     "expected a share of the width, 0 to 1");
  if (texts.is_quiet) pictures.verbosity = Verbosity::quiet;
  if (texts.progress) pictures.progress.is_json = parse_progress(*texts.progress);
  check_threads(pictures.threads);
  check_backend(pictures.backend);
  return options;
}

void add_picture_flags(CLI::App& command, const std::shared_ptr<CompareOptions>& options,
                       const std::shared_ptr<CompareTexts>& texts) {
  compare::PairOptions& pictures = options->pictures;
  command
      .add_option(
          "--out", pictures.out,
          "Draw both runs with one camera and one light, into a folder with all modes, or "
          "into a file: x.png (the last frame), x.mp4 or another movie, x.csv for the metrics")
      ->type_name("DIR|FILE");
  add_repeatable(command, "--mode", texts->modes, "NAME",
                 ("How --out shows both (repeatable for a folder): " + mode_names()).c_str());
  command.add_option("--frames", texts->frames, "Frames to draw: A-B, or N for 0-N")
      ->type_name("A-B");
  command.add_option("--view", pictures.view, "View of A that is drawn; default: its first")
      ->type_name("NAME");
  command.add_option("--size", texts->size, "Size of the picture of one run")->type_name("WxH");
  command
      .add_option("--wipe", pictures.wipe, "Share of the width that mode wipe shows of A, 0 to 1")
      ->type_name("MEAN")
      ->capture_default_str();
  command
      .add_option("--range", texts->range,
                  "Metres that have the last colour of mode displacement; default: ten cells")
      ->type_name("M");
  add_movie_flags(command, texts->movie);
  command.add_option("--threads", pictures.threads, "Number of threads; 0: one per core")
      ->type_name("N");
  command.add_option("--backend", pictures.backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  add_caps(command);
  add_progress(command, texts->progress, pictures.progress);
  command.add_flag("--quiet,-q", texts->is_quiet, "Print only errors and warnings");
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Compare two pictures, or the states of two runs frame by frame; with --out as pictures, "
      "movies and curves");
  const auto options = std::make_shared<CompareOptions>();
  const auto texts = std::make_shared<CompareTexts>();
  command
      ->add_option("A", options->a,
                   "A PNG, or the folder of a run; that of a run of a study is DIR/runs/0000")
      ->required()
      ->type_name("");
  command->add_option("B", options->b, "The other PNG or folder")->required()->type_name("");
  command
      ->add_option("--threshold", options->threshold,
                   "Largest mean difference of pictures allowed, 0 to 255")
      ->type_name("MEAN")
      ->capture_default_str();
  command
      ->add_option("--local-threshold", options->local_threshold,
                   "Largest mean difference allowed in any 8x8 block; catches small local changes")
      ->type_name("MEAN")
      ->capture_default_str();
  add_picture_flags(*command, options, texts);
  command->add_flag("--json", options->is_json, "Print the result as JSON");
  command->final_callback([=, &action] {
    action = [=] { return run_compare(finished_compare(*command, *options, *texts)); };
  });
}

}  // namespace neve::app::cli
