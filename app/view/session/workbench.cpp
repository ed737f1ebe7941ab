#include "app/view/session/workbench.h"

#include <algorithm>
#include <system_error>

#include "app/forecast/fast.h"
#include "app/output/atomic_file.h"
#include "app/record/picture_files.h"
#include "app/record/run_json.h"
#include "app/scene/edit_text.h"
#include "app/scene/flat.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_source.h"
#include "app/setup/curves.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/sweep/plan/around.h"
#include "app/timeline/origin.h"
#include "app/view/session/export.h"

namespace neve::app::view::session {

namespace {

using Edits = std::vector<scene::Override>;

constexpr std::size_t max_messages = 100;

std::string text_of(const std::exception& error) {
  if (const auto* usage = dynamic_cast<const UsageError*>(&error))
    return usage->message + (usage->hint.empty() ? "" : "; " + usage->hint);
  return error.what();
}

void put(std::vector<scene::Override>& edits, const std::string& address,
         const std::vector<scene::Override>& from) {
  std::erase_if(edits, [&](const scene::Override& edit) { return edit.address == address; });
  for (const scene::Override& edit : from)
    if (edit.address == address) edits.push_back(edit);
}

std::filesystem::file_time_type time_of(const std::string& file) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file, error);
  return error ? std::filesystem::file_time_type{} : time;
}

/// Opens a run at its newest moment, as a session has it in which its changes were made. Without
/// one it starts again, and makes its changes at their steps.
Opened open_run(const std::string& folder, const timeline::Edits& edits) {
  const timeline::Origin origin = timeline::Origin::of(folder, edits);
  const std::string beside =
      origin.scene_file.substr(0, folder.find_last_not_of('/') + 1) + ".toml";
  Opened opened{Document(beside, scene::text_with_all_views(origin.scene), {}, 1, Source::no_file,
                         origin.coarsening),
                origin.overrides};
  timeline::Moments moments;
  moments.add_run(origin.run);
  Past past{origin.run, origin.changes, origin.run_frames, moments.find_newest(origin.scene.fps)};
  if (past.newest)
    scene::forget_changes_after(past.changes, past.newest->steps);
  else
    past.frames.clear();
  for (const scene::LiveChange& change : past.changes)
    opened.document.set(change.address, change.value);
  opened.past = std::move(past);
  return opened;
}

}  // namespace

Opened open_document(const std::string& file, const std::vector<std::string>& overrides,
                     double coarsening, timeline::Agreement agreement) {
  if (timeline::is_folder(file)) {
    timeline::Edits edits{overrides};
    if (coarsening > 1) edits.coarsening = coarsening;
    return open_run(file, edits);
  }
  std::vector<scene::Override> parsed = scene::parse_overrides(overrides);
  if (file.empty()) {
    const std::string shipped = default_scene().string();
    return {Document(shipped, scene::read_toml_file(shipped), std::move(parsed), coarsening,
                     Source::shipped_file),
            overrides};
  }
  if (!record::is_picture(file))
    return {Document(file, scene::read_toml_file(file), std::move(parsed), coarsening,
                     scene::is_lasting_file(file) ? Source::own_file : Source::no_file),
            overrides};
  // The picture holds the scene as it was drawn: coarsened already.
  const std::string beside = std::filesystem::path(file).replace_extension(".toml").string();
  timeline::Edits edits{overrides};
  if (coarsening > 1) edits.coarsening = coarsening;
  edits.agreement = agreement;
  edits.is_start_only = true;
  const timeline::Origin origin = timeline::Origin::of(file, edits);
  const record::PictureRecord& picture = *origin.picture;
  std::vector<std::string> all = picture.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return {Document(beside, picture.scene, std::move(parsed), coarsening, Source::no_file,
                   picture.coarsening),
          std::move(all)};
}

Workbench::Workbench(Document document, WorkbenchOptions options, std::function<void()> wake)
    : document_(std::move(document)),
      options_(std::move(options)),
      starts_{{0, document_, {}, options_.session.past ? document_.edits() : Edits{}}},
      file_time_(time_of(document_.file())),
      sweep_(options_.program.empty() ? this_program() : options_.program),
      // A run starts without the changes that were made later, which are edits of its document.
      session_(std::make_unique<Session>(
          options_.session.past ? document_.scene_with({}) : document_.scene(), session_options(),
          std::move(wake))) {
  options_.folder = without_slash(options_.folder);
}

