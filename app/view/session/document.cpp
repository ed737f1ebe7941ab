#include "app/view/session/document.h"

#include <algorithm>
#include <filesystem>

#include "app/scene/coarsen.h"
#include "app/scene/flat.h"
#include "app/scene/names.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/toml_source.h"
#include "app/setup/coarse_run.h"
#include "app/setup/curves.h"
#include "app/setup/plan.h"
#include "app/setup/resolve.h"

namespace neve::app::view::session {

namespace {

constexpr std::size_t max_undos = 500;

std::vector<scene::Override>::iterator find(std::vector<scene::Override>& edits,
                                            const std::string& address) {
  return std::find_if(edits.begin(), edits.end(),
                      [&](const scene::Override& edit) { return edit.address == address; });
}

/// Takes the camera found by a coarse run into the current settings of the scene.
void place(const scene::CameraSettings& found, scene::CameraSettings& camera) {
  if (camera.eye && camera.target) return;
  camera.eye = found.eye;
  camera.target = found.target;
  // The keyframes of the move are found with the eye.
  if (camera.push_in) camera.keyframes = found.keyframes;
  camera.push_in = false;
}

void put_edit(std::vector<scene::Override>& edits, const std::string& address,
              const std::string& value) {
  if (const auto old = find(edits, address); old != edits.end())
    old->value = value;
  else
    edits.push_back({address, value});
}

/// Edits inside of an object that is put or removed as a whole end with it.
void forget_inside(std::vector<scene::Override>& edits, const std::string& object) {
  std::erase_if(
      edits, [&](const scene::Override& edit) { return edit.address.starts_with(object + "."); });
}

/// The numbers of a preset that differ from the scene's. They are remembered: a number can
/// change while a simulation runs, be taken back, and be made again with pictures.
void put_preset(const scene::Scene& scene, scene::Preset preset, const std::string& address,
                std::vector<scene::Override>& edits) {
  scene::Scene chosen = scene;
  for (sim::Material& material : chosen.materials)
    if (address == "material." + material.name + ".preset") scene::use_preset(material, preset);
  for (const scene::Difference& difference : scene::differences(scene, chosen))
    put_edit(edits, difference.address, scene::toml::toml_literal(*difference.after));
}

/// Preset of an existing material; the reader reports other errors.
std::optional<scene::Preset> preset_in(const scene::Override& edit, const scene::Scene& scene) {
  const auto is_meant = [&](const sim::Material& material) {
    return edit.address == "material." + material.name + ".preset";
  };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), is_meant)) return std::nullopt;
  const scene::toml::Value value = scene::value_of(edit, "choice");
  const auto* word = std::get_if<std::string>(&value.data);
  return word ? scene::value_named<scene::Preset>(*word) : std::nullopt;
}

/// Films of a scene that names no view show snow; who looks inside begins with particles, which are
/// drawn many times a second.
void add_built_in_views(scene::Scene& scene) {
  const scene::View& first = scene.views.front();
  const bool names_none = scene.views.size() == 1 && first.name == scene::first_view &&
                          first.layers == scene::find_view({}, first.name).layers;
  if (names_none) scene.views.insert(scene.views.begin(), scene::built_in_views().front());
  for (const scene::View& built_in : scene::built_in_views()) {
    const bool is_there =
        std::any_of(scene.views.begin(), scene.views.end(),
                    [&](const scene::View& view) { return view.name == built_in.name; });
    if (!is_there) scene.views.push_back(built_in);
  }
}

std::size_t particle_count(const scene::Scene& scene) {
  return static_cast<std::size_t>(std::clamp(setup::planned_particles(scene), 1.0, 1e9));
}

setup::Plan plan_of(const scene::Scene& scene) {
  return setup::make_plan(scene, {0, scene::last_frame(scene)}, setup::Quality::preview, 0);
}

/// @param present  the plan of the run that ends first: it holds some of the memory that is not
/// available any more
void require_room(const scene::Scene& scene, setup::Plan plan, const setup::Plan& present,
                  double coarsening) {
  setup::count_on(present.memory, scene, plan);
  setup::check_limits(scene, plan, coarsening);
}

}  // namespace

