#include "app/record/picture_record.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "render/image/exr.h"

namespace neve::app::record {

namespace {

Json to_json(const StripRecord& strip) {
  return {{"times", strip.times}, {"columns", strip.columns}, {"width", strip.width}};
}

/// @throws std::runtime_error, nlohmann::json::exception
StripRecord strip_record(const Json& json) {
  StripRecord strip;
  strip.times = json.at("times").get<std::vector<double>>();
  strip.columns = whole_number<int>(json.at("columns"));
  strip.width = whole_number<int>(json.at("width"));
  const bool is_increasing =
      std::ranges::adjacent_find(strip.times, std::greater_equal<>()) == strip.times.end();
  if (strip.times.empty() || !is_increasing || !(strip.times.front() >= 0) ||
      !(strip.times.back() <= 1e9) || strip.times.size() > 10000)
    throw std::runtime_error("its moments are not in order");
  if (strip.columns < 1 || strip.columns > 200 || strip.width < 160 || strip.width > 16384)
    throw std::runtime_error("its columns or width are out of range");
  return strip;
}

/// More changes than any person makes while a run runs.
constexpr std::size_t max_changes = 100'000;
constexpr double largest_coarsening = 1e6;

/// Reads the texts of one PNG and says which one is wrong.
class TextReader {
 public:
  TextReader(std::string file, const render::PngText& text) : file_(std::move(file)), text_(text) {}

  std::string text(const char* key) const {
    const auto found = text_.find(key);
    if (found == text_.end()) fail(std::string("it holds no text ") + key);
    return found->second;
  }

  template <class Number>
  Number number(const char* key) const {
    const std::optional<Number> value = app::number_of<Number>(text(key));
    if (!value) fail(std::string("its text ") + key + " is not a number");
    return *value;
  }

  Json json(const char* key) const {
    try {
      return parse_json(std::string_view(text(key)));
    } catch (const nlohmann::json::exception&) {
      fail(std::string("its text ") + key + " is not valid JSON");
    }
  }

  std::vector<scene::LiveChange> changes(const char* key) const {
    try {
      return scene::live_changes(json(key));
    } catch (const std::runtime_error& error) {
      fail(error.what());
    }
  }

  /// Lines of a caption.
  std::vector<std::string> lines(const char* key) const {
    constexpr std::size_t max_lines = 20, max_length = 500;
    std::vector<std::string> lines;
    for (const Json& item : json(key)) {
      if (!item.is_string() || item.get<std::string>().size() > max_length ||
          lines.size() == max_lines)
        fail(std::string("its text ") + key + " is not a list of short lines");
      lines.push_back(item.get<std::string>());
    }
    return lines;
  }

