#include "app/sweep/read/read_sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/options/languages.h"
#include "app/scene/lister.h"
#include "app/scene/read.h"
#include "app/scene/reader.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/sweep/read/describe_sweep.h"
#include "app/sweep/read/read_axis.h"
#include "app/sweep/read/sweep_leaf.h"

namespace neve::app::sweep::read {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_sweep_values = 100'000;  ///< of all axes of a sweep

/// Takes a key that is no address out of a table of addresses.
std::optional<scene::toml::Value> take(scene::toml::Table& table, const char* key) {
  const scene::toml::Entry* entry = table.find(key);
  if (!entry) return std::nullopt;
  scene::toml::Value value = entry->value;
  std::erase_if(table.entries, [&](const scene::toml::Entry& e) { return e.key == key; });
  return value;
}

class SweepReader {
 public:
  explicit SweepReader(const std::string& file)
      : reading_{{file, scene::base_dir_of(file), {}}, {}, true, true} {}

  Sweep read(const scene::toml::Table& root) {
    SweepFile file;
    scene::Reader(reading_, root, "").read([&](auto& visit) { describe(visit, file); });
    Sweep sweep;
    sweep.file = source().file;
    sweep.settings = file.sweep;
    sweep.limits = file.limits;
    sweep.sheet = file.sheet;
    sweep.scene_file = scene_file(file.sweep.scene);
    for (const scene::toml::Entry& entry : addresses_in(file.set, false))
      sweep.fixed.push_back(setting_of(source(), entry));
    for (const scene::toml::Entry& entry : addresses_in(file.axis, true))
      sweep.axes.push_back({{counted_axis(entry)}, {}});
    for (const scene::toml::Table& table : file.links) sweep.axes.push_back(link(table));
    for (const scene::toml::Table& table : file.runs) sweep.rows.push_back(run(table));
    // The axes are in the order of the file, links among the others.
    std::stable_sort(sweep.axes.begin(), sweep.axes.end(), [](const Axis& a, const Axis& b) {
      const scene::toml::Location x = a.parameters.front().values.front().key,
                                  y = b.parameters.front().values.front().key;
      return x.line != y.line ? x.line < y.line : x.column < y.column;
    });
    check_frames(file.sweep.frames);
    check_method(sweep);
    sweep.places = reading_.places;
    return sweep;
  }

 private:
  const scene::Source& source() const { return reading_.source; }

  std::string scene_file(const std::string& name) const {
    const scene::toml::Location where = reading_.place_of("sweep.scene");
    if (name.empty())
      source().fail(where, "sweep.scene is missing",
                    "name the scene to vary, relative to this file");
    const fs::path file = (fs::path(source().base_dir) / name).lexically_normal();
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      source().fail(where, "sweep.scene = " + scene::toml::toml_string(name),
                    "no such file; looked for " + fs::absolute(file, error).string());
    return file.string();
  }

  void check_frames(const std::string& frames) const {
    if (frames.empty()) return;
    try {
      options::frames().read("--frames", frames);
    } catch (const UsageError& error) {
      source().fail(reading_.place_of("sweep.frames"), "sweep.frames: " + error.message,
                    error.hint);
    }
  }

  std::string label_of(const scene::toml::Value& value, const std::string& address) const {
    const scene::Valid any;
    std::string label;
    scene::read_leaf(scene::Leaf{source(), value, address, "", any}, label);
    return label;
  }

  /// Counts before all values of all axes are made: a few bytes of a file can ask for any number.
  Axis::Parameter counted_axis(const scene::toml::Entry& entry) {
    Axis::Parameter parameter = read_axis(source(), entry);
    values_ += parameter.values.size();
    if (values_ > max_sweep_values)
      throw LimitError(fmt::format("{}:{}:{}: error: refused: the axes up to {} have {} values "
                                   "together; at most {} are allowed",
                                   source().file, entry.where.line, entry.where.column, entry.key,
                                   values_, max_sweep_values),
                       entry.key, "make num smaller, or draw samples with method = \"lhs\"");
    return parameter;
  }

  Axis link(scene::toml::Table table) {
    Axis axis;
    const std::optional<scene::toml::Value> labels = take(table, "labels");
    if (labels) {
      const scene::Valid any;
      scene::read_leaf(scene::Leaf{source(), *labels, "link.labels", "", any}, axis.value_labels);
    }
    for (const scene::toml::Entry& entry : addresses_in(table, true)) {
      axis.parameters.push_back(counted_axis(entry));
      const Axis::Parameter &first = axis.parameters.front(), &last = axis.parameters.back();
      if (last.drawn)
        source().fail(entry.value.where, entry.key + " is drawn, but linked axes move together",
                      "give it values");
      if (last.values.size() != first.values.size())
        source().fail(entry.value.where,
                      fmt::format("{} has {} values, and {} of the same [[link]] has {}", entry.key,
                                  last.values.size(), first.address, first.values.size()),
                      "linked axes must have the same number");
    }
    if (axis.parameters.empty()) source().fail(reading_.place_of("link"), "a [[link]] has no axes");
    if (labels && axis.value_labels.size() != axis.size())
      source().fail(
          labels->where,
          fmt::format("labels has {} names for {} values", axis.value_labels.size(), axis.size()),
          "give each value a name");
    return axis;
  }

