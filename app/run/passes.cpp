#include "app/run/passes.h"

#include <algorithm>
#include <array>

#include "app/advice/suggest.h"
#include "app/exports/columns.h"
#include "app/picture/attributes.h"
#include "app/scene/burn_in.h"
#include "app/scene/check.h"
#include "app/scene/names.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

using render::channels::Pass;
using render::channels::PointNumbers;

constexpr std::array pass_names{
    scene::Name{Pass::depth, "depth"},       scene::Name{Pass::position, "position"},
    scene::Name{Pass::normal, "normal"},     scene::Name{Pass::albedo, "albedo"},
    scene::Name{Pass::direct, "direct"},     scene::Name{Pass::indirect, "indirect"},
    scene::Name{Pass::emission, "emission"}, scene::Name{Pass::shadow, "shadow"},
    scene::Name{Pass::motion, "motion"},     scene::Name{Pass::id, "id"},
    scene::Name{Pass::body, "body"},         scene::Name{Pass::collider, "collider"}};

std::optional<Pass> pass_named(const std::string& text) {
  for (const auto& name : pass_names)
    if (name.text == text) return name.value;
  return std::nullopt;
}

/// Finds a value that colours show, other than snow.
std::optional<scene::ColorBy> value_named(const std::string& text) {
  const auto value = scene::value_named<scene::ColorBy>(text);
  return value == scene::ColorBy::snow ? std::nullopt : value;
}

std::vector<std::string> known_names() {
  std::vector<std::string> known{"all"};
  const auto add = [&](const std::string& name) {
    if (name != "snow" && std::ranges::find(known, name) == known.end()) known.push_back(name);
  };
  for (const auto& name : pass_names) add(name.text);
  for (const auto& name : scene::names(scene::ColorBy{})) add(name.text);
  for (const auto& name : scene::names(scene::ExportAttribute{})) add(name.text);
  return known;
}

/// "XYZ" for vectors, "xx" to "zz" for tensors.
std::vector<std::string> channels_of(int components) {
  if (components == 1) return {"Y"};
  if (components == 3) return {"X", "Y", "Z"};
  std::vector<std::string> names;
  for (const char a : {'x', 'y', 'z'})
    for (const char b : {'x', 'y', 'z'}) names.push_back({a, b});
  return names;
}

PointNumbers numbers_of(const exports::Column& column) {
  PointNumbers numbers{column.name, channels_of(column.components), {}};
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) numbers.value.push_back(static_cast<float>(value));
      },
      column.numbers);
  return numbers;
}

/// "0 ball\n1 cloud"
std::string numbered(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k > 0 ? "\n" : "") + std::to_string(k) + " " + names[k];
  return text;
}

}  // namespace

std::vector<std::string> parse_passes(const std::string& text) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    const std::string name = text.substr(begin, end == std::string::npos ? end : end - begin);
    if (name == "all")
      for (const auto& each : pass_names) add(each.text);
    else
      add(name);
  }
  pass_list(names);
  return names;
}

PassList pass_list(const std::vector<std::string>& names) {
  PassList list;
  for (const std::string& name : names) {
    if (const auto pass = pass_named(name))
      list.passes.insert(*pass);
    else if (const auto value = value_named(name))
      list.values.push_back(*value);
    else if (const auto attribute = scene::value_named<scene::ExportAttribute>(name))
      list.attributes.push_back(*attribute);
    else
      throw UsageError("--passes", "unknown pass \"" + name + "\"",
                       advice::suggest_one_of(name, {"pass", known_names()}));
  }
  return list;
}

std::vector<std::string> passes_of(const scene::Scene& scene, std::vector<std::string> names) {
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  if (!scene::mixes_emitters(scene) || !(has("body") || has("age"))) return names;
  const bool has_all =
      std::ranges::all_of(pass_names, [&](const auto& each) { return has(each.text); });
  if (!has_all || has("age"))
    throw UsageError("--passes", scene::mixed_emitters, "omit body and age, or use one emitter");
  std::erase(names, "body");
  return names;
}

double bytes_of_pixel(const PassList& list) {
  // Single precision is 4 bytes, half floats are 2; tensors have nine numbers.
  double bytes = 8;
  for (const Pass pass : list.passes)
    bytes += pass == Pass::motion ? 16 : pass == Pass::position ? 12 : pass >= Pass::id ? 4 : 6;
  return bytes + 4 * static_cast<double>(list.values.size()) +
         36 * static_cast<double>(list.attributes.size());
}