  StripRecord strip(const char* key) const {
    const Json found = json(key);
    try {
      return strip_record(found);
    } catch (const std::exception& error) {  // also that of a value of another type
      fail(error.what());
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(exit_invalid_scene, file_ + ": error: not a picture made by neve: " + reason, file_,
                "name a picture that neve render wrote");
  }

 private:
  std::string file_;
  const render::PngText& text_;
};

}  // namespace

namespace {

constexpr std::array<std::uint8_t, 4> png_start{0x89, 'P', 'N', 'G'};
constexpr std::array<std::uint8_t, 4> exr_start{0x76, 0x2f, 0x31, 0x01};

bool is_exr(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && std::ranges::equal(bytes.first(4), exr_start);
}

}  // namespace

/// The same names and values as in JSON, as text.
render::PngText to_png_text(const PictureRecord& record) {
  const auto text_of = [&](const std::string& key, const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return scene::toml::number_text(value.get<double>());
    return key == "passes" ? joined(record.passes, ",") : to_text(value, -1);
  };
  const Json json = to_json(record);
  render::PngText text;
  for (const auto& [key, value] : json.items()) text["neve:" + key] = text_of(key, value);
  return text;
}

Json to_json(const PictureRecord& record) {
  Json json;
  json["scene"] = record.scene;
  json["overrides"] = record.overrides;
  json["coarsen"] = record.coarsening;
  if (!record.prediction.empty()) json["prediction"] = record.prediction;
  json["changes"] = scene::to_json(record.changes);
  json["seed"] = record.seed;
  json["version"] = record.version;
  json["build"] = record.build;
  json["state_hash"] = record.state_hash;
  json["frame"] = record.frame;
  json["view"] = record.view;
  json["quality"] = record.quality;
  if (!record.plate.empty()) json["plate"] = record.plate;
  if (!record.lut.empty()) json["lut"] = record.lut;
  if (record.shutter > 0) json["shutter"] = record.shutter;
  if (!record.passes.empty()) json["passes"] = record.passes;
  if (!record.has_caption) json["caption"] = false;
  if (record.strip) json["strip"] = to_json(*record.strip);
  json["files"] = record.files;
  return json;
}

namespace {

constexpr const char *sheet_key = "neve:sheet", *card_key = "neve:card";

render::PngText text_in(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = output::read_file(file);
  try {
    return is_exr(bytes) ? render::read_exr_text(bytes) : render::read_png_text(bytes);
  } catch (const render::ImageError& error) {
    throw Error(exit_invalid_scene, file.string() + ": error: " + error.what(), file.string());
  }
}

std::optional<SheetRecord> sheet_in(const render::PngText& text, const std::string& file) {
  if (!text.contains(sheet_key) || text.contains("neve:scene")) return std::nullopt;
  const TextReader reader(file, text);
  const Json json = reader.json(sheet_key);
  if (!json.is_object() || !json.value("what", Json()).is_string())
    reader.fail("its text neve:sheet does not say what it is");
  SheetRecord record;
  record.what = json["what"].get<std::string>();
  record.version = reader.text("neve:version");
  for (const Json& line : json.value("lines", Json::array()))
    if (line.is_string()) record.lines.push_back(line.get<std::string>());
  if (const Json again = json.value("again", Json()); again.is_string())
    record.again = again.get<std::string>();
  for (const Json& scene : json.value("scenes", Json::array())) {
    if (!scene.is_object() || !scene.value("name", Json()).is_string() ||
        !scene.value("scene", Json()).is_string())
      reader.fail("its text neve:sheet has a scene without a name or a text");
    record.scenes.push_back({scene["name"].get<std::string>(), scene["scene"].get<std::string>()});
  }
  return record;
}

}  // namespace

render::PngText to_png_text(const SheetRecord& record) {
  Json json{{"what", record.what}, {"lines", record.lines}};
  if (!record.again.empty()) json["again"] = record.again;
  for (const SheetRecord::Scene& scene : record.scenes)
    json["scenes"].push_back({{"name", scene.name}, {"scene", scene.text}});
  return {{sheet_key, to_text(json, -1)}, {"neve:version", record.version}};
}

void SheetRecord::add(std::string name, const std::string& text) {
  name.resize(12, ' ');
  if (!text.empty()) lines.push_back(name + text);
}

std::optional<SheetRecord> read_sheet_record(const std::filesystem::path& file) {
  return sheet_in(text_in(file), file.string());
}

PictureRecord read_picture_record(const std::filesystem::path& file) {
  return picture_record_of(text_in(file), file.string());
}

PictureRecord picture_record_of(const render::PngText& text, const std::string& file) {
  if (const std::optional<SheetRecord> sheet = sheet_in(text, file))
    throw Error(
        exit_invalid_scene,
        file + ": error: is " + sheet->what +
            (sheet->again.empty()
                 ? ", not one picture of a run; name a picture of one of its runs, as in runs/0000"
                 : ", not a picture of a run; name one that neve render wrote"),
        file, "neve info says more of it");
  const TextReader reader(file, text);
  PictureRecord record;
  record.scene = reader.text("neve:scene");
  for (const Json& item : reader.json("neve:overrides"))
    if (item.is_string()) record.overrides.push_back(item.get<std::string>());
  if (text.contains("neve:changes")) record.changes = reader.changes("neve:changes");
  // Pictures of earlier versions do not say.
  if (text.contains("neve:coarsen")) record.coarsening = reader.number<double>("neve:coarsen");
  if (!(record.coarsening >= 1 && record.coarsening <= largest_coarsening))
    reader.fail("its coarsening is not from 1 to a million");
  if (text.contains("neve:prediction")) record.prediction = reader.lines("neve:prediction");
  record.seed = reader.number<std::uint64_t>("neve:seed");
  record.version = reader.text("neve:version");
  if (text.contains("neve:build")) record.build = reader.text("neve:build");
  record.state_hash = reader.text("neve:state_hash");
  record.frame = reader.number<int>("neve:frame");
  record.view = reader.text("neve:view");
  record.quality = reader.text("neve:quality");
  if (text.contains("neve:plate")) record.plate = reader.text("neve:plate");
  if (text.contains("neve:lut")) record.lut = reader.text("neve:lut");
  if (text.contains("neve:shutter")) record.shutter = reader.number<double>("neve:shutter");
  if (!(record.shutter >= 0 && record.shutter <= 360))
    reader.fail("its shutter is not from 0 to 360");
  if (text.contains("neve:passes")) record.passes = comma_separated(reader.text("neve:passes"));
  record.has_caption = !text.contains("neve:caption");
  if (text.contains("neve:strip")) record.strip = reader.strip("neve:strip");
  if (text.contains(card_key))
    for (const Json& card : reader.json(card_key))
      if (card.is_object() && card.value("title", Json()).is_string() && record.cards.size() < 100)
        record.cards.push_back(card["title"].get<std::string>());
  const Json files = reader.json("neve:files");
  for (const auto& [path, hash] : files.items())
    if (hash.is_string()) record.files[path] = hash.get<std::string>();
  // Its number: below 0 with handles or a first_frame below 0.
  if (record.frame < -output::max_frame || record.frame > output::max_frame)
    reader.fail("its frame has more digits than " + std::to_string(output::max_frame));
  if (record.changes.size() > max_changes)
    reader.fail("it has more than " + std::to_string(max_changes) + " changes");
  if (!output::is_plain_name(record.view)) reader.fail("the name of its view is invalid");
  return record;
}

bool is_picture(const std::filesystem::path& file) {
  // A pipe is not read: its bytes would be gone for the reader of the scene.
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::ifstream in(file, std::ios::binary);
  std::array<std::uint8_t, 4> start{};
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  return in && (start == png_start || start == exr_start);
}

}  // namespace neve::app::record
