#include <fmt/format.h>

#include <iostream>
#include <sstream>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/output/folder_lock.h"
#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/record/picture_record.h"
#include "app/scene/coarsen.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/timeline/agreement.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

/// The folder of the sweep that a sheet, or one of the sheets of all frames, is of.
fs::path sweep_of(const fs::path& sheet) {
  const fs::path beside = sheet.parent_path(), above = beside.parent_path();
  const fs::path& folder = !is_sweep_folder(beside) && is_sweep_folder(above) ? above : beside;
  return folder.empty() ? fs::path(".") : folder;
}

std::string strip_line(const record::StripRecord& strip, const std::string& path) {
  const std::string first = fixed_text(strip.times.front(), 3),
                    last = fixed_text(strip.times.back(), 3);
  return "strip       " + count_text(strip.times.size(), "moment") + ", " +
         (first == last ? "" : first + " to ") + last + " s; neve strip " + shell_path(path) +
         " makes it again\n";
}

/// Prints the record as plain text: the file may be from anyone.
void print_picture(const record::PictureRecord& record, const std::string& picture) {
  std::ostringstream out;
  out << "neve        " << record.version << (record.build.empty() ? "" : " (" + record.build + ")")
      << "\n"
      << "view        " << record.view << "\n"
      << (record.strip ? "" : fmt::format("frame       {}\n", record.frame)) << "quality     "
      << record.quality << "\n"
      << (record.plate.empty() ? "" : "plate       " + record.plate + "\n")
      << (record.lut.empty() ? "" : "lut         " + record.lut + "\n")
      << (record.shutter > 0 ? "shutter     " + rough_text(record.shutter) + " degrees\n" : "")
      << (record.cards.empty() ? ""
                               : "card        of " + joined(record.cards, ", ") + "; neve card " +
                                     shell_path(picture) + " makes it again\n")
      << (record.strip ? strip_line(*record.strip, picture) : "")
      << (record.passes.empty() ? "" : "passes      " + joined(record.passes, ", ") + "\n")
      << "seed        " << record.seed << "\n"
      << (record.state_hash.empty() ? "" : "state hash  " + record.state_hash + "\n")
      << "again       " << timeline::again_text(record, picture) << "\n";
  for (const std::string& change : record.overrides) out << "override    " << change << "\n";
  for (const scene::LiveChange& change : record.changes)
    out << "changed     " << scene::text_of(change) << "\n";
  if (record.coarsening > 1)
    out << "coarsened   " << scene::coarsening_text(record.coarsening) << "\n";
  for (const std::string& line : record.prediction) out << "predicted   " << line << "\n";
  for (const auto& [path, hash] : record.files)
    out << "file        " << path << " (" << hash << ")\n";
  out << "\n" << record.scene;
  std::cout << printable_text(out.str());
}

/// The file may be from anyone.
void print_sheet(const record::SheetRecord& sheet, const std::string& path, bool is_json) {
  if (is_json) {
    Json json{{"sheet", sheet.what}, {"version", sheet.version}, {"lines", sheet.lines}};
    if (!sheet.again.empty()) json["again"] = sheet.again;
    for (const record::SheetRecord::Scene& scene : sheet.scenes)
      json["scenes"].push_back({{"name", scene.name}, {"scene", scene.text}});
    std::cout << to_text(json) << "\n";
    return;
  }
  const std::string again = sheet.again.empty()
                                ? "neve sweep collect " + shell_path(sweep_of(path).string()) +
                                      " draws it from the pictures of the runs"
                                : sheet.again;
  std::string text = "neve        " + sheet.version + "\n" +
                     (sheet.again.empty() ? "sheet       " : "picture     ") + sheet.what + "\n" +
                     joined(sheet.lines, "\n") + "\n" + "again       " + again + "\n";
  for (const record::SheetRecord::Scene& scene : sheet.scenes)
    text += "\n# " + scene.name + "\n" + scene.text;
  std::cout << printable_text(text);
}

Json read_run(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = output::read_json_bytes(file);
  try {
    Json run = parse_json(bytes);
    if (run.is_object() && run.contains("status") && run["status"].is_string()) return run;
  } catch (const nlohmann::json::exception&) {
  }
  throw Error(exit_invalid_scene, file.string() + ": error: is not a run.json of neve",
              file.string());
}