  Run run(scene::toml::Table table) const {
    Run row;
    if (const std::optional<scene::toml::Value> label = take(table, "label"))
      row.label = label_of(*label, "run.label");
    for (const scene::toml::Entry& entry : addresses_in(table, false))
      row.settings.push_back(setting_of(source(), entry));
    return row;
  }

  void check_method(const Sweep& sweep) const {
    const Method method = sweep.settings.method;
    const scene::toml::Location where = reading_.place_of("sweep.method");
    const std::string name = scene::toml::toml_string(scene::name(method));
    if (draws(method) && sweep.settings.samples == 0)
      source().fail(where, "method " + name + " needs samples",
                    method == Method::morris ? "give the number of trajectories, as in samples = 10"
                                             : "give the number of runs to draw");
    if (!draws(method) && sweep.settings.samples > 0)
      source().fail(reading_.place_of("sweep.samples"), "samples are not for method " + name,
                    "expected method \"random\", \"lhs\", \"sobol\" or \"morris\"");
    if (method == Method::lhs && !sweep.settings.where.empty())
      source().fail(reading_.place_of("sweep.where"), "where would leave parts of an axis empty",
                    "expected method \"sobol\" or \"random\", which draw others instead");
    if (method == Method::list && sweep.rows.empty())
      source().fail(where, "method \"list\" needs at least one [[run]]");
    for (const Axis& axis : sweep.axes) check_axis(axis, sweep);
    check_labels(sweep, where);
  }

  /// Two tiles of one name cannot be told apart.
  void check_labels(const Sweep& sweep, scene::toml::Location where) const {
    std::set<std::string> taken;
    for (const Run& row : sweep.rows)
      if (!row.label.empty() && !taken.insert(row.label).second)
        source().fail(where, "two [[run]]s have the label " + scene::toml::toml_string(row.label),
                      "labels tell tiles apart: change one of them");
  }

  void check_axis(const Axis& axis, const Sweep& sweep) const {
    const Method method = sweep.settings.method;
    const scene::Override& first = axis.parameters.front().values.front();
    if (method == Method::list)
      source().fail(first.key, "method \"list\" has no axes, only [[run]]s",
                    "use method \"grid\" or \"zip\"");
    if (axis.parameters.front().drawn && !draws(method))
      source().fail(first.place, axis.parameters.front().address + " is drawn",
                    "that needs method \"random\", \"lhs\", \"sobol\" or \"morris\"");
    const Axis& other = sweep.axes.front();
    if (method == Method::zip && axis.size() != other.size())
      source().fail(
          first.place,
          fmt::format("{} has {} values, and {} has {}", axis.parameters.front().address,
                      axis.size(), other.parameters.front().address, other.size()),
          "method \"zip\" needs the same number on all axes, \"grid\" makes all combinations");
  }

  scene::Reading reading_;
  std::size_t values_ = 0;  ///< of all axes so far
};

/// Puts an axis of the command line in the place of one of the same address, or behind them.
void put_axis(Sweep& sweep, const Axis::Parameter& parameter) {
  for (Axis& axis : sweep.axes)
    for (Axis::Parameter& other : axis.parameters) {
      if (other.address != parameter.address) continue;
      if (axis.parameters.size() > 1)
        parameter.values.front().fail({}, "this axis is part of a [[link]]",
                                      "change it in " + sweep.file);
      axis = Axis{{parameter}, {}};
      return;
    }
  sweep.axes.push_back({{parameter}, {}});
}

std::vector<const scene::Override*> varied(const Sweep& sweep) {
  std::vector<const scene::Override*> settings;
  for (const Axis& axis : sweep.axes)
    for (const Axis::Parameter& parameter : axis.parameters)
      settings.push_back(&parameter.values.front());
  return settings;
}

/// Axes of the command line; each may be given once.
std::vector<Axis::Parameter> parse_axes(const std::vector<std::string>& arguments) {
  std::vector<Axis::Parameter> axes;
  for (const std::string& argument : arguments) {
    Axis::Parameter axis = parse_axis(argument);
    for (const Axis::Parameter& other : axes)
      if (other.address == axis.address)
        throw UsageError(
            "-p " + argument, axis.address + " is given twice",
            fmt::format("write all its values into one list, as in -p {}=A,B,C", axis.address));
    axes.push_back(std::move(axis));
  }
  return axes;
}

/// An address that is an axis may be nothing else; of runs that part during the run, it may have a
/// value until then.
void refuse_duplicates(const Sweep& sweep, bool is_forked) {
  const std::vector<const scene::Override*> settings = varied(sweep);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j)
      if (settings[j]->address == settings[k]->address)
        settings[k]->fail(settings[k]->key, settings[k]->address + " is an axis twice");
    for (const scene::Override& fixed : sweep.fixed)
      if (fixed.address == settings[k]->address && !is_forked)
        fixed.fail(fixed.key, fixed.address + " is varied by the sweep",
                   "remove it from the axes, or change the axis with -p");
  }
}