SessionOptions Workbench::session_options() const {
  SessionOptions options = options_.session;
  options.coarsening = document_.coarsening();
  return options;
}

const Workbench::Start& Workbench::start_of(const LiveFrame& live) const {
  const auto found = std::find_if(starts_.begin(), starts_.end(),
                                  [&](const Start& start) { return start.number == live.start; });
  return found == starts_.end() ? starts_.front() : *found;
}

/// The one that is to come, or else the one that is: those that failed left the run as it was.
const Workbench::Start& Workbench::newest_start() const {
  const std::shared_ptr<const LiveFrame> live = session_->latest();
  return starts_.back().number > live->newest_start ? starts_.back() : start_of(*live);
}

std::vector<std::string> Workbench::overrides(const LiveFrame& live) const {
  const Start& start = start_of(live);
  std::vector<std::string> all = options_.overrides;
  const std::vector<std::string>& coarsened = start.document.set_by_coarsening();
  all.insert(all.end(), coarsened.begin(), coarsened.end());
  for (const scene::Override& edit : start.at_start)
    if (effect_of(edit.address) != Effect::display) all.push_back(edit.address + "=" + edit.value);
  return all;
}

/// A mistake is a message, never the end. @return false if there was one
template <class Act>
bool Workbench::attempt(Act act) {
  const std::vector<scene::Override> before = document_.edits();
  try {
    act();
  } catch (const std::exception& error) {
    say(Message::Kind::error, text_of(error));
    return false;
  }
  take_over(before);
  return true;
}

void Workbench::edit(const Edit& edit) {
  switch (edit.kind) {
    case Edit::Kind::set:
      set(edit.address, edit.value, edit.gesture);
      return;
    case Edit::Kind::as_in_file:
      forget(edit.address);
      return;
    case Edit::Kind::to_default:
      if (const auto value = document_.default_of(edit.address))
        set(edit.address, *value);
      else
        say(Message::Kind::note, edit.address + " has no default; it is automatic or required");
      return;
    case Edit::Kind::sweep:
      sweep_around(edit.address);
      return;
    case Edit::Kind::refused:
      say(Message::Kind::error, edit.address + ": " + edit.value);
      return;
    case Edit::Kind::copy_address:
      return;  // the clipboard belongs to the frontend
  }
}

void Workbench::set(const std::string& address, const std::string& value, std::uint64_t gesture) {
  attempt([&] {
    require_allowed(address, value);
    document_.set(address, value, gesture);
  });
}

std::string Workbench::add_object(NewObject object, const sim::Vec3d& near, double size) {
  const AddedObject added = new_object(*document_.scene(), object, near, size);
  return attempt([&] { document_.set(added.address, added.value); }) ? added.address : "";
}

std::string Workbench::throw_ball(const Throw& ball) {
  const AddedObject added = thrown_ball(*document_.scene(), ball);
  return attempt([&] { document_.set(added.address, added.value); }) ? added.address : "";
}

/// A file in it is one that the scene names already: allowed over the web too.
std::string Workbench::copy_object(const std::string& address) {
  AddedObject copy;
  const bool is_done = attempt([&] {
    copy = copy_of(document_, address);
    document_.set(copy.address, copy.value);
  });
  return is_done ? copy.address : "";
}

namespace {

/// True if a member somewhere in it is called file or files, however that is spelled.
bool has_file(const scene::toml::Value& value) {
  if (const auto* list = std::get_if<scene::toml::Array>(&value.data))
    return std::any_of(list->begin(), list->end(), has_file);
  const auto* table = std::get_if<scene::toml::Table>(&value.data);
  return table && std::any_of(table->entries.begin(), table->entries.end(), [](const auto& entry) {
           return entry.key == "file" || entry.key == "files" || has_file(entry.value);
         });
}

/// True for a text of a whole table that names a file somewhere.
bool names_file(const std::string& text) {
  try {
    return has_file(scene::toml::parse_toml("value = " + text, "").entries.at(0).value);
  } catch (const scene::toml::SceneError&) {
    return false;  // the document refuses it
  }
}

}  // namespace

