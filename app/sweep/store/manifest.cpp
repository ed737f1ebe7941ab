#include "app/sweep/store/manifest.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <set>
#include <stdexcept>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/record/run_json.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/read/sweep.h"
#include "app/sweep/read/sweep_leaf.h"
#include "app/sweep/store/prepare.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::store {

namespace {

constexpr double max_fps = 1e9;  // of a file from anyone

std::filesystem::path manifest_path(const std::filesystem::path& folder) {
  return folder / "manifest.json";
}

std::string with_unit(const std::string& value, const std::string& unit) {
  return plan::value_text(value) + (unit.empty() ? "" : " " + unit);
}

AxisLabels manifest_axis(const read::Axis& axis, const std::vector<Parameter>& parameters) {
  AxisLabels result;
  const auto varied = [&](const std::string& address) {
    return *std::find_if(parameters.begin(), parameters.end(),
                         [&](const Parameter& v) { return v.address == address; });
  };
  for (const read::Axis::Parameter& parameter : axis.parameters) {
    result.addresses.push_back(parameter.address);
    result.name += (result.name.empty() ? "" : ", ") +
                   (parameter.label.empty() ? varied(parameter.address).name : parameter.label);
  }
  for (std::size_t k = 0; k < axis.size(); ++k) {
    std::string text = axis.value_labels.empty() ? "" : axis.value_labels[k];
    for (const read::Axis::Parameter& parameter : axis.parameters) {
      if (!axis.value_labels.empty()) break;
      text += (text.empty() ? "" : ", ") +
              with_unit(parameter.values[k].value, varied(parameter.address).unit);
    }
    result.values.push_back(text);
  }
  return result;
}

std::vector<scene::Override> settings_of(const Json& pairs) {
  std::vector<scene::Override> settings;
  for (const Json& pair : pairs)
    settings.push_back({pair.at(0).get<std::string>(), pair.at(1).get<std::string>()});
  return settings;
}

/// Values of the run's scene for the parameters that it does not set.
std::vector<scene::Override> inherited_values(const plan::PlannedRun& item,
                                              const std::vector<Parameter>& parameters) {
  std::vector<scene::Override> inherited;
  const scene::toml::Table root = scene::scene_table(item.scene);
  for (const Parameter& parameter : parameters) {
    if (!item.run.setting(parameter.address).empty()) continue;
    if (const scene::toml::Value* value = scene::value_at(root, parameter.address))
      inherited.push_back({parameter.address, scene::toml::toml_literal(*value)});
  }
  return inherited;
}

Json run_json(const Run& run) {
  return {{"run", run.index},
          {"folder", run.folder},
          {"key", run.key},
          {"label", run.label},
          {"settings", settings_json(run.settings)},
          {"unset", settings_json(run.inherited)},
          {"changes", settings_json(run.changes)},
          {"coordinates", run.coordinates},
          {"first_frame", run.frames.first},
          {"last_frame", run.frames.last},
          {"particles", run.particles},
          {"memory_bytes", run.memory},
          {"work", run.work}};
}

/// Returns the changes of a run that forks, from a file older than they are: its settings but for
/// the seed, which is that of its beginning, and its look.
std::vector<scene::Override> changes_of_before(const Json& run) {
  std::vector<scene::Override> changes = settings_of(run.at("settings"));
  std::erase_if(changes, [](const scene::Override& o) { return o.address == "seed"; });
  std::ranges::move(settings_of(run.value("look", Json::array())), std::back_inserter(changes));
  return changes;
}

Run run_of(const Json& json) {
  Run run;
  run.index = whole_number<int>(json.at("run"));
  run.folder = json.at("folder").get<std::string>();
  run.key = json.at("key").get<std::string>();
  run.label = json.at("label").get<std::string>();
  run.settings = settings_of(json.at("settings"));
  run.inherited = settings_of(json.at("unset"));
  run.changes =
      json.contains("changes") ? settings_of(json.at("changes")) : changes_of_before(json);
  for (const Json& place : json.at("coordinates"))
    run.coordinates.push_back(whole_number<int>(place));
  run.frames = {whole_number<int>(json.at("first_frame")),
                whole_number<int>(json.at("last_frame"))};
  run.particles = json.at("particles").get<double>();
  run.memory = json.at("memory_bytes").get<double>();
  run.work = json.at("work").get<double>();
  const bool is_plain =
      !run.folder.empty() && std::all_of(run.folder.begin(), run.folder.end(),
                                         [](char c) { return c >= '0' && c <= '9'; });
  if (!is_plain) throw std::runtime_error("the folder of a run is not a number");
  return run;
}

/// Writes the run of the first seed, then those of further ones, which sweeps without seeds lack.
Json beginning_json(const Beginning& beginning) {
  Json json = {{"time", beginning.time},
               {"run", run_json(beginning.runs.front())},
               {"source", beginning.source}};
  for (std::size_t k = 1; k < beginning.runs.size(); ++k)
    json["further"].push_back(run_json(beginning.runs[k]));
  return json;
}

Beginning beginning_of(const Json& json) {
  Beginning beginning{
      json.at("time").get<double>(), {run_of(json.at("run"))}, json.value("source", "")};
  for (const Json& run : json.value("further", Json::array()))
    beginning.runs.push_back(run_of(run));
  return beginning;
}

Json variant_json(const Variant& variant) {
  Json json = {{"of", variant.of}, {"coarsen", variant.coarsening}};
  if (variant.failure.empty())
    json["run"] = run_json(variant.run);
  else
    json["failure"] = variant.failure;
  return json;
}

Variant variant_of(const Json& json) {
  Variant variant;
  variant.of = whole_number<std::size_t>(json.at("of"));
  variant.coarsening = json.at("coarsen").get<double>();
  if (json.contains("failure"))
    variant.failure = json.at("failure").get<std::string>();
  else
    variant.run = run_of(json.at("run"));
  return variant;
}

std::vector<std::string> axis_addresses(const read::Sweep& sweep) {
  std::vector<std::string> addresses;
  for (const read::Axis& axis : sweep.axes)
    for (const read::Axis::Parameter& parameter : axis.parameters)
      addresses.push_back(parameter.address);
  std::sort(addresses.begin(), addresses.end());
  return addresses;
}

/// Axis addresses of an earlier sweep; nothing if they are unknown.
std::optional<std::vector<std::string>> axis_addresses(const Manifest& manifest) {
  if (manifest.varied || manifest.axes.empty()) return manifest.varied;
  std::vector<std::string> addresses;
  for (const AxisLabels& axis : manifest.axes)
    addresses.insert(addresses.end(), axis.addresses.begin(), axis.addresses.end());
  std::sort(addresses.begin(), addresses.end());
  return addresses;
}

std::string axes_text(const std::vector<std::string>& addresses) {
  return addresses.empty() ? "only its [[run]]s" : joined(addresses, ", ");
}

/// Manifest of the folder; nothing if it cannot be read.
std::optional<Manifest> earlier_manifest(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(manifest_path(folder), error)) return std::nullopt;
  try {
    return read_manifest(folder);
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return std::nullopt;
  }
}