Effect effect_of(const std::string& address) {
  // It numbers the frames of a run in names, records and panels, which all say the same of a frame.
  if (address == "first_frame") return Effect::restart;
  if (scene::concern_of(address) == scene::Concern::pictures) return Effect::display;
  return scene::is_live(address) ? Effect::live : Effect::restart;
}

Document::Document(std::string file, std::string text, std::vector<scene::Override> overrides,
                   double coarsening, Source source, double coarsened)
    : file_(std::move(file)),
      text_(std::move(text)),
      overrides_(std::move(overrides)),
      coarsening_(coarsening),
      coarsened_(coarsened),
      source_(source) {
  scene_ = read(text_, {}, &set_by_coarsening_);
  setup::refuse_followers(*scene_, overrides_);
  scene::Scene placed = *scene_;
  setup::resolve(placed, particle_count(placed));
  camera_ = placed.camera;
  for (const scene::View& view : placed.views)
    if (view.camera) view_cameras_[view.name] = *view.camera;
  scene_ = std::make_shared<const scene::Scene>(std::move(placed));
}

std::vector<scene::Override> Document::with(const std::vector<scene::Override>& edits) const {
  std::vector<scene::Override> all = overrides_;
  all.insert(all.end(), edits.begin(), edits.end());
  return all;
}

std::shared_ptr<const scene::Scene> Document::read(
    const std::string& text, const std::vector<scene::Override>& edits,
    std::vector<std::string>* set_by_coarsening) const {
  scene::Scene scene = scene::read_scene_text(text, file_, scene::base_dir_of(file_), with(edits));
  scene::place_in_world(scene, file_);
  std::vector<std::string> set = scene::coarsen(scene, std::max(1.0, coarsening_));
  if (set_by_coarsening) *set_by_coarsening = std::move(set);
  add_built_in_views(scene);
  setup::reopen(scene, with(edits));
  if (camera_) {
    if (!scene.camera) scene.camera = camera_;
    place(*camera_, *scene.camera);
  }
  for (scene::View& view : scene.views)
    if (const auto found = view_cameras_.find(view.name); found != view_cameras_.end()) {
      if (!view.camera) view.camera = found->second;
      place(found->second, *view.camera);
    }
  setup::resolve_ranges(scene, particle_count(scene));
  return std::make_shared<const scene::Scene>(std::move(scene));
}

void Document::become(std::vector<scene::Override> edits) {
  scene_ = read(text_, edits, &set_by_coarsening_);  // throws before anything has changed
  edits_ = std::move(edits);
}

void Document::require_within_limits(const scene::Scene& next) const {
  const setup::Plan before = plan_of(*scene_), plan = plan_of(next);
  const bool needs_more = plan.memory > before.memory || plan.particles > before.particles ||
                          plan.largest_picture > before.largest_picture;
  if (needs_more) require_room(next, plan, before, coarsening_);
}

void Document::require_room_for(const Document& next) const {
  require_room(*next.scene(), plan_of(*next.scene()), plan_of(*scene_), next.coarsening());
}

/// An object that only the edits added leaves no trace when it is removed.
void Document::put_object(std::vector<scene::Override>& edits, const std::string& address,
                          const std::string& value) const {
  forget_inside(edits, address);
  const std::optional<std::string> given = in_file(address);
  const bool is_given = given && *given != "none";
  const auto edit = find(edits, address);
  if (value == "none" && !is_given && edit != edits.end())
    edits.erase(edit);
  else
    put_edit(edits, address, value);
}

void Document::set(const std::string& address, const std::string& value, std::uint64_t gesture) {
  std::vector<scene::Override> edits = edits_;
  if (const std::optional<scene::Preset> preset = preset_in({address, value}, *scene_))
    put_preset(*scene_, *preset, address, edits);
  else if (scene::is_object_address(address))
    put_object(edits, address, value);
  else
    put_edit(edits, address, value);
  const std::vector<scene::Override> before = edits_;
  std::shared_ptr<const scene::Scene> next = read(text_, edits);
  require_within_limits(*next);
  scene_ = std::move(next);
  edits_ = std::move(edits);
  if (gesture == 0 || gesture != gesture_) done_.push_back(before);
  if (done_.size() > max_undos) done_.erase(done_.begin());
  gesture_ = gesture;
  undone_.clear();
}

