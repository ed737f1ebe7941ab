#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/compare/compare_run.h"
#include "app/output/json_file.h"
#include "app/output/read_picture.h"
#include "app/output/sequence.h"
#include "app/record/picture_record.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "render/image/image.h"
#include "sim/shapes/held_files.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

render::Image read_picture(const std::string& file) {
  require_picture(file, "neve compare");
  return output::read_picture(file);
}

int compare_pictures(const CompareOptions& options) {
  const render::Image a = read_picture(options.pictures.a), b = read_picture(options.pictures.b);
  if (a.width != b.width || a.height != b.height)
    throw Error(exit_check_failed,
                "the pictures have different sizes: " + std::to_string(a.width) + "x" +
                    std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                    std::to_string(b.height),
                options.pictures.b);
  if (a.channels != b.channels)
    throw Error(exit_check_failed,
                fmt::format("{} has {} channels and {} has {}", options.pictures.a, a.channels,
                            options.pictures.b, b.channels),
                options.pictures.b, "draw both with the same output.background");
  const render::Difference difference = render::compare(a, b);
  const bool is_same =
      difference.mean <= options.threshold && difference.local <= options.local_threshold;
  if (options.is_json) {
    std::cout << to_text({{"same", is_same},
                          {"max", difference.max},
                          {"mean", difference.mean},
                          {"local", difference.local},
                          {"threshold", options.threshold},
                          {"local_threshold", options.local_threshold}})
              << "\n";
  } else {
    std::cout << "max " << fixed_text(difference.max, 0) << "  mean "
              << fixed_text(difference.mean, 4) << "  local " << fixed_text(difference.local, 2)
              << "  of 255\n";
  }
  return is_same ? exit_ok : exit_check_failed;
}

struct KnownState {
  std::string hash;
  double time = 0;  ///< s
  Json dust;        ///< its totals: hashes are of the snow alone
};

struct KnownStates {
  int first_number = 0;          ///< of the start
  std::map<int, KnownState> at;  ///< by frame, counted from the start
};

KnownStates read_states(const fs::path& folder) {
  const fs::path file = output::run_json_path(folder);
  const std::vector<std::uint8_t> bytes = output::read_json_bytes(file);
  KnownStates states;
  try {
    const Json run = parse_json(bytes);
    states.first_number = whole_number<int>(run.value("first_number", Json(0)));
    for (const Json& frame : run.at("frames"))
      states.at[whole_number<int>(frame.at("frame")) - states.first_number] = {
          frame.at("state_hash").get<std::string>(), frame.at("time").get<double>(),
          frame.value("dust", Json())};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    throw Error(exit_invalid_scene, file.string() + ": error: is not a run.json of neve",
                file.string());
  }
  return states;
}

int compare_runs(const CompareOptions& options) {
  const KnownStates a = read_states(options.pictures.a), b = read_states(options.pictures.b);
  int compared = 0;
  std::optional<int> first_different, first_other_dust;
  for (const auto& [frame, state] : a.at) {
    const auto other = b.at.find(frame);
    if (other == b.at.end()) continue;
    const double apart = std::abs(other->second.time - state.time);
    if (apart > 1e-9 * std::max(1.0, std::abs(state.time)))
      throw UsageError(
          "",
          fmt::format("frame {} of {} is at {} s and frame {} of {} at {} s",
                      a.first_number + frame, options.pictures.a, rough_text(state.time),
                      b.first_number + frame, options.pictures.b, rough_text(other->second.time)),
          "compare runs with the same fps");
    ++compared;
    if (!first_different && other->second.hash != state.hash) first_different = frame;
    if (!first_other_dust && other->second.dust != state.dust) first_other_dust = frame;
  }
  const bool is_same = !first_different && !first_other_dust && compared > 0 &&
                       a.at.size() == b.at.size() && compared == static_cast<int>(a.at.size());
  if (options.is_json) {
    std::cout << to_text({{"same", is_same},
                          {"frames_compared", compared},
                          {"frames_a", a.at.size()},
                          {"frames_b", b.at.size()},
                          {"first_different_frame",
                           first_different ? Json(a.first_number + *first_different) : Json()},
                          {"first_other_dust",
                           first_other_dust ? Json(a.first_number + *first_other_dust) : Json()}})
              << "\n";
  } else if (first_different) {
    std::cout << "the states differ from frame " << a.first_number + *first_different;
    if (a.first_number != b.first_number)
      std::cout << " of A, " << b.first_number + *first_different << " of B";
    std::cout << "\n";
  } else if (first_other_dust) {
    std::cout << "the snow has the same states in " << compared << " frames; its dust differs from "
              << "frame " << a.first_number + *first_other_dust << "\n";
  } else if (!is_same) {
    std::cout << "the runs have different frames: " << a.at.size() << " and " << b.at.size() << ", "
              << compared << " in common with the same states\n";
  } else {
    std::cout << "the same states in " << compared << " frames\n";
  }
  return is_same ? exit_ok : exit_check_failed;
}