/// @throws UsageError
void Workbench::require_allowed(const std::string& address, const std::string& value) const {
  if (!options_.is_remote) return;
  const char* hint = "edit the scene file on the machine where neve runs";
  const std::optional<scene::ParamInfo> info = scene::param_at(address);
  if (info ? info->valid.is_path() : names_file(value))
    throw UsageError("", address + " names a file: fixed over the web", hint);
  if (address == "limits" || address.starts_with("limits."))
    throw UsageError("", address + " is fixed over the web", hint);
}

void Workbench::undo() {
  attempt([&] { document_.undo(); });
}

void Workbench::redo() {
  attempt([&] { document_.redo(); });
}

void Workbench::forget(const std::string& address) {
  attempt([&] { document_.forget(address); });
}

/// Applies the live part of the difference to the simulation.
void Workbench::take_over(const std::vector<scene::Override>& before) {
  bool needs_restart = false, is_live = false;
  const std::shared_ptr<const LiveFrame> frame = session_->latest();
  const bool is_broken = frame && frame->is_head_broken;
  for (const std::string& address : Document::difference(before, document_.edits())) {
    const Effect effect = effect_of(address);
    needs_restart = needs_restart || effect == Effect::restart;
    if (effect != Effect::live || waits_with_its_object(address)) continue;
    if (is_broken) {
      say(Message::Kind::note, address + ": this run has diverged; the change takes effect at " +
                                   "Reset, or after going back to an earlier frame");
      continue;
    }
    if (const scene::Curve* curve = setup::curve_of(*document_.scene(), address))
      say(Message::Kind::note, address + " follows its curve " + curve->name +
                                   ", which gives it its value again in each frame");
    put(newest_start().running, address, document_.edits());
    is_live = true;
  }
  if (needs_restart && frame && frame->steps == 0 && !frame->is_older && frame->head == 0) {
    reset();
    return;
  }
  if (is_live) apply_running();
}

void Workbench::apply_running() {
  try {
    const Start& start = newest_start();
    session_->apply(start.document.scene_with(start.running));
  } catch (const std::exception& error) {
    say(Message::Kind::warning, "waits for Reset, together with its object: " + text_of(error));
  }
}

/// True for a value inside of an object that the run does not have, or has in another form.
bool Workbench::waits_with_its_object(const std::string& address) const {
  return lacks_its_object(newest_start().running, address);
}

/// The same of a scene with these edits.
bool Workbench::lacks_its_object(const std::vector<scene::Override>& edits,
                                 const std::string& address) const {
  const std::string object = scene::object_of(address);
  if (object.empty() || object == address) return false;
  const std::vector<std::string> waiting = Document::difference(edits, document_.edits());
  return std::find(waiting.begin(), waiting.end(), object) != waiting.end();
}

std::vector<std::string> Workbench::waiting_for_reset() const {
  std::vector<std::string> waiting;
  for (const std::string& address : Document::difference(newest_start().running, document_.edits()))
    if (effect_of(address) != Effect::display && !waits_with_its_object(address))
      waiting.push_back(address);
  return waiting;
}

void Workbench::reset() {
  // A frame that is still shown may be of an older one.
  constexpr std::size_t most = 16;
  const std::uint64_t shown = session_->latest()->start, next = starts_.back().number + 1;
  if (starts_.size() >= most)
    std::erase_if(starts_, [&](const Start& start) { return start.number < shown; });
  starts_.push_back({next, document_, document_.edits(), document_.edits()});
  session_->reset(document_.scene(), next);
}

/// The live changes that waited because the run had diverged.
void Workbench::take_waiting() {
  for (const std::string& address : waiting_for_reset())
    if (effect_of(address) == Effect::live) put(newest_start().running, address, document_.edits());
}

void Workbench::continue_from_here() {
  session_->continue_from_here();
  take_waiting();
  apply_running();
}

void Workbench::continue_anyway() {
  const std::string address = "solver.on_divergence";
  try {
    document_.set(address, "\"ignore\"");
    take_waiting();
    const Start& start = newest_start();
    session_->continue_anyway(start.document.scene_with(start.running));
  } catch (const std::exception& error) {
    say(Message::Kind::error, text_of(error));
  }
}