/// Says which kind of thing a path is instead of the folder of a sweep.
const char* why_no_sweep(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return "there is no such folder";
  if (!std::filesystem::is_directory(folder, error)) return "is a file, not the folder of a sweep";
  if (std::filesystem::exists(output::run_json_path(folder), error))
    return "is the folder of one run, not of a sweep";
  return "is a folder without a sweep in it";
}

void check(bool is_right, const char* what) {
  if (!is_right) throw std::runtime_error(what);
}

/// An amount of seconds, bytes or particles.
bool is_amount(double x) {
  return x >= 0 && x <= 1e18;
}

void check_run(const Manifest& m, const Run& run) {
  check(run.frames.first >= -output::max_frame && run.frames.first <= run.frames.last &&
            run.frames.last <= output::max_frame,
        "the frames of a run are invalid");
  check(is_amount(run.particles) && is_amount(run.memory) && is_amount(run.work),
        "the particles, memory or work of a run are invalid");
  if (!m.screened.empty())
    check(run.coordinates.empty() || run.coordinates.size() == m.screened.size(),
          "a run has no level on each axis");
  if (m.axes.empty() || run.coordinates.empty()) return;
  check(run.coordinates.size() == m.axes.size(), "a run has no place on each axis");
  for (std::size_t a = 0; a < m.axes.size(); ++a)
    check(run.coordinates[a] >= 0 && run.coordinates[a] < static_cast<int>(m.axes[a].values.size()),
          "a run is beyond the end of an axis");
}