/// @throws UsageError when it has no run.json
void check_run_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(output::run_json_path(folder), error)) return;
  const FolderAdvice advice = advice_on_folder(folder);
  throw UsageError("", folder.string() + " " + advice.what,
                   advice.hint + "; neve compare takes two pictures or two runs");
}

/// Whether a file is a picture with pixels alone, without the scene that made it.
bool has_only_pixels(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) return false;
  require_picture(file, "neve compare");
  try {
    record::read_picture_record(file);
  } catch (const UnreadableError&) {
    throw;
  } catch (const Error&) {
    return true;
  }
  return false;
}

void print_pair(const CompareOptions& options, const compare::PairResult& result) {
  if (!options.is_json) {
    for (const fs::path& file : result.files)
      if (file.extension() != ".png" || result.files.size() < 3) std::cout << file.string() << "\n";
    return;
  }
  Json json;
  json["out"] = options.pictures.out;
  json["is_whole"] = result.is_whole;
  json["files"] = Json::array();
  for (const fs::path& file : result.files) json["files"].push_back(file.generic_string());
  json["differing"] = result.differing;
  json["frames"] = compare::series_json(result.moments);
  json["warnings"] = result.warnings;
  set_answer(std::move(json));
}

/// Pictures that differ are what was asked for: no failed check.
int draw_pair(const CompareOptions& options) {
  catch_interrupts();
  const compare::PairOptions& pictures = options.pictures;
  Progress progress(pictures.verbosity, pictures.progress);
  const bool is_plain = has_only_pixels(options.pictures.a) || has_only_pixels(options.pictures.b);
  const compare::PairResult result = is_plain ? compare::compare_plain_pictures(pictures)
                                              : compare::compare_run(pictures, progress);
  progress.clear();
  for (const std::string& warning : result.warnings) progress.warning(warning);
  print_pair(options, result);
  if (!result.is_whole)
    throw Error(exit_interrupted, "interrupted; the pictures so far are in " + pictures.out,
                pictures.out);
  return exit_ok;
}

}  // namespace

int run_compare(const CompareOptions& options) {
  const sim::shapes::HeldFiles files;
  std::error_code error;
  for (const std::string& path : {options.pictures.a, options.pictures.b})
    if (!fs::exists(path, error))
      throw IoError(path + ": error: does not exist", path,
                    "compare two pictures or two run folders");
  const bool is_a_run = fs::is_directory(options.pictures.a, error);
  const bool is_b_run = fs::is_directory(options.pictures.b, error);
  if (!options.pictures.out.empty()) {
    if (is_a_run) check_run_folder(options.pictures.a);
    if (is_b_run) check_run_folder(options.pictures.b);
    return draw_pair(options);
  }
  if (is_a_run != is_b_run)
    throw UsageError("", "one is a folder and the other is not",
                     "compare two pictures or two run folders");
  if (!is_a_run) return compare_pictures(options);
  check_run_folder(options.pictures.a);
  check_run_folder(options.pictures.b);
  return compare_runs(options);
}

}  // namespace neve::app::cli
