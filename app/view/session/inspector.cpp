#include "app/view/session/inspector.h"

#include "app/view/session/samples.h"
#include "app/view/session/stage_summary.h"

namespace neve::app::view::session {

namespace {

constexpr auto probe_interval = std::chrono::milliseconds(250);

/// The step that is looked at alone, for the caption: not those that led to the frame.
sim::AdvanceReport report_of(const dump::StepInspection& inside) {
  sim::AdvanceReport report;
  report.steps = 1;
  report.dt_min = report.dt_max = report.seconds = inside.dt;
  report.ruled[static_cast<std::size_t>(inside.limit)] = 1;
  return report;
}

}  // namespace

bool Inspector::next_stage() {
  if (stage == sim::Stage::colliders) {
    stage.reset();
    return false;
  }
  stage = stage ? static_cast<sim::Stage>(static_cast<int>(*stage) + 1) : sim::Stage{};
  return true;
}

void Inspector::inspect(timeline::Timeline& timeline, bool is_running, LiveFrame& live) {
  const auto now = Clock::now();
  const bool is_probe =
      (probe_ || histogram_) && (!is_running || now - probed_at_ > probe_interval);
  live.probed = probe_;
  const bool is_stage = stage && !live.divergence;
  const auto look = [&](const scene::Scene& scene) {
    const dump::StepInspection inside =
        dump::inspect_step(scene, timeline.simulation(), seconds_left(timeline));
    if (is_stage) {
      live.stage = summarize_stage(inside, *stage);
      live.snapshot.advance = report_of(inside);
      live.snapshot.stage_change = change_of_stage(inside, *stage);
      show_after_stage(inside, *stage, live.snapshot);
    }
    if (is_probe) {
      if (probe_) reading_ = read_probe(inside, *probe_, stage);
      if (histogram_) spread_ = read_histogram(inside, *histogram_, stage);
      probed_at_ = Clock::now();
    }
  };
  // Without a stage it is the state that is asked for, as the last step has left it.
  if (is_stage)
    timeline.look_at_next(
        [&](bool has_other_values) { look(has_other_values ? timeline.scene() : *live.scene); });
  else if (is_probe)
    look(*live.scene);
  live.probe = probe_ ? reading_ : std::nullopt;
  live.histogram = histogram_ ? spread_ : std::nullopt;
}

}  // namespace neve::app::view::session