/// Returns the scene of the start, with all that concerns pictures alone as it is now. If another
/// text was read and its Reset failed, it is that of the text of the start.
std::shared_ptr<const scene::Scene> Workbench::pictured(const LiveFrame& live) const {
  const Start& start = start_of(live);
  std::vector<scene::Override> edits = start.at_start;
  for (const std::string& address : Document::difference(start.at_start, document_.edits()))
    if (effect_of(address) == Effect::display && !lacks_its_object(start.at_start, address))
      put(edits, address, document_.edits());
  return start.document.scene_with(edits);
}

scene::Scene Workbench::display_scene(const LiveFrame& live) const {
  scene::Scene scene = *live.scene;
  const std::shared_ptr<const scene::Scene> shown =
      start_of(live).document.text() == document_.text() ? document_.scene() : pictured(live);
  const scene::Scene& mine = *shown;
  scene.title = mine.title;
  scene.camera = mine.camera;
  scene.light = mine.light;
  scene.size = mine.size;
  scene.background = mine.background;
  scene.shot = mine.shot;
  scene.burn_in = mine.burn_in;
  for (scene::Collider& collider : scene.colliders)
    for (const scene::Collider& other : mine.colliders)
      if (other.name == collider.name) collider.style = other.style;
  return scene;
}

bool Workbench::has_file_changed() const {
  if (!document_.has_file()) return false;
  const auto now = time_of(document_.file());
  return now != std::filesystem::file_time_type{} && now != file_time_;
}

void Workbench::reload() {
  const auto time = time_of(document_.file());  // before it is read: a later change is another one
  reload_error_.clear();
  try {
    document_.reload(scene::read_toml_file(document_.file()));
  } catch (const std::exception& error) {
    reload_error_ = text_of(error);
    failed_time_ = time;
    say(Message::Kind::error, "not reloaded: " + reload_error_);
    return;
  }
  file_time_ = time;
  reset();
  say(Message::Kind::note, "reloaded " + document_.file() + "; the run starts again");
}

std::string Workbench::reload_error() const {
  return failed_time_ == time_of(document_.file()) ? reload_error_ : "";
}

void Workbench::keep_file() {
  file_time_ = time_of(document_.file());
}

bool Workbench::is_file_of_scene(const std::filesystem::path& file) const {
  std::error_code error;
  return document_.has_own_file() && std::filesystem::equivalent(file, document_.file(), error);
}

/// The scene with its changes, for this file. That of the user keeps its words, or is refused; a
/// copy in another folder finds the files of the scene from there.
std::string Workbench::saved_text(const std::filesystem::path& file) const {
  const std::vector<scene::Override> changes = document_.all_overrides();
  if (is_file_of_scene(file))
    return scene::edit_scene_text(document_.text(), changes, document_.file(),
                                  scene::base_dir_of(document_.file()));
  return scene::changed_scene_text(document_.text(), changes, document_.file(), file.string());
}

/// The name of a scene or a sweep in the folder, "STEM.toml" or "STEM_2.toml" and so on. A file
/// that was there before may be anyone's, and the scene itself. One with the same text has the name
/// already: a script that is run again leaves no second copy.
std::filesystem::path Workbench::free_name(const std::string& stem, const TextIn& text_in) const {
  const auto has_the_text = [&](const std::filesystem::path& file) {
    try {
      const std::vector<std::uint8_t> bytes = output::read_file(file);
      return std::string(bytes.begin(), bytes.end()) == text_in(file);
    } catch (const std::exception&) {
      return false;
    }
  };
  for (int k = 1;; ++k) {
    const std::filesystem::path file =
        options_.folder / (stem + (k == 1 ? "" : "_" + std::to_string(k)) + ".toml");
    std::error_code error;
    if (!std::filesystem::exists(file, error) || has_the_text(file)) return file;
  }
}

/// The scene that commands and sweeps name: its own file, or one that is written now, with the text
/// as it was opened. Later changes leave that as it is, so that an earlier command stays true.
/// @throws IoError
std::string Workbench::file_of_scene() const {
  if (document_.has_file()) return document_.file();
  const TextIn text_in = [this](const std::filesystem::path& file) {
    return scene::changed_scene_text(document_.text(), {}, document_.file(), file.string());
  };
  const std::filesystem::path file =
      free_name(scene::name_of_scene(document_.file()) + "_opened", text_in);
  output::make_folder(options_.folder);
  output::write_named_file(file, text_in(file));
  return file.string();
}

