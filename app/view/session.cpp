#include "app/view/session.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <exception>
#include <future>
#include <utility>

#include "app/changes.h"
#include "app/machine.h"
#include "app/plan.h"
#include "app/scene/flat.h"
#include "app/seed_scene.h"
#include "app/snow_pieces.h"
#include "app/view/look.h"
#include "sim/retry.h"

namespace neve::app {

namespace {

/// Between two moments of a run that are shown; turning the view draws pictures in between.
constexpr auto publish_interval = std::chrono::milliseconds(30);
/// By how much a simulation that is watched steps back behind the pictures of it: where both want
/// the same cores, these get about twice as much.
constexpr int niceness = 3;
/// Sampling takes at most one part in so many of the time.
constexpr int sampling_share = 20;
constexpr std::size_t most_samples = 4000;
constexpr int last_stage = static_cast<int>(sim::Stage::colliders);

/// The poll of a simulation has no argument.
thread_local Session* stepping = nullptr;

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Of the calling thread, and of those that it starts from now on.
void step_back() {
#ifdef __linux__
  const auto thread = static_cast<id_t>(gettid());
  errno = 0;
  const int now = getpriority(PRIO_PROCESS, thread);
  if (errno == 0) setpriority(PRIO_PROCESS, thread, now + niceness);  // only a matter of speed
#endif
}

std::uint64_t default_budget() {
  return available_memory() / 4;
}

}  // namespace

Session::Session(std::shared_ptr<const Scene> scene, const SessionOptions& options,
                 std::function<void()> wake)
    : wake_(std::move(wake)),
      options_(options),
      kept_(options.kept_budget > 0 ? options.kept_budget : default_budget()) {
  views_ = scene->views;
  std::promise<void> promise;
  std::future<void> start_of_run = promise.get_future();
  thread_ = std::thread([this, &scene, started = std::move(promise)]() mutable {
    step_back();
    try {
      start(std::move(scene));
      publish();
    } catch (...) {
      started.set_exception(std::current_exception());
      return;
    }
    started.set_value();
    work();
  });
  try {
    start_of_run.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Session::~Session() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    has_commands_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Session::ask(std::function<void()> command) {
  {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
    has_commands_ = true;
  }
  changed_.notify_all();
}

void Session::run() {
  ask([this] { set_goal(Goal::end); });
}

void Session::pause() {
  ask([this] { set_goal(Goal::none); });
}

void Session::next_step() {
  ask([this] { set_goal(Goal::step); });
}

void Session::next_frame() {
  ask([this] { set_goal(Goal::frame); });
}

void Session::next_stage() {
  ask([this] {
    leave_older();
    set_goal(Goal::none);
    if (simulation_->divergence()) return;
    if (stage_ && *stage_ == last_stage) {
      stage_.reset();
      set_goal(Goal::step);
      return;
    }
    stage_ = stage_ ? *stage_ + 1 : 0;
  });
}

void Session::reset(std::shared_ptr<const Scene> scene) {
  ask([this, scene = std::move(scene)] {
    start(scene);
    goal_ = Goal::none;
  });
}

void Session::apply(std::shared_ptr<const Scene> scene) {
  ask([this, scene = std::move(scene)] {
    leave_older();
    simulation_->apply(scene->solver, scene->materials, sim_colliders(*scene));
    const std::size_t steps = simulation_->steps();
    // What the simulation was told, not what was typed: both differ where a scene is coarsened.
    for (const Difference& change : differences(*scene_, *scene))
      if (change.is_live && concerns_simulation(change.address))
        note_change(changes_,
                    {steps, change.address, change.after ? toml_literal(*change.after) : "none"});
    colliders_ = simulation_->colliders();
    scene_ = scene;
    // What is kept of this moment has to go on with the change.
    if (steps == steps_of_frame_) keep();
  });
}

void Session::show_frame(int frame) {
  ask([this, frame] {
    goal_ = Goal::none;
    stop_looking_inside();
    const KeptFrame* kept = kept_.at_or_before(frame);
    if (!kept) return;
    if (!head_ && kept->frame == frame_ && simulation_->steps() == steps_of_frame_) return;
    if (!head_) head_ = state_now();
    load(*kept);
  });
}

void Session::show_head() {
  ask([this] { leave_older(); });
}

void Session::continue_from_here() {
  ask([this] {
    if (!head_) return;
    head_.reset();
    kept_.forget_after(frame_);
    history_.resize(std::min(history_.size(), static_cast<std::size_t>(frame_) + 1));
    const double now = simulation_->time();
    auto kept = std::make_shared<std::vector<RunSample>>(*samples_);
    std::erase_if(*kept, [&](const RunSample& sample) { return sample.time > now; });
    samples_ = kept;
    forget_changes_after(changes_, simulation_->steps());
  });
}

void Session::set_views(std::vector<View> views) {
  ask([this, views = std::move(views)] { views_ = views; });
}

void Session::set_probe(std::optional<ProbeTarget> probe) {
  ask([this, probe = std::move(probe)] {
    probe_ = probe;
    probed_at_ = {};
  });
}

void Session::set_recording(bool is_on) {
  ask([this, is_on] { is_recording_ = is_on; });
}

std::shared_ptr<const LiveFrame> Session::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void Session::taken(std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    taken_ = std::max<std::uint64_t>(taken_, number);
    is_wanted_ = true;
  }
  changed_.notify_all();
}

void Session::work() {
  while (!is_ending_) {
    std::deque<std::function<void()>> commands;
    {
      std::unique_lock lock(mutex_);
      // A picture of every frame is waited for while they are recorded.
      const auto may_run = [&] {
        return goal_ != Goal::none && !(is_recording_ && taken_ < number_);
      };
      changed_.wait(lock, [&] {
        return is_ending_ || !commands_.empty() || may_run() || (has_news_ && is_wanted_);
      });
      commands.swap(commands_);
      has_commands_ = false;
    }
    if (is_ending_) return;
    for (const auto& command : commands) obey(command);
    if (goal_ != Goal::none && !(is_recording_ && taken_ < number_)) obey([this] { advance(); });
    if (has_news_ && is_wanted_) {
      obey([this] { publish(); });
      has_news_ = false;
    }
  }
}

/// Whatever goes wrong is told to who asked; the thread goes on.
void Session::obey(const std::function<void()>& command) {
  try {
    command();
  } catch (const std::exception& error) {
    error_ = error.what();
    ++errors_;
    goal_ = Goal::none;
  }
  has_news_ = true;
}

void Session::start(std::shared_ptr<const Scene> scene) {
  const Plan plan = make_plan(*scene, {0, scene->frames}, Quality::preview, options_.threads);
  check_limits(*scene, plan);
  std::vector<std::size_t> body_end;
  sim::ParticleArrays particles = seed_scene(*scene, &body_end);
  auto simulation =
      std::make_unique<sim::Simulation>(make_simulation(*scene, particles, options_.threads));
  // From here on nothing fails: the old run may go.
  simulation_ = std::move(simulation);
  seeded_ = std::move(particles);
  scene_ = std::move(scene);
  colliders_ = simulation_->colliders();
  body_end_ = std::move(body_end);
  spacing_ = count_snow(*scene_, seeded_.x.size()).spacing;
  frame_ = 0;
  advance_ = {};
  advance_is_new_ = true;
  steps_of_frame_ = 0;
  changes_.clear();
  history_.clear();
  samples_ = std::make_shared<std::vector<RunSample>>();
  kept_.clear();
  head_.reset();
  stage_.reset();
  diagnosis_.reset();
  error_.clear();
  speed_ = 0;
  history_.push_back(plot_sample(0, note_sample(), {}));
  keep();
}

void Session::set_goal(Goal goal) {
  if (goal != Goal::none) {
    leave_older();
    stop_looking_inside();
    if (simulation_->divergence()) return;
    if (goal == Goal::end && frame_ >= scene_->frames) return;
    measured_at_ = Clock::now();
    measured_time_ = simulation_->time();
  }
  goal_ = goal;
}

void Session::stop_looking_inside() {
  stage_.reset();
}

void Session::leave_older() {
  if (!head_) return;
  const KeptFrame head = std::move(*head_);
  head_.reset();
  load(head);
}

/// The simulation as it was then. With other parameters since, it is made anew: a state goes on
/// only with those that it had.
void Session::load(const KeptFrame& kept) {
  if (kept.scene != scene_) {
    auto simulation = std::make_unique<sim::Simulation>(
        make_simulation(*kept.scene, seeded_, options_.threads, kept.colliders));
    simulation->restore(kept.state);
    simulation_ = std::move(simulation);
  } else {
    simulation_->restore(kept.state);
  }
  scene_ = kept.scene;
  colliders_ = kept.colliders;
  frame_ = kept.frame;
  advance_ = kept.advance;
  steps_of_frame_ = kept.steps_of_frame;
  advance_is_new_ = kept.steps == kept.steps_of_frame;
  diagnosis_.reset();
}

void Session::keep() {
  kept_.add(state_now());
}

KeptFrame Session::state_now() const {
  return {frame_, simulation_->steps(), steps_of_frame_, simulation_->save(),
          scene_, colliders_,           advance_};
}

bool Session::poll() {
  stepping->after_step();
  return stepping->goal_ == Goal::step || stepping->has_commands_ || stepping->is_ending_;
}

void Session::after_step() {
  if (is_publication_due()) {
    const Clock::time_point now = Clock::now();
    if (const double wall = seconds(now - measured_at_); wall > 0.25) {
      speed_ = (simulation_->time() - measured_time_) / wall;
      measured_at_ = now;
      measured_time_ = simulation_->time();
    }
    if (now - sampled_at_ > sampling_share * sampling_took_) note_sample();
    publish();
  }
}

void Session::advance() {
  const double time = (frame_ + 1) / scene_->fps;
  if (advance_is_new_) advance_ = {};
  advance_is_new_ = false;
  stepping = this;
  const bool may_go_back =
      scene_->solver.on_divergence == sim::OnDivergence::retry && goal_ != Goal::step;
  sim::AdvanceReport report;
  std::vector<sim::Retry> retries;
  if (may_go_back) {
    // What may go back to the beginning of its frame is not stopped inside of it.
    report = sim::advance_retrying(
        *simulation_, time,
        [] {
          stepping->after_step();
          return stepping->is_ending_.load();
        },
        retries);
  } else {
    report = simulation_->advance_to(time, poll);
  }
  stepping = nullptr;
  advance_.append(report);
  if (simulation_->divergence()) {
    note_sample();
    diagnosis_ = diagnose(*scene_, *simulation_->divergence());
    goal_ = Goal::none;
    return;
  }
  if (simulation_->time() >= time * (1 - 1e-12)) reach_frame();
  if (goal_ == Goal::step) {
    note_sample();
    goal_ = Goal::none;
  }
}

void Session::reach_frame() {
  ++frame_;
  history_.resize(static_cast<std::size_t>(frame_));
  const sim::Summary summary = note_sample();
  history_.push_back(plot_sample(frame_ / scene_->fps, summary, advance_));
  advance_is_new_ = true;
  steps_of_frame_ = simulation_->steps();
  keep();
  if (goal_ == Goal::frame || frame_ == scene_->frames) goal_ = Goal::none;
  if (is_recording_) publish();
}

/// Until the end of the frame.
double Session::seconds_left() const {
  const double left = (frame_ + 1) / scene_->fps - simulation_->time();
  return left > 0 ? left : 1 / scene_->fps;
}

/// Needs a decomposition per particle, for the elastic energy.
sim::Summary Session::note_sample() {
  const Clock::time_point start = Clock::now();
  const sim::Summary summary = simulation_->summary();
  sampled_at_ = Clock::now();
  sampling_took_ = sampled_at_ - start;
  const sim::Simulation::Choice choice = simulation_->choose_dt(seconds_left());
  // Readers hold the list they were given; a new one is made only when it is shared.
  if (samples_.use_count() > 1) samples_ = std::make_shared<std::vector<RunSample>>(*samples_);
  std::vector<RunSample>& list = *samples_;
  while (!list.empty() && list.back().time >= summary.time) list.pop_back();
  list.push_back({summary.time, summary.kinetic_energy, summary.elastic_energy, summary.momentum,
                  summary.max_speed, summary.min_J_P, summary.max_J_P, choice.dt, choice.limit,
                  summary.max_depth});
  if (list.size() <= most_samples) return summary;
  std::size_t kept = 0;  // every other one: the plot covers the whole run with half the detail
  for (std::size_t k = 0; k < list.size(); k += 2) list[kept++] = list[k];
  list.resize(kept);
  return summary;
}

bool Session::is_publication_due() const {
  return is_wanted_ && !is_recording_ && Clock::now() - published_at_ > publish_interval;
}

/// With colliders where they are, and the views that are looked at.
std::shared_ptr<const Scene> Session::shown_scene() const {
  auto scene = std::make_shared<Scene>(*scene_);
  scene->views = views_;
  if (stage_)
    for (View& view : scene->views)
      view = view_of_stage(*scene, view, static_cast<sim::Stage>(*stage_));
  for (std::size_t k = 0; k < std::min(colliders_.size(), scene->colliders.size()); ++k)
    static_cast<sim::Collider&>(scene->colliders[k]) = colliders_[k];
  return scene;
}

void Session::publish() {
  auto live = std::make_shared<LiveFrame>();
  live->number = ++number_;
  live->scene = shown_scene();
  live->snapshot = take_snapshot(*live->scene, *simulation_, frame_);
  live->snapshot.advance = advance_;
  live->snapshot.changes = changes_;
  forget_changes_after(live->snapshot.changes, simulation_->steps());
  live->probed = probe_;
  live->history = history_;
  live->snapshot.history = live->history;
  live->samples = samples_;
  live->body_end = body_end_;
  live->spacing = spacing_;
  live->frame = frame_;
  live->is_frame_end = simulation_->steps() == steps_of_frame_;
  live->steps = simulation_->steps();
  live->is_running = goal_ != Goal::none;
  live->is_older = head_.has_value();
  live->head = head_ ? head_->frame : frame_;
  live->kept = kept_.numbers();
  live->kept_bytes = kept_.bytes();
  live->kept_budget = kept_.budget();
  // Only pictures of frames are kept.
  if (live->is_frame_end) live->state_hash = simulation_->state_hash();
  live->phases = simulation_->phase_seconds();
  live->speed = speed_;
  live->memory = simulation_->memory_bytes();
  live->threads = simulation_->threads();
  live->simd = simulation_->simd();
  live->divergence = simulation_->divergence();
  live->diagnosis = diagnosis_;
  look_inside_step(*live);
  live->error = error_;
  live->errors = errors_;
  published_at_ = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    latest_ = live;
    is_wanted_ = false;
  }
  if (wake_) wake_();
}

/// Stage and probe need a step on a copy. While it runs, four times a second are enough to read.
void Session::look_inside_step(LiveFrame& live) {
  const bool is_stage = stage_.has_value();
  const auto now = Clock::now();
  const bool is_probe =
      probe_ && (goal_ == Goal::none || now - probed_at_ > std::chrono::milliseconds(250));
  if (live.divergence || (!is_stage && !is_probe)) {
    live.probe = probe_ ? last_reading_ : std::nullopt;
    return;
  }
  const Inside inside = look_inside(*live.scene, *simulation_, seconds_left());
  std::optional<sim::Stage> stage;
  if (is_stage) {
    stage = static_cast<sim::Stage>(*stage_);
    live.stage = stage_look(inside, *stage);
    show_after_stage(inside, *stage, live.snapshot);
  }
  if (is_probe) {
    last_reading_ = read_probe(inside, *probe_, stage);
    probed_at_ = Clock::now();
  }
  live.probe = probe_ ? last_reading_ : std::nullopt;
}

}  // namespace neve::app