void print_changes(const Json& run, std::ostream& out) {
  try {
    for (const scene::LiveChange& change : scene::live_changes(run.value("changes", Json::array())))
      out << "changed     " << scene::text_of(change) << "\n";
  } catch (const std::runtime_error& error) {
    out << "changed     " << error.what() << "\n";
  }
}

void print_prediction(const Json& run, std::ostream& out) {
  const Json prediction = run.value("prediction", Json());
  const Json lines = prediction.is_object() ? prediction.value("text", Json()) : Json();
  for (const Json& line : lines)
    if (line.is_string()) out << "predicted   " << line.get<std::string>() << "\n";
}

/// A run that was killed had no time to say so.
std::string life_of(const std::string& status, const fs::path& folder) {
  if (status != "running") return {};
  return output::FolderLock::is_held(folder) ? ", by " + output::FolderLock::holder_of(folder)
                                             : ", but its process has ended; --resume continues it";
}

/// " (commit 1a2b3c4d5e6f, Release, GCC 12.2.0)"; "" in those of earlier versions.
std::string build_of(const Json& run) {
  const Json build = run.value("build", Json());
  std::string all;
  for (const char* key : {"commit", "type", "compiler"})
    if (build.is_object() && build.contains(key) && build[key].is_string())
      all += (all.empty() ? " (commit " : ", ") + build[key].get<std::string>();
  return all.empty() ? all : all + ")";
}

/// Steps and seconds of all frames that say so.
void print_sums(const Json& frames, std::ostream& out) {
  double steps = 0, simulated = 0, drawn = 0;
  const auto number = [](const Json& frame, const char* key) {
    const Json value = frame.is_object() ? frame.value(key, Json()) : Json();
    return value.is_number() ? value.get<double>() : 0;
  };
  for (const Json& frame : frames) {
    steps += number(frame, "steps");
    simulated += number(frame, "seconds_sim");
    drawn += number(frame, "seconds_render");
  }
  out << "steps       " << fixed_text(steps, 0) << "\n"
      << "time        " << fixed_text(simulated, 2) << " s of simulation, " << fixed_text(drawn, 2)
      << " s of drawing\n";
}

void print_run(const Json& run, const fs::path& folder, std::ostream& out) {
  const auto text = [&](const char* key) {
    return run.contains(key) && run[key].is_string() ? run[key].get<std::string>() : std::string();
  };
  out << "neve        " << text("version") << build_of(run) << "\n"
      << "scene       " << text("scene_file") << "\n"
      << "status      " << text("status") << life_of(text("status"), folder) << "\n"
      << "backend     " << text("backend") << ", " << text("gl_renderer") << "\n";
  print_changes(run, out);
  print_prediction(run, out);
  if (!run.contains("frames") || !run["frames"].is_array()) return;
  const Json& frames = run["frames"];
  out << "frames      " << frames.size() << "\n";
  print_sums(frames, out);
  if (frames.empty() || !frames.back().is_object()) return;
  for (const char* key :
       {"frame", "time", "particles", "kinetic_energy", "max_speed", "state_hash"})
    if (frames.back().contains(key))
      out << "last " << key << "  " << to_text(frames.back()[key], -1) << "\n";
}

}  // namespace

int run_info(const PlainOptions& options) {
  const std::string& path = options.name;
  std::error_code error;
  if (fs::is_directory(path, error) && !fs::exists(output::run_json_path(path), error)) {
    const FolderAdvice advice = advice_on_folder(path);
    throw IoError(path + " " + advice.what + "; " + advice.hint, path, advice.hint);
  }
  if (fs::is_directory(path, error) || fs::path(path).extension() == ".json") {
    const fs::path file =
        fs::is_directory(path, error) ? output::run_json_path(path) : fs::path(path);
    const Json run = read_run(file);
    if (options.is_json) {
      std::cout << to_text(run) << "\n";
    } else {
      std::ostringstream out;
      print_run(run, file.parent_path(), out);
      std::cout << printable_text(out.str());
    }
    return exit_ok;
  }
  require_picture(path, "neve info");
  if (const auto sheet = record::read_sheet_record(path)) {
    print_sheet(*sheet, path, options.is_json);
    return exit_ok;
  }
  const record::PictureRecord record = record::read_picture_record(path);
  if (options.is_json) {
    Json json = record::to_json(record);
    if (record.strip) json.erase("frame");  // the nearest one: its times say what it shows
    std::cout << to_text(json) << "\n";
  } else {
    print_picture(record, path);
  }
  return exit_ok;
}

}  // namespace neve::app::cli