std::vector<scene::View> views_for(const PassList& list) {
  std::vector<scene::View> views;
  for (const scene::ColorBy value : list.values) {
    scene::View view;
    view.layers = {scene::Layer::particles};
    view.particles.color_by = value;
    views.push_back(view);
  }
  return views;
}

PassReader::PassReader(const scene::Scene& scene, const setup::SeededScene& seeded, PassList list)
    : scene_(scene),
      list_(std::move(list)),
      origins_(scene, seeded.body_end),
      carried_(scene, seeded.body_end) {}

std::vector<PointNumbers> PassReader::read(const picture::Snapshot& snapshot,
                                           const sim::Simulation& simulation) const {
  std::vector<PointNumbers> all;
  for (const scene::ColorBy value : list_.values) {
    PointNumbers numbers{scene::name(value), {"Y"}, {}};
    for (const double number : picture::attribute_values(scene_, value, snapshot))
      numbers.value.push_back(static_cast<float>(number));
    all.push_back(std::move(numbers));
  }
  if (list_.attributes.empty()) return all;
  scene::Export spec;
  spec.format = scene::ExportFormat::npz;
  spec.attributes = list_.attributes;
  const auto state = exports::read_state({&spec, 1}, origins_, scene_.colliders, simulation);
  const exports::Table table = exports::make_table(scene_, spec, origins_, carried_, *state);
  for (const scene::ExportAttribute attribute : list_.attributes)
    all.push_back(numbers_of(*table.find(attribute)));
  return all;
}

render::channels::Request PassReader::request(const picture::MotionSource& source,
                                              const render::Frame& frame,
                                              const std::vector<PointNumbers>& numbers) const {
  render::channels::Request request;
  request.passes = list_.passes;
  const double interval = 1 / scene_.fps;
  request.interval = static_cast<float>(interval);
  request.velocity = picture::velocities(source, frame.points.id);
  request.before = picture::camera_after(source, -interval);
  request.after = picture::camera_after(source, interval);
  request.meshes = picture::moving_meshes(source, interval);
  request.grounds = picture::moving_grounds(source, interval);
  for (const PointNumbers& of_all : numbers) {
    PointNumbers& some =
        request.numbers.emplace_back(PointNumbers{of_all.name, of_all.channels, {}});
    some.value.reserve(frame.points.id.size() * of_all.channels.size());
  }
  for (const std::uint32_t id : frame.points.id) {
    request.body.push_back(origins_.body_of(id));
    // Every point of the frame is a particle of the snapshot.
    const std::size_t row = source.snapshot.particles.index_of(id).value();
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const std::size_t count = numbers[k].channels.size();
      const auto first = numbers[k].value.begin() + static_cast<std::ptrdiff_t>(row * count);
      request.numbers[k].value.insert(request.numbers[k].value.end(), first,
                                      first + static_cast<std::ptrdiff_t>(count));
    }
  }
  return request;
}

render::ExrHeader PassReader::header(const record::PictureRecord& record,
                                     const render::Frame& frame) const {
  render::ExrHeader header = render::channels::camera_header(frame);
  header.text = record::to_png_text(record);
  header.fps = scene_.fps;
  constexpr double fastest = 30;  // frames a second that the attribute has digits for
  if (!scene_.shot.time_code.empty() && scene_.fps <= fastest)
    header.time_code = scene::time_code_of(scene_, record.frame, scene_.fps);
  header.text["neve:time"] =
      scene::toml::number_text(scene::frame_of(scene_, record.frame) / scene_.fps);
  header.text["neve:bodies"] = numbered(scene::snow_sources(scene_));
  std::vector<std::string> colliders;
  for (const scene::Collider& collider : scene_.colliders) colliders.push_back(collider.name);
  header.text["neve:colliders"] = numbered(colliders);
  header.text["comments"] = "Frame " + std::to_string(record.frame) + " of view " + record.view +
                            ", made by neve " + record.version +
                            "; \"neve render THIS_FILE\" makes it again.";
  return header;
}

}  // namespace neve::app::run