/// A frame of a sheet is the same frame of all runs.
void refuse_other_numbers(const Sweep& sweep) {
  const auto check = [](const scene::Override& setting) {
    if (setting.address == "first_frame" || setting.address == "handles")
      setting.fail(
          setting.key,
          setting.address + " numbers the frames: a sheet shows the same frame of all runs",
          "--set " + setting.address + "=... sets it for all of them");
  };
  for (const scene::Override* setting : varied(sweep)) check(*setting);
  for (const Run& row : sweep.rows)
    for (const scene::Override& setting : row.settings) check(setting);
}

/// Seeds are of all runs.
void refuse_other_draws(const Sweep& sweep) {
  const std::string number = std::to_string(sweep.settings.seeds);
  for (const scene::Override* setting : varied(sweep))
    if (setting->address == "seed")
      setting->fail(setting->key, "the sweep varies seed, and seeds = " + number + " does so too",
                    "remove the axis: each point has " + number + " seeds without it");
  for (const Run& row : sweep.rows)
    for (const scene::Override& setting : row.settings)
      if (setting.address == "seed")
        setting.fail(setting.key,
                     "a run has a seed of its own, and seeds = " + number + " gives each run " +
                         number + " of them",
                     "remove seed from the run, or remove seeds");
}

}  // namespace

void Sweep::fail(const std::string& key, const std::string& message,
                 const std::string& hint) const {
  const auto found = places.find(key);
  if (found == places.end()) throw UsageError(key, message, hint);
  throw scene::toml::SceneError(file, found->second.line, found->second.column, message, hint);
}

Sweep read_sweep(const std::string& file, const SweepChanges& changes) {
  return parse_sweep(scene::read_toml_file(file), file, changes);
}

Sweep parse_sweep(const std::string& text, const std::string& file, const SweepChanges& changes) {
  const scene::toml::Table root = scene::toml::parse_toml(text, file);
  Sweep sweep;
  const bool is_sweep = root.find("sweep") != nullptr;
  for (const char* key : {"axis", "link", "run"})
    if (const scene::toml::Entry* part = root.find(key); part && !is_sweep)
      throw scene::toml::SceneError(file, part->where.line, part->where.column,
                                    std::string("there is ") + key + " but no [sweep]",
                                    "a sweep file begins with [sweep] and scene = \"FILE.toml\"");
  if (is_sweep) {
    sweep = SweepReader(file).read(root);
  } else {
    sweep.scene_file = file;
  }
  sweep.name = scene::name_of_scene(file);
  for (const Axis::Parameter& axis : parse_axes(changes.axes)) put_axis(sweep, axis);
  for (const std::string& argument : changes.sets)
    sweep.fixed.push_back(scene::parse_override(argument));
  if (changes.seeds > 0) sweep.settings.seeds = changes.seeds;
  refuse_duplicates(sweep, changes.is_forked || !sweep.settings.fork.empty());
  refuse_other_numbers(sweep);
  if (sweep.settings.seeds > 0) refuse_other_draws(sweep);
  if (!is_sweep && sweep.axes.empty())
    throw UsageError("", file + " is a scene, and no parameter varies",
                     "add -p ADDRESS=LIST, as in -p material.snow.hardening=5,10,20, or give a "
                     "file with [sweep]");
  if (sweep.axes.empty() && sweep.rows.empty())
    throw scene::toml::SceneError(file, 1, 1, "the sweep has no axes and no runs",
                                  "write [axis] or [[run]], or add -p ADDRESS=LIST");
  return sweep;
}

std::vector<std::string> repeated_values(const Sweep& sweep) {
  std::vector<std::string> repeated;
  if (sweep.settings.method != Method::grid) return repeated;
  const auto is_same = [](const std::string& a, const std::string& b) {
    char *end_a = nullptr, *end_b = nullptr;
    const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
    return a == b || (*end_a == 0 && *end_b == 0 && x == y);
  };
  for (const Axis& axis : sweep.axes) {
    if (axis.parameters.size() > 1) continue;  // linked: the others may differ
    const std::vector<scene::Override>& values = axis.parameters.front().values;
    for (std::size_t k = 0; k < values.size(); ++k)
      for (std::size_t j = 0; j < k; ++j)
        if (is_same(values[j].value, values[k].value)) {
          repeated.push_back(values[k].address + " = " + values[k].value);
          break;
        }
  }
  return repeated;
}

std::vector<scene::ParamInfo> sweep_params() {
  std::vector<scene::ParamInfo> list;
  scene::Lister lister(list, "");
  SweepFile file;
  describe(lister, file);
  scene::Lister rules(list, "axis.ADDRESS.");
  AxisRule spec;
  describe(rules, spec);
  return list;
}

}  // namespace neve::app::sweep::read