std::filesystem::path Workbench::save_copy() {
  if (is_copy_new_)
    copy_ =
        free_name("scene", [this](const std::filesystem::path& file) { return saved_text(file); });
  if (!save_scene(copy_)) return {};
  is_copy_new_ = false;
  return copy_;
}

bool Workbench::save_scene(const std::filesystem::path& file) {
  try {
    if (options_.is_remote && file.parent_path() != options_.folder)
      throw UsageError(
          "", "over the web, files are written into " + options_.folder.string() + " alone");
    if (is_file_of_scene(file) && has_file_changed())
      throw UsageError("", file.filename().string() +
                               " was changed on disk since it was read; reload it, keep the "
                               "current scene, or save a copy");
    const std::string text = saved_text(file);
    output::make_folder(file.parent_path());
    output::write_named_file(file, text);
    if (is_file_of_scene(file)) file_time_ = time_of(document_.file());
    say(Message::Kind::note, "saved the scene with its changes as " + file.string() +
                                 changes_too_early("the saved scene"));
    return true;
  } catch (const std::exception& error) {
    say_not_saved("the scene was not saved: " + text_of(error));
    return false;
  }
}

/// A scene has all of its values and objects from its start on; only a picture knows when they
/// came.
/// @param what  that is made of the document: "the saved scene"
std::string Workbench::changes_too_early(const std::string& what) const {
  std::vector<std::string> came, changed;
  for (const std::string& address : changed_while_running()) {
    const std::vector<scene::Override>& edits = document_.edits();
    const bool is_added = scene::is_object_address(address) &&
                          std::any_of(edits.begin(), edits.end(), [&](const auto& edit) {
                            return edit.address == address && edit.value != "none";
                          });
    (is_added ? came : changed).push_back(address);
  }
  if (came.empty() && changed.empty()) return "";
  std::string text = "; ";
  if (!came.empty()) text += joined(came, ", ") + " came during the run, ";
  if (!changed.empty()) text += joined(changed, ", ") + " changed during the run, ";
  return text + "and " + what + " has " + (came.size() + changed.size() == 1 ? "it" : "them") +
         " from the start: a picture that is saved makes the run again";
}

/// Addresses changed after the first step.
std::vector<std::string> Workbench::changed_while_running() const {
  const Start& start = newest_start();
  std::vector<std::string> changed = Document::difference(start.at_start, start.running);
  const std::shared_ptr<const LiveFrame> live = session_->latest();
  const bool has_changes_to_come = options_.session.past && start.number == 0;
  if (live->steps == 0 && live->head == 0 && !live->is_older && !has_changes_to_come)
    return {};  // there was none
  const auto was_before_the_first_step = [&](const std::string& address) {
    bool is_told = false, is_later = false;
    for (const scene::LiveChange& change : live->snapshot.changes) {
      if (change.address != address) continue;
      is_told = true;
      is_later = is_later || change.step > 0;
    }
    return is_told && !is_later;
  };
  std::erase_if(changed, [&](const std::string& address) {
    return !scene::concerns_simulation(address) || was_before_the_first_step(address);
  });
  return changed;
}

std::filesystem::path Workbench::sweep_around(const std::string& address) {
  try {
    const std::vector<std::string> later = changed_while_running();
    const std::string scene_file = file_of_scene();
    const TextIn text_in = [&](const std::filesystem::path& file) {
      return sweep_text_around(file, document_, scene_file, address, later);
    };
    const std::filesystem::path file = free_name("sweep_" + plain_file_name(address), text_in);
    const std::string sweep = text_in(file);
    output::make_folder(options_.folder);
    output::write_among_others(file, sweep);
    std::string text = "wrote " + file.string() + "; " +
                       sweep::plan::sweep_command(file.string(), document_.coarsening()) +
                       " makes its runs";
    for (const std::string& changed : later)
      text += (&changed == &later.front() ? "; changed during the run, start values of all runs: "
                                          : ", ") +
              changed;
    say(Message::Kind::note, text);
    return file;
  } catch (const std::exception& error) {
    say_not_saved("no sweep: " + text_of(error));
    return {};
  }
}