/// Checks what is used as an index, a size or a path later; the file may be from anyone.
void check_values(const Manifest& m) {
  constexpr int largest_tile = 1 << 16;
  const auto is_side = [](int size) { return size > 0 && size <= largest_tile; };
  const auto is_axis = [&](int axis) {
    return axis >= -1 && axis < static_cast<int>(m.axes.size());
  };
  check(is_side(m.tile_width) && is_side(m.tile_height), "its tile size is invalid");
  check(m.fps > 0 && m.fps < max_fps, "its frames per second are invalid");
  check(std::abs(m.first_number) <= output::max_frame, "the number of its first frame is invalid");
  check(is_axis(m.columns) && is_axis(m.rows) && m.wrap >= 0, "its columns or rows name no axis");
  check(output::is_plain_name(m.view), "the name of its view is not a folder name");
  check(is_amount(m.timeout) && is_amount(m.memory), "its limits are invalid");
  check(is_amount(m.seconds_per_work), "its seconds per work are invalid");
  check(!m.runs.empty(), "it has no runs");
  check(m.seeds >= 1 && m.seeds <= read::max_seeds &&
            m.runs.size() % static_cast<std::size_t>(m.seeds) == 0,
        "its runs are not whole points");
  check(m.runs.size() <= std::size_t(read::max_runs), "it has too many runs");
  check(m.coarsening >= 1 && m.coarsening <= 1e6, "the cells of its runs are wrong");
  double places = 1;
  for (const AxisLabels& axis : m.axes) places *= static_cast<double>(axis.values.size());
  check(places >= 1 && places <= 10.0 * read::max_runs, "its axes have no or too many values");
  for (const AxisLabels& axis : m.screened)
    for (const double share : axis.shares)
      check(share >= 0 && share <= 1, "a level of a screening is beyond the ends of its axis");
  if (m.beginning) {
    check(is_amount(m.beginning->time), "its fork time is invalid");
    check(m.beginning->runs.size() <= static_cast<std::size_t>(m.seeds),
          "it has more beginnings than seeds");
    for (const Run& run : m.beginning->runs) check_run(m, run);
  }
  for (std::size_t k = 0; k < m.runs.size(); ++k) {
    const Run& run = m.runs[k];
    check(run.index == static_cast<int>(k), "its runs are not numbered in order");
    check_run(m, run);
  }
  // Copies of each point, and each run at full resolution.
  check(m.variants.size() <= 10 * std::size_t(read::max_runs), "it has too many variants");
  for (std::size_t k = 0; k < m.variants.size(); ++k) {
    const Variant& variant = m.variants[k];
    check(variant.of < m.runs.size() &&
              (variant.is_full() || variant.of % static_cast<std::size_t>(m.seeds) == 0),
          "a variant is of no point");
    check(variant.coarsening >= 1 && variant.coarsening <= 1e6, "the cells of a variant are wrong");
    if (!variant.failure.empty()) continue;
    check(variant.run.index == static_cast<int>(m.runs.size() + k),
          "its variants are not numbered in order");
    check_run(m, variant.run);
  }
}

}  // namespace

Json settings_json(const std::vector<scene::Override>& settings) {
  Json list = Json::array();
  for (const scene::Override& setting : settings) list.push_back({setting.address, setting.value});
  return list;
}

std::string run_text(const Run& run) {
  return run.folder == run_folder_name(run.index)
             ? fmt::format("run {}", run.index)
             : fmt::format("run {} (runs/{})", run.index, run.folder);
}

run::RenderOptions Beginning::fork_of(const Run& branch, const std::string& folder) const {
  run::RenderOptions options;
  options.scene = beginning_folder(folder, run_of(branch)).string();
  options.from = time;
  options.overrides = scene::texts_of(branch.changes);
  return options;
}

