#include "app/sweep/store/stars.h"

#include <fmt/core.h>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::sweep::store {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_note = 2000;  // bytes
constexpr const char* format = "neve stars 1";

fs::path marks_path(const fs::path& folder) {
  return folder / "stars.json";
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(exit_invalid_scene, file.string() + ": is not a list of stars: " + why, file.string(),
              "the report of a sweep makes one, and neve sweep star DIR RUNS");
}

Marks parse_marks(const fs::path& file) {
  Marks marks;
  try {
    const Json json = output::read_json(file);
    if (!json.is_object() || json.value("format", "") != format || !json.contains("runs"))
      refuse(file, fmt::format("expected \"format\": \"{}\" and \"runs\"", format));
    for (const Json& item : json["runs"]) {
      const int run = whole_number<int>(item.at("run"));
      Mark mark{item.value("star", false), item.value("note", "")};
      if (run < 0 || mark.note.size() > longest_note)
        refuse(file, fmt::format("run {} is below 0, or has a note of more than {} bytes", run,
                                 longest_note));
      mark.note = line_text(mark.note);
      if (mark.is_given()) marks[run] = std::move(mark);
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
  return marks;
}

}  // namespace

Marks read_marks(const fs::path& folder) {
  std::error_code error;
  const fs::path file = marks_path(folder);
  return fs::exists(file, error) ? parse_marks(file) : Marks{};
}

Marks read_marks_file(const fs::path& file, const Manifest& manifest) {
  Marks marks = parse_marks(file);
  for (const auto& [run, mark] : marks)
    if (run >= static_cast<int>(manifest.runs.size()))
      refuse(file, fmt::format("it has run {}, and the runs of this sweep are 0 to {}", run,
                               manifest.runs.size() - 1));
  return marks;
}

void write_marks(const fs::path& folder, const Marks& marks) {
  if (!marks.empty()) return output::write_file(marks_path(folder), to_text(to_json(marks)) + "\n");
  std::error_code error;
  fs::remove(marks_path(folder), error);
}

Json to_json(const Marks& marks) {
  Json runs = Json::array();
  for (const auto& [run, mark] : marks)
    runs.push_back({{"run", run}, {"star", mark.has_star}, {"note", mark.note}});
  return {{"format", format}, {"runs", runs}};
}

}  // namespace neve::app::sweep::store