void Document::forget(const std::string& address) {
  std::vector<scene::Override> edits = edits_;
  const std::vector<std::string> numbers = scene::is_preset_address(address)
                                               ? scene::addresses_set_by(address)
                                               : std::vector<std::string>{};
  std::erase_if(edits, [&](const scene::Override& edit) {
    return std::find(numbers.begin(), numbers.end(), edit.address) != numbers.end() ||
           address.empty() || edit.address == address ||
           (scene::is_object_address(address) && edit.address.starts_with(address + ".")) ||
           (address.ends_with('.') && edit.address.starts_with(address));
  });
  if (edits.size() == edits_.size()) return;
  const std::vector<scene::Override> before = edits_;
  become(std::move(edits));
  done_.push_back(before);
  gesture_ = 0;
  undone_.clear();
}

/// Becomes the newest of one list, and puts what it was into the other.
std::string Document::step(std::vector<std::vector<scene::Override>>& from,
                           std::vector<std::vector<scene::Override>>& to) {
  if (from.empty()) return {};
  const std::vector<scene::Override> before = edits_;
  become(from.back());
  from.pop_back();
  to.push_back(before);
  gesture_ = 0;
  const std::vector<std::string> changed = difference(before, edits_);
  return changed.empty() ? std::string() : changed.front();
}

std::string Document::undo() {
  return step(done_, undone_);
}

std::string Document::redo() {
  return step(undone_, done_);
}

std::vector<ChangedValue> Document::changes() const {
  std::vector<ChangedValue> changes;
  for (const scene::Override& edit : edits_)
    changes.push_back({edit.address, edit.value, in_file(edit.address).value_or("")});
  return changes;
}

bool Document::is_changed(const std::string& address) const {
  return std::any_of(edits_.begin(), edits_.end(),
                     [&](const scene::Override& edit) { return edit.address == address; });
}

std::vector<std::string> Document::difference(const std::vector<scene::Override>& before,
                                              const std::vector<scene::Override>& after) {
  std::map<std::string, std::string> old_values, new_values;
  for (const scene::Override& edit : before) old_values[edit.address] = edit.value;
  for (const scene::Override& edit : after) new_values[edit.address] = edit.value;
  std::vector<std::string> changed;
  for (const auto& [address, value] : old_values)
    if (const auto now = new_values.find(address); now == new_values.end() || now->second != value)
      changed.push_back(address);
  for (const auto& [address, value] : new_values)
    if (!old_values.contains(address)) changed.push_back(address);
  return changed;
}

/// The value of a number that a preset in the file or of the command line sets.
std::optional<std::string> Document::in_preset(const scene::toml::Table& root,
                                               const std::string& address) const {
  if (!address.starts_with("material.")) return std::nullopt;
  const std::string preset = address.substr(0, address.rfind('.')) + ".preset";
  const bool is_set = std::any_of(overrides_.begin(), overrides_.end(),
                                  [&](const scene::Override& o) { return o.address == preset; });
  if (!is_set && !scene::value_at(root, preset)) return std::nullopt;
  for (const scene::FlatParam& param : scene::flatten(*read(text_, {})))
    if (param.address == address) return param.text();
  return std::nullopt;
}

std::optional<std::string> Document::in_file(const std::string& address) const {
  const auto given = std::find_if(overrides_.rbegin(), overrides_.rend(),
                                  [&](const scene::Override& o) { return o.address == address; });
  if (given != overrides_.rend()) return given->value;
  const scene::toml::Table root = scene::toml::parse_toml(text_, file_);
  const scene::toml::Value* value = scene::value_at(root, address);
  if (const auto number = in_preset(root, address)) return number;
  return value ? std::optional(scene::toml::toml_literal(*value)) : std::nullopt;
}

std::optional<std::string> Document::default_of(const std::string& address) const {
  const std::optional<scene::ParamInfo> info = scene::param_at(address);
  if (!info || !info->default_value || info->valid.is_required) return std::nullopt;
  return scene::toml::toml_literal(*info->default_value);
}

void Document::reload(std::string text) {
  // The automatic cameras are of the new text, too.
  Document fresh(file_, std::move(text), overrides_, coarsening_, source_, coarsened_);
  fresh.become(edits_);
  fresh.done_ = std::move(done_);
  fresh.undone_ = std::move(undone_);
  *this = std::move(fresh);
}

}  // namespace neve::app::view::session