const Run* Manifest::run_of(int index) const {
  if (index < 0) return nullptr;
  const auto place = static_cast<std::size_t>(index);
  if (place < runs.size()) return &runs[place];
  if (place >= runs.size() + variants.size()) return nullptr;
  const Variant& variant = variants[place - runs.size()];
  return variant.failure.empty() ? &variant.run : nullptr;
}

int Manifest::last_index() const {
  return static_cast<int>(runs.size() + variants.size()) - 1;
}

std::vector<int> Manifest::with_variants(std::vector<int> indices) const {
  const auto point_of = [&](std::size_t run) { return run / static_cast<std::size_t>(seeds); };
  std::set<std::size_t> points;
  for (const int index : indices) points.insert(point_of(static_cast<std::size_t>(index)));
  for (const Variant& variant : variants)
    if (variant.is_full() || (variant.failure.empty() && points.contains(point_of(variant.of))))
      indices.push_back(variant.run.index);
  return indices;
}

double Manifest::coarsening_of(const Run& run) const {
  for (const Variant& variant : variants)
    if (&variant.run == &run) return variant.coarsening;
  return coarsening;
}

double Manifest::fps_of(const Run& run) const {
  const double own = finite_number(run.value("fps")).value_or(fps);
  return own > 0 && own < max_fps ? exact_rate(own) : fps;
}

bool Manifest::has_one_rate() const {
  return std::ranges::all_of(runs, [&](const Run& run) { return fps_of(run) == fps; });
}

int Manifest::first_frame() const {
  int first = runs.empty() ? 0 : runs.front().frames.first;
  for (const Run& run : runs) first = std::min(first, run.frames.first);
  return first;
}

int Manifest::last_frame() const {
  int last = first_frame();
  for (const Run& run : runs) last = std::max(last, run.frames.last);
  return last;
}

Manifest make_manifest(const plan::SweepPlan& plan, const std::vector<std::string>& keys,
                       const std::vector<std::string>& folders) {
  Manifest m;
  m.version = version;
  m.sources = build().sources;
  m.name = plan.sweep.name;
  m.title = plan.title;
  m.sweep_file = plan.sweep.file;
  m.scene_file = plan.sweep.scene_file;
  m.view = plan.view;
  m.tile_width = plan.base.size.width;
  m.tile_height = plan.base.size.height;
  m.fps = plan.base.fps;
  m.first_number = scene::number_of(plan.base, 0);
  m.columns = plan.columns;
  m.rows = plan.rows;
  m.wrap = plan.sweep.sheet.wrap;
  m.tile_label = scene::name(plan.sweep.sheet.label);
  m.timeout = plan.sweep.limits.timeout.seconds;
  m.memory = static_cast<double>(plan.sweep.limits.memory);
  m.seeds = plan.sweep.runs_per_point();
  m.parameters = plan::varied_parameters(plan);
  m.varied = axis_addresses(plan.sweep);
  if (plan.sweep.settings.method == read::Method::grid)
    for (const read::Axis& axis : plan.sweep.axes)
      m.axes.push_back(manifest_axis(axis, m.parameters));
  if (plan.sweep.settings.method == read::Method::morris)
    for (const read::Axis& axis : plan.sweep.axes) {
      m.screened.push_back(manifest_axis(axis, m.parameters));
      m.screened.back().values.clear();
      m.screened.back().shares = plan::level_shares(axis);
    }
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    Run& run = m.runs.emplace_back(plan.runs[k].run);
    run.folder = folders[k];
    run.key = keys[k];
    run.inherited = inherited_values(plan.runs[k], m.parameters);
  }
  for (std::size_t k = 0; k < plan.variants.size(); ++k) {
    const plan::PlannedVariant& planned = plan.variants[k];
    Variant& variant = m.variants.emplace_back();
    variant = {planned.item.run, planned.of, planned.coarsening, planned.failure};
    variant.run.key = keys[plan.runs.size() + k];
    variant.run.folder = folders[plan.runs.size() + k];
  }
  m.coarsening = plan.coarsening;
  m.coarsened = scene::coarsened_words(plan.base, plan.coarsening);
  if (m.coarsened.starts_with(", ")) m.coarsened.erase(0, 2);
  m.keeps_states = plan.keeps_states;
  m.have_tiles_legends = plan.have_tiles_legends;
  m.quality = plan.quality;
  m.fixed = plan.sweep.fixed;
  if (plan.fast) m.fixed.resize(m.fixed.size() - plan.fast->overrides.size());
  std::error_code error;
  if (!plan.source && std::filesystem::is_regular_file(m.scene_file, error))
    m.scene_hash = record::hash_of(scene::read_toml_file(m.scene_file));
  if (plan.beginnings.empty()) return m;
  m.beginning = {plan.fork, {}, plan.source ? plan.source->scene_file : ""};
  for (const plan::PlannedRun& item : plan.beginnings) {
    Run& run = m.beginning->runs.emplace_back(item.run);
    run.key = key_of_beginning(plan, item);
    run.folder = run_folder_name(run.index);
  }
  return m;
}