std::string Workbench::values_around(const scene::FlatParam& param) {
  std::string text;
  try {
    for (const scene::toml::Value& value : sweep::plan::values_around(param))
      text += (text.empty() ? "" : ", ") + scene::toml::toml_literal(value);
  } catch (const UsageError&) {
    return {};
  }
  return text;
}

std::string Workbench::vary_from_here(const SweepRequest& request, const scene::View& view) {
  try {
    const std::shared_ptr<const LiveFrame> live = session_->latest();
    for (const SweepAxis& axis : request.axes) require_allowed(axis.address, axis.values);
    timeline::Moment moment = session_->moment();
    const int frame = moment.frame;
    if (!live->is_frame_end || live->is_running || frame != live->frame ||
        moment.steps != live->steps)
      throw UsageError("", "the run is between two frames",
                       "pause, and go to a frame on the time line");
    const record::PictureRecord picture = picture_record(*live, view);
    record::RunRecord run;
    run.scene = picture.scene;
    run.scene_file = document_.file();
    run.overrides = picture.overrides;
    run.changes = picture.changes;
    run.coarsening = picture.coarsening;
    run.threads = live->threads;
    run.simd = live->simd;
    std::vector<std::string> chosen;
    for (const SweepAxis& axis : request.axes) chosen.push_back(axis.address);
    sweep_.start({options_.folder, options_.session.threads, options_.backend}, std::move(run),
                 std::move(moment), live->scene->fps, request,
                 forecast::longer_steps(*live->scene, chosen));
    say(Message::Kind::note, "a sweep from frame " +
                                 std::to_string(scene::number_of(*live->scene, frame)) +
                                 " goes to " + sweep_.progress().folder.string() + "; " +
                                 sweep_.progress().command + " makes it again");
    return {};
  } catch (const UsageError& error) {
    const bool is_value = error.where.starts_with("-p ");
    return (is_value ? error.where.substr(3) + ": " : "") + text_of(error);
  } catch (const std::exception& error) {
    return text_of(error);
  }
}

std::string Workbench::command() {
  try {
    const std::string command = render_command(document_, file_of_scene());
    say(Message::Kind::note, "copied: " + command + changes_too_early("its run"));
    return command;
  } catch (const std::exception& error) {
    say_not_saved("no command: " + text_of(error));
    return {};
  }
}

record::PictureRecord Workbench::picture_record(const LiveFrame& live,
                                                const scene::View& view) const {
  scene::Scene scene = *pictured(live);
  scene.views = {view};
  scene.mosaics.clear();
  record::PictureRecord record;
  record.scene = scene::write_scene(scene);
  record.overrides = overrides(live);
  record.coarsening = document_.whole_coarsening();
  record.seed = scene.seed;
  record.version = version;
  record.build = build_text(live.simd);
  record.frame = scene::number_of(scene, live.frame);
  record.view = view.name;
  record.quality = setup::name(options_.quality);
  record.files = record::hash_files(scene, live.snapshot.changes);
  record.changes = live.snapshot.changes;
  return record;
}

void Workbench::say_saved_picture(const std::filesystem::path& file, const LiveFrame& live,
                                  bool was_between) {
  const std::string frame = "frame " + std::to_string(scene::number_of(*live.scene, live.frame)),
                    render = "; neve render " + shell_path(file.string()) + " makes ";
  std::string text = "saved " + file.string();
  if (!live.is_frame_end)  // the run diverged there: any other continues to its next frame
    text += "; it shows step " + std::to_string(live.steps) +
            ", where the run diverged, and only whole frames can be made again" + render + frame;
  else
    text += render + "it again";
  if (was_between && live.is_frame_end)
    text += "; it shows " + frame + ", the next one: only whole frames can be made again";
  say(Message::Kind::note, std::move(text));
}

void Workbench::say_not_saved(std::string text) {
  if (not_saved_.empty()) not_saved_ = text;
  say(Message::Kind::error, std::move(text));
}

void Workbench::say(Message::Kind kind, std::string text) {
  if (kind == Message::Kind::error) ++errors_said_;
  if (!messages_.empty() && messages_.back().text == text) return;
  messages_.push_back({kind, std::move(text)});
  if (messages_.size() > max_messages) messages_.pop_front();
}

}  // namespace neve::app::view::session
