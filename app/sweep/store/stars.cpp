#include "app/sweep/store/stars.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::sweep::store {

namespace {

namespace fs = std::filesystem;

constexpr const char* format = "neve stars 1";

fs::path marks_path(const fs::path& folder) {
  return folder / "stars.json";
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(exit_invalid_scene, file.string() + ": is not a list of stars: " + why, file.string(),
              "the report of a sweep makes one, and neve sweep star DIR RUNS");
}

std::vector<KeptMark> parse_marks(const fs::path& file) {
  std::vector<KeptMark> kept;
  try {
    const Json json = output::read_json(file);
    if (!json.is_object() || json.value("format", "") != format || !json.contains("runs"))
      refuse(file, fmt::format("expected \"format\": \"{}\" and \"runs\"", format));
    for (const Json& item : json["runs"]) {
      KeptMark one{whole_number<int>(item.at("run")),
                   {item.value("star", false), item.value("note", "")},
                   item.value("key", ""),
                   {},
                   !item.contains("settings")};
      if (one.run < 0 || one.mark.note.size() > longest_note)
        refuse(file, fmt::format("run {} is below 0, or has a note of more than {} bytes", one.run,
                                 longest_note));
      one.mark.note = line_text(one.mark.note);
      for (const Json& setting : item.value("settings", Json::array()))
        one.settings.push_back({line_text(setting.at(0).get<std::string>()),
                                line_text(setting.at(1).get<std::string>())});
      kept.push_back(std::move(one));
    }
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    const auto* broken = dynamic_cast<const Json::parse_error*>(&error);
    refuse(file, broken ? fmt::format("byte {} is not JSON", broken->byte)
                        : std::string("expected a \"run\", a \"star\" and a \"note\" in each of "
                                      "its \"runs\""));
  }
  return kept;
}

bool is_same(const std::vector<scene::Override>& a, const std::vector<scene::Override>& b) {
  return std::ranges::equal(a, b, [](const scene::Override& x, const scene::Override& y) {
    return x.address == y.address && x.value == y.value;
  });
}

/// True if a mark is of a run. The key tells that; if a change of scene or program gave all runs
/// other keys, the settings do. A mark that has nothing but a number is of the run with it.
bool is_run_of(const KeptMark& kept, const Manifest& manifest, const Run& run, bool by_key) {
  if (kept.is_numbered) return kept.run == run.index;
  if (by_key) return !kept.key.empty() && kept.key == run.key;
  return is_same(kept.settings, telling_settings(manifest, run));
}

const Run* find_run(const KeptMark& kept, const Manifest& manifest, const Marks& taken) {
  const Run* found = nullptr;
  for (const bool by_key : {true, false}) {
    for (const Run& run : manifest.runs)
      if (!taken.contains(run.index) && (!found || run.index == kept.run) &&
          is_run_of(kept, manifest, run, by_key))
        found = &run;
    if (found) return found;
  }
  return found;
}

KeptMarks placed(std::vector<KeptMark> list, const Manifest& manifest) {
  KeptMarks kept;
  for (KeptMark& one : list) {
    if (const Run* run = find_run(one, manifest, kept.marks))
      kept.marks[run->index] = std::move(one.mark);
    else if (one.mark.is_given())
      kept.lost.push_back(std::move(one));
  }
  return kept;
}

Json to_json(const KeptMark& kept) {
  Json json = {{"run", kept.run}, {"star", kept.mark.has_star}, {"note", kept.mark.note}};
  if (kept.is_numbered) return json;
  json["key"] = kept.key;
  json["settings"] = settings_json(kept.settings);
  return json;
}

}  // namespace

std::vector<scene::Override> telling_settings(const Manifest& manifest, const Run& run) {
  std::set<std::string> addresses;
  for (const Parameter& parameter : manifest.parameters) addresses.insert(parameter.address);
  if (manifest.varied) addresses.insert(manifest.varied->begin(), manifest.varied->end());
  std::vector<scene::Override> settings;
  for (const std::string& address : addresses)
    if (const std::string value = run.value(address); !value.empty())
      settings.push_back({address, value});
  return settings;
}

KeptMarks read_marks(const fs::path& folder, const Manifest& manifest) {
  std::error_code error;
  const fs::path file = marks_path(folder);
  if (!fs::exists(file, error)) return {};
  KeptMarks kept = placed(parse_marks(file), manifest);
  std::erase_if(kept.marks, [](const auto& mark) { return !mark.second.is_given(); });
  return kept;
}

KeptMarks read_marks_file(const fs::path& file, const Manifest& manifest) {
  KeptMarks kept = placed(parse_marks(file), manifest);
  for (const KeptMark& lost : kept.lost)
    if (lost.is_numbered)
      refuse(file, fmt::format("it has run {}, and the runs of this sweep are 0 to {}", lost.run,
                               manifest.runs.size() - 1));
  return kept;
}

void add_marks(const KeptMarks& more, KeptMarks& kept) {
  for (const auto& [run, mark] : more.marks)
    if (mark.is_given())
      kept.marks[run] = mark;
    else
      kept.marks.erase(run);
  for (const KeptMark& lost : more.lost) {
    std::erase_if(kept.lost, [&](const KeptMark& other) {
      return !other.is_numbered && is_same(other.settings, lost.settings);
    });
    kept.lost.push_back(lost);
  }
}

void write_marks(const fs::path& folder, const Manifest& manifest, const KeptMarks& kept) {
  if (!kept.marks.empty() || !kept.lost.empty()) {
    Json json = to_json(manifest, kept.marks);
    for (const KeptMark& lost : kept.lost) json["runs"].push_back(to_json(lost));
    return output::write_file(marks_path(folder), to_text(json) + "\n");
  }
  std::error_code error;
  fs::remove(marks_path(folder), error);
}

Json to_json(const Manifest& manifest, const Marks& marks) {
  Json runs = Json::array();
  for (const auto& [index, mark] : marks) {
    const Run& run = manifest.runs[static_cast<std::size_t>(index)];
    runs.push_back(to_json(KeptMark{index, mark, run.key, telling_settings(manifest, run)}));
  }
  return {{"format", format}, {"runs", runs}};
}

std::vector<std::string> lost_lines(const std::vector<KeptMark>& lost) {
  std::vector<std::string> lines;
  for (const KeptMark& one : lost) {
    std::string run = fmt::format("run {}", one.run);
    for (const scene::Override& setting : one.settings)
      run += (&setting == &one.settings.front() ? ", " : "; ") + setting.address + " = " +
             setting.value;
    lines.push_back(
        fmt::format("this sweep has no run any more that was {}: its {}{} in stars.json", run,
                    one.mark.has_star ? "star stays" : "note stays",
                    one.mark.note.empty() ? "" : " (" + one.mark.note + ")"));
  }
  return lines;
}

}  // namespace neve::app::sweep::store