void check_folder(const plan::SweepPlan& plan) {
  const std::optional<Manifest> earlier = earlier_manifest(plan.folder);
  std::error_code error;
  if (!earlier && std::filesystem::is_regular_file(plan.folder / "run.json", error))
    throw UsageError(plan.folder.string(), "is the folder of a run",
                     "choose another folder with --out: a sweep has one of its own");
  if (!earlier) return;
  const std::optional<std::vector<std::string>> before = axis_addresses(*earlier);
  const std::vector<std::string> now = axis_addresses(plan.sweep);
  if (!before || *before == now) return;
  throw UsageError(
      plan.folder.string(),
      fmt::format("has a sweep of {}; this one varies {}", axes_text(*before), axes_text(now)),
      "choose another folder with --out, or remove the old one");
}

std::size_t outdated_runs(const std::filesystem::path& folder) {
  const std::optional<Manifest> earlier = earlier_manifest(folder);
  if (!earlier || earlier->sources == build().sources) return 0;
  return static_cast<std::size_t>(
      std::count_if(earlier->runs.begin(), earlier->runs.end(), [&](const Run& run) {
        const RunStatus status = read_status(runs_folder(folder) / run.folder);
        return status.key == run.key && is_finished(status.state);
      }));
}

void write_manifest(const std::filesystem::path& folder, const Manifest& m) {
  Json json;
  json["version"] = m.version;
  json["sources"] = m.sources;
  json["name"] = m.name;
  json["title"] = m.title;
  json["sweep_file"] = m.sweep_file;
  json["scene_file"] = m.scene_file;
  json["view"] = m.view;
  json["tile"] = {m.tile_width, m.tile_height};
  json["fps"] = m.fps;
  json["first_number"] = m.first_number;
  json["columns"] = m.columns;
  json["rows"] = m.rows;
  json["wrap"] = m.wrap;
  json["tile_label"] = m.tile_label;
  json["timeout"] = m.timeout;
  json["memory"] = m.memory;
  json["parameters"] = Json::array();
  for (const Parameter& p : m.parameters)
    json["parameters"].push_back(
        {{"address", p.address}, {"name", p.name}, {"unit", p.unit}, {"type", p.type}});
  json["axes"] = Json::array();
  for (const AxisLabels& axis : m.axes)
    json["axes"].push_back(
        {{"name", axis.name}, {"values", axis.values}, {"addresses", axis.addresses}});
  for (const AxisLabels& axis : m.screened)
    json["screened"].push_back(
        {{"name", axis.name}, {"addresses", axis.addresses}, {"shares", axis.shares}});
  if (m.varied) json["varied"] = *m.varied;
  if (m.beginning) json["beginning"] = beginning_json(*m.beginning);
  json["keeps_states"] = m.keeps_states;
  if (m.have_tiles_legends) json["tile_legends"] = true;
  json["quality"] = setup::name(m.quality);
  json["seconds_per_work"] = m.seconds_per_work;
  json["seeds"] = m.seeds;
  json["set"] = settings_json(m.fixed);
  json["scene_hash"] = m.scene_hash;
  json["runs"] = Json::array();
  for (const Run& run : m.runs) json["runs"].push_back(run_json(run));
  for (const Variant& variant : m.variants) json["variants"].push_back(variant_json(variant));
  if (m.coarsening > 1) json["coarsen"] = m.coarsening;
  if (!m.coarsened.empty()) json["coarsened"] = m.coarsened;
  output::write_file(manifest_path(folder), record::with_own_hash(json));
}

Manifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = manifest_path(folder);
  std::error_code error;
  if (!std::filesystem::exists(file, error) && !error)
    throw IoError(folder.string() + ": " + why_no_sweep(folder) +
                      "; expected the folder that neve sweep wrote, as out/snow_variations.cdb",
                  folder.string());
  return parse_manifest(output::read_json_bytes(file), file.string());
}

Manifest parse_manifest(std::span<const std::uint8_t> bytes, const std::string& file) {
  Json json;
  Manifest m;
  try {
    json = parse_json(bytes);
    m.version = json.at("version").get<std::string>();
    m.sources = json.value("sources", "");
    m.name = json.at("name").get<std::string>();
    m.title = json.at("title").get<std::string>();
    m.sweep_file = json.at("sweep_file").get<std::string>();
    m.scene_file = json.at("scene_file").get<std::string>();
    m.view = json.at("view").get<std::string>();
    m.tile_width = whole_number<int>(json.at("tile").at(0));
    m.tile_height = whole_number<int>(json.at("tile").at(1));
    m.fps = json.at("fps").get<double>();
    m.first_number = whole_number_or(json, "first_number", 0);
    m.columns = whole_number<int>(json.at("columns"));
    m.rows = whole_number<int>(json.at("rows"));
    m.wrap = whole_number<int>(json.at("wrap"));
    m.tile_label = json.at("tile_label").get<std::string>();
    m.timeout = json.at("timeout").get<double>();
    m.memory = json.at("memory").get<double>();
    for (const Json& p : json.at("parameters"))
      m.parameters.push_back({p.at("address").get<std::string>(), p.at("name").get<std::string>(),
                              p.at("unit").get<std::string>(), p.at("type").get<std::string>()});
    for (const Json& axis : json.at("axes"))
      m.axes.push_back({axis.at("name").get<std::string>(),
                        axis.at("values").get<std::vector<std::string>>(),
                        axis.value("addresses", std::vector<std::string>{})});
    for (const Json& axis : json.value("screened", Json::array()))
      m.screened.push_back({axis.at("name").get<std::string>(),
                            {},
                            axis.at("addresses").get<std::vector<std::string>>(),
                            axis.value("shares", std::vector<double>{})});
    if (json.contains("set")) m.fixed = settings_of(json.at("set"));
    m.scene_hash = json.value("scene_hash", "");
    if (json.contains("varied")) m.varied = json.at("varied").get<std::vector<std::string>>();
    for (const Json& run : json.at("runs")) m.runs.push_back(run_of(run));
    if (json.contains("beginning")) m.beginning = beginning_of(json.at("beginning"));
    for (const Json& variant : json.value("variants", Json::array()))
      m.variants.push_back(variant_of(variant));
    m.coarsening = json.value("coarsen", 1.0);
    m.coarsened = json.value("coarsened", "");
    m.seeds = whole_number_or(json, "seeds", 1);
    m.keeps_states = json.value("keeps_states", false);
    m.have_tiles_legends = json.value("tile_legends", false);
    m.quality = setup::quality_named(json.value("quality", setup::name(m.quality)));
    m.seconds_per_work = json.value("seconds_per_work", 0.0);
    check_values(m);
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    throw Error(exit_invalid_scene,
                fmt::format("{}: error: is not a list of runs: {}", file, error.what()), file,
                "run the sweep again to rewrite it; finished runs are kept");
  }
  if (!record::is_untouched(std::move(json)))
    throw Error(exit_check_failed, file + ": error: is not as neve sweep wrote it", file,
                "run the sweep again to rewrite it; finished runs are kept");
  return m;
}

}  // namespace neve::app::sweep::store
