/// Actions of a user on a running simulation, and proof that inspecting it never changes it.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "app/scene/read.h"
#include "app/setup/plan.h"
#include "app/setup/seed_scene.h"
#include "app/timeline/timeline.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/session/samples.h"
#include "app/view/session/session.h"
#include "tests/view/view_support.h"

namespace {

using namespace neve;
using namespace neve::app;
using namespace neve::test;

std::shared_ptr<const scene::Scene> scene_of(const std::string& text) {
  const view::session::Document document("scene.toml", text, {}, 1);
  return document.scene();
}

/// Hash of the state at a frame of a run that nobody looks at.
std::uint64_t undisturbed(const scene::Scene& scene, int frame) {
  sim::Simulation simulation(scene.solver, scene.materials, scene::sim_colliders(scene),
                             setup::seed_scene(scene).particles);
  for (int f = 1; f <= frame; ++f) simulation.advance_to(f / scene.fps);
  return simulation.state_hash();
}

TEST(Session, SessionRunsToTheEndAndKeepsEveryFrame) {
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.run();
  const auto live = rest_at(session, 4);
  EXPECT_EQ(live->state_hash, undisturbed(*scene, 4));
  EXPECT_EQ(live->kept, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(live->history.size(), 5u);
  EXPECT_FALSE(live->is_older);
}

TEST(Session, LookingChangesNothing) {
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.set_probe(dump::Probe(std::size_t{7}));
  session.next_frame();
  rest_at(session, 1);
  // Two stages of a step, an older frame, and back.
  session.next_stage();
  session.next_stage();
  const auto inside = wait_for(session, [](const view::session::LiveFrame& live) {
    return live.stage && live.stage->stage == sim::Stage::volumes;
  });
  EXPECT_GT(inside->stage->rows, 0u);
  ASSERT_TRUE(inside->probe);
  EXPECT_EQ(std::get<std::size_t>(inside->probe->target), 7u);
  session.show_frame(0);
  const auto older =
      wait_for(session, [](const view::session::LiveFrame& live) { return live.is_older; });
  EXPECT_EQ(older->frame, 0);
  EXPECT_EQ(older->head, 1);
  EXPECT_EQ(older->state_hash, undisturbed(*scene, 0));
  session.show_head();
  wait_for(session, [](const view::session::LiveFrame& live) { return !live.is_older; });
  session.next_step();
  wait_for(session, [](const view::session::LiveFrame& live) {
    return !live.is_running && !live.is_frame_end;
  });
  session.run();
  EXPECT_EQ(rest_at(session, 4)->state_hash, undisturbed(*scene, 4));
}

TEST(Session, SessionShowsAnyStageOfAStepAndItsDuration) {
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.next_frame();
  rest_at(session, 1);
  session.show_stage(sim::Stage::deformation);
  const auto inside = wait_for(session, [](const view::session::LiveFrame& live) {
    return live.stage && live.stage->stage == sim::Stage::deformation;
  });
  using enum sim::Stage;
  const auto seconds = [&](sim::Stage stage) {
    return inside->stage->seconds[static_cast<std::size_t>(stage)];
  };
  double all = 0;
  for (const double s : inside->stage->seconds) all += s;
  for (const sim::Stage stage : {rasterize, elastic_forces, deformation, advection})
    EXPECT_GT(seconds(stage), 0) << sim::name(stage);
  EXPECT_EQ(seconds(colliders), 0);
  EXPECT_LT(all, 10);  // s, of 300 particles: not a moment of some clock
  session.show_stage(rasterize);
  wait_for(session, [](const view::session::LiveFrame& live) {
    return live.stage && live.stage->stage == rasterize;
  });
  session.leave_stage();
  wait_for(session, [](const view::session::LiveFrame& live) { return !live.stage; });
  session.run();
  EXPECT_EQ(rest_at(session, 4)->state_hash, undisturbed(*scene, 4));
}

TEST(Session, SessionGoesThroughAllStagesOfAStepAndTakesItThen) {
  view::session::Session session(scene_of(tiny_scene), {}, {});
  for (const char* const stage : sim::stage_names) {
    session.next_stage();
    const auto live = wait_for(session, [&](const view::session::LiveFrame& frame) {
      return frame.stage && std::string(sim::name(frame.stage->stage)) == stage;
    });
    EXPECT_EQ(live->steps, 0u) << stage;
    const bool leaves_numbers =
        std::string(stage) != "implicit_solve" && std::string(stage) != "colliders";
    EXPECT_TRUE(!leaves_numbers || !live->stage->quantities.empty()) << stage;
    for (const view::session::QuantitySummary& quantity : live->stage->quantities)
      // Volumes at the rim of a ball of two cells are too large: the paper's estimate.
      EXPECT_LE(20 * quantity.magnitudes.outside_expected, live->stage->rows)
          << stage << " " << quantity.name;
  }
  session.next_stage();
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& frame) { return frame.steps == 1; });
  EXPECT_FALSE(live->stage);
}

TEST(Session, AStepWithoutSnowHasNoMagnitudes) {
  view::session::Session session(
      scene_of("[[emitter]]\nname = \"hose\"\nshape = { sphere = { radius = 0.1 } }\nrate = 2\n"
               "start = 0.5\nvelocity = [0, -1, 0]\n"),
      {}, {});
  session.show_stage(sim::Stage::deformation);
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& frame) { return bool(frame.stage); });
  EXPECT_EQ(live->stage->rows, 0u);
  EXPECT_FALSE(live->stage->quantities.empty());
  for (const view::session::QuantitySummary& quantity : live->stage->quantities)
    EXPECT_TRUE(std::isnan(quantity.magnitudes.least)) << quantity.name << " is not 0 to 0";
}

TEST(Session, StagesOfAnOlderFrameAreThoseOfThatFrame) {
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.run();
  rest_at(session, 4);
  session.show_frame(2);
  wait_for(session, [](const view::session::LiveFrame& live) { return live.is_older; });
  session.show_stage(sim::Stage::advection);
  const auto inside = wait_for(
      session, [](const view::session::LiveFrame& live) { return live.stage.has_value(); });
  EXPECT_EQ(inside->frame, 2);
  EXPECT_TRUE(inside->is_older);
  EXPECT_EQ(inside->head, 4);
  EXPECT_EQ(inside->state_hash, undisturbed(*scene, 2));
  session.next_stage();
  session.next_stage();  // an older frame takes no step
  const auto after =
      wait_for(session, [](const view::session::LiveFrame& live) { return !live.stage; });
  EXPECT_EQ(after->state_hash, undisturbed(*scene, 2));
  session.show_stage(sim::Stage::rasterize);
  wait_for(session, [](const view::session::LiveFrame& live) { return live.stage.has_value(); });
  session.show_head();
  const auto head =
      wait_for(session, [](const view::session::LiveFrame& live) { return !live.is_older; });
  EXPECT_EQ(head->state_hash, undisturbed(*scene, 4));
  EXPECT_FALSE(head->stage) << "the newest frame is shown, not a step of it";
}

TEST(Session, AHistogramIsOfAnyFieldOfParticlesOrNodes) {
  using Live = view::session::LiveFrame;
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.next_frame();
  const std::size_t particles = rest_at(session, 1)->snapshot.particles.x.size();
  const auto show = [&](const view::session::FieldName& field) {
    session.set_histogram(field);
    return wait_for(session, [&](const Live& live) {
      return live.histogram && live.histogram->field == field;
    });
  };
  const auto J_P = show({false, "J_P"});
  ASSERT_TRUE(J_P->histogram->histogram);
  EXPECT_EQ(J_P->histogram->histogram->rows, particles);
  EXPECT_EQ(J_P->histogram->after, "");
  // Every field that is offered can be shown.
  bool has_nodes = false;
  for (const view::session::FieldName& field : J_P->histogram->fields) {
    has_nodes = has_nodes || field.is_of_nodes;
    const auto live = show(field);
    ASSERT_TRUE(live->histogram->histogram) << field.name;
    EXPECT_EQ(live->histogram->histogram->is_of_nodes, field.is_of_nodes) << field.name;
  }
  EXPECT_TRUE(has_nodes);
  // A field of a stage exists while that stage is shown.
  EXPECT_FALSE(show({false, "F_E_trial"})->histogram->histogram);
  session.show_stage(sim::Stage::deformation);
  const auto inside = wait_for(
      session, [](const Live& live) { return live.histogram && live.histogram->histogram; });
  EXPECT_EQ(inside->histogram->after, "deformation");
  session.set_histogram(std::nullopt);
  wait_for(session, [](const Live& live) { return !live.histogram; });
}

TEST(Session, SessionContinuesFromAnOlderFrameAndForgetsLaterOnes) {
  const auto scene = scene_of(tiny_scene);
  view::session::Session session(scene, {}, {});
  session.run();
  rest_at(session, 4);
  session.show_frame(2);
  wait_for(session,
           [](const view::session::LiveFrame& live) { return live.is_older && live.frame == 2; });
  session.continue_from_here();
  const auto here =
      wait_for(session, [](const view::session::LiveFrame& live) { return !live.is_older; });
  EXPECT_EQ(here->kept, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(here->history.size(), 3u);
  session.run();
  EXPECT_EQ(rest_at(session, 4)->state_hash, undisturbed(*scene, 4));
}

TEST(Session, SessionSaysWhyARunBrokeAndIsGoodForAnother) {
  view::session::Session session(scene_of(exploding_scene), {}, {});
  session.run();
  const auto live = wait_for(session, [](const view::session::LiveFrame& frame) {
    return frame.divergence.has_value() && !frame.is_running;
  });
  ASSERT_TRUE(live->diagnosis);
  EXPECT_FALSE(live->diagnosis->evidence.empty());
  session.run();  // a broken state takes no more steps
  session.reset(scene_of(tiny_scene), 1);
  wait_for(session, [](const view::session::LiveFrame& frame) {
    return !frame.divergence && frame.steps == 0;
  });
  session.next_frame();
  EXPECT_FALSE(rest_at(session, 1)->divergence);
}

TEST(Session, ABrokenRunStaysBrokenWhateverFrameIsShown) {
  using view::session::LiveFrame;
  view::session::Session session(scene_of(exploding_scene), {}, {});
  session.run();
  const auto broken = wait_for(session, [](const LiveFrame& live) {
    return live.divergence.has_value() && !live.is_running;
  });
  const auto next = [&](const std::function<void()>& ask) {
    const std::uint64_t before = session.latest()->number;
    ask();
    return wait_for(
        session, [&](const LiveFrame& live) { return live.number > before && !live.is_running; });
  };
  const auto expect_broken = [&](const LiveFrame& live) {
    ASSERT_TRUE(live.divergence);
    EXPECT_EQ(live.divergence->step, broken->divergence->step);
    EXPECT_TRUE(live.diagnosis);
    EXPECT_TRUE(live.is_head_broken);
    EXPECT_EQ(live.steps, broken->steps);
  };
  for (int round = 0; round < 2; ++round) {
    const auto older = next([&] { session.show_frame(0); });
    EXPECT_TRUE(older->is_older);
    EXPECT_FALSE(older->divergence || older->diagnosis);
    EXPECT_TRUE(older->is_head_broken);
    expect_broken(*next([&] { session.show_head(); }));
    for (const auto go : {&view::session::Session::run, &view::session::Session::next_frame,
                          &view::session::Session::next_step, &view::session::Session::next_stage})
      expect_broken(*next([&] { (session.*go)(); }));
  }
  next([&] { session.show_frame(0); });
  expect_broken(*next([&] { session.run(); }));
  // A live change is refused, and a fork is a run that is not broken.
  EXPECT_NE(next([&] { session.apply(scene_of(tiny_scene)); })->error, "");
  next([&] { session.show_frame(0); });
  const auto forked = next([&] { session.continue_from_here(); });
  EXPECT_FALSE(forked->divergence || forked->diagnosis || forked->is_head_broken);
}

TEST(Session, SessionReportsRefusalsAndContinues) {
  view::session::Session session(scene_of(tiny_scene), {}, {});
  scene::Scene huge = *scene_of(tiny_scene);
  huge.limits.particles = 10;
  session.reset(std::make_shared<const scene::Scene>(huge), 1);
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& frame) { return frame.errors == 1; });
  EXPECT_TRUE(contains(live->error, "particles")) << live->error;
  EXPECT_EQ(live->newest_start, 1u);
  EXPECT_EQ(live->start, 0u);
  session.next_frame();
  EXPECT_EQ(rest_at(session, 1)->frame, 1);
}

/// Two runs of it, or its kept frames beside it, are more than the cap.
TEST(Session, AResetHasTheMemoryOfTheRunThatItEnds) {
  const auto scene = scene_of(tiny_scene);
  const std::uint64_t planned =
      setup::make_plan(*scene, {0, scene->frames}, setup::Quality::preview, 0).memory;
  const std::uint64_t spare = 64 << 10;
  ::setenv("NEVE_MAX_MEMORY", std::to_string(planned + spare).c_str(), 1);
  view::session::Session session(scene, {}, {});
  session.run();
  EXPECT_LE(rest_at(session, 4)->kept_budget, spare);
  session.reset(scene, 1);
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& frame) { return frame.start == 1; });
  EXPECT_EQ(live->errors, 0u) << live->error;
  EXPECT_EQ(live->state_hash, undisturbed(*scene, 0));
  session.run();
  EXPECT_EQ(rest_at(session, 4)->state_hash, undisturbed(*scene, 4));
  ::unsetenv("NEVE_MAX_MEMORY");
}

TEST(Session, ARunWhoseLastFrameIsLoweredBehindItStops) {
  std::string text = tiny_scene;
  text.replace(text.find("frames = 4"), 10, "frames = 1000");
  const auto scene = scene_of(text);
  view::session::Session session(scene, {}, {});
  session.run();
  wait_for(session, [](const view::session::LiveFrame& live) { return live.frame >= 3; });
  scene::Scene shorter = *scene;
  shorter.frames = 2;
  session.apply(std::make_shared<const scene::Scene>(shorter));
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& frame) { return !frame.is_running; });
  EXPECT_TRUE(live->is_frame_end);
  EXPECT_LT(live->frame, 1000);
}

TEST(Session, SessionRecordsEveryFrameOnce) {
  view::session::Session session(scene_of(tiny_scene), {}, {});
  session.set_recording(true);
  session.run();
  std::vector<int> seen;
  wait_for(session, [&](const view::session::LiveFrame& live) {
    if (live.is_frame_end && live.steps > 0 && (seen.empty() || seen.back() != live.frame))
      seen.push_back(live.frame);
    return live.frame == 4;
  });
  EXPECT_EQ(seen, (std::vector<int>{1, 2, 3, 4}));
}

TEST(Session, AnotherViewIsAnsweredThoughTheFrameWaitsForItsPicture) {
  view::session::Session session(scene_of(tiny_scene), {}, {});
  session.set_views({scene::find_view({}, "particles")});
  session.set_recording(true);
  session.run();
  const auto waits_at = [&](int frame) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (session.latest()->frame < frame && std::chrono::steady_clock::now() < end) {
      const auto live = session.latest();
      if (live->frame < frame) session.taken(live->number);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return session.latest();
  };
  ASSERT_FALSE(waits_at(2)->snapshot.fields.lattice);
  // Nobody takes this frame: it lacks what the view shows.
  session.set_views({scene::find_view({}, "slice")});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!session.latest()->snapshot.fields.lattice && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_TRUE(session.latest()->snapshot.fields.lattice);
  EXPECT_EQ(session.latest()->frame, 2) << "the recording waits";
}

TEST(Session, AReadingSaysWhenItWasMade) {
  view::session::Session session(scene_of(tiny_scene), {}, {});
  session.set_probe(dump::Probe(std::size_t{3}));
  session.run();
  // Four readings a second: most frames show an earlier one.
  wait_for(session, [&](const view::session::LiveFrame& live) {
    if (live.probe) {
      EXPECT_LE(live.probe->time, live.snapshot.time);
    }
    return live.frame == 4 && !live.is_running;
  });
  const auto rest = wait_for(session, [](const view::session::LiveFrame& live) {
    return live.probe && live.probe->time == live.snapshot.time;
  });
  const auto row = rest->snapshot.particles.index_of(3);
  EXPECT_EQ(rest->probe->place, rest->snapshot.particles.x[*row]);
  session.set_probe(dump::Probe(std::size_t{4}));
  const auto other = wait_for(session, [](const view::session::LiveFrame& live) {
    return live.probed == dump::Probe(std::size_t{4});
  });
  ASSERT_TRUE(other->probe);
  EXPECT_EQ(std::get<std::size_t>(other->probe->target), 4u);
}

TEST(Session, ParticlesOfABrokenRunAreRead) {
  view::session::Session session(scene_of(exploding_scene), {}, {});
  session.run();
  wait_for(session,
           [](const view::session::LiveFrame& live) { return live.divergence.has_value(); });
  session.set_probe(dump::Probe(std::size_t{5}));
  const auto live = wait_for(
      session, [](const view::session::LiveFrame& frame) { return frame.probe.has_value(); });
  EXPECT_EQ(std::get<std::size_t>(live->probe->target), 5u);
}

/// The plot of forces has no zeros where the steps of a frame are still being taken.
TEST(Samples, ForcesAreUnknownInsideAFrameAndKnownAtItsEnd) {
  const auto scene = scene_of(tiny_scene);
  view::session::Samples samples;
  timeline::Timeline* running = nullptr;
  timeline::Timeline run(*scene, {},
                         std::make_shared<setup::SeededScene>(setup::seed_scene(*scene)), 0, {},
                         timeline::Watch{[&](double) {
                           samples.note_if_cheap(*running);
                           return false;
                         }});
  running = &run;
  samples.begin();
  ASSERT_TRUE(run.advance_frame());
  samples.note(run);
  ASSERT_GT(samples.list()->size(), 1u);
  for (const view::session::RunSample& sample : *samples.list())
    EXPECT_EQ(std::isnan(sample.max_force), sample.time < run.simulation().time()) << sample.time;
}

TEST(Samples, MomentsThatTheRunHasLeftAreForgotten) {
  const auto scene = scene_of(tiny_scene);
  timeline::Timeline run(*scene, {},
                         std::make_shared<setup::SeededScene>(setup::seed_scene(*scene)), 0);
  view::session::Samples samples;
  samples.begin();
  samples.note(run);
  for (int frame = 1; frame <= 2; ++frame) {
    ASSERT_TRUE(run.advance_frame());
    samples.note(run);
  }
  ASSERT_EQ(samples.list()->size(), 3u);
  const auto shown = samples.list();
  samples.forget_after(samples.list()->at(1).time);
  EXPECT_EQ(samples.list()->size(), 2u);
  EXPECT_EQ(shown->size(), 3u) << "readers hold the list that they were given";
}

/// A hand that drags asks far more often than a session can do what it is asked for.
TEST(Mailbox, ARequestTakesThePlaceOfTheOneOfItsKindThatWaits) {
  using Kind = view::session::Mailbox::Kind;
  view::session::Mailbox mailbox;
  std::string done;
  const auto ask = [&](char name, Kind kind) {
    mailbox.ask([&done, name] { done += name; }, kind);
  };
  ask('a', Kind::start);
  ask('b', Kind::views);
  ask('c', Kind::start);
  ask('d', Kind::frame);
  ask('e', Kind::once);
  ask('f', Kind::frame);
  ask('g', Kind::frame);
  for (const auto& waiting : mailbox.wait([] { return true; })) waiting.request();
  EXPECT_EQ(done, "bcdeg");
}

/// Attempts that broke a rule stayed in the plots.
TEST(Session, PlotsHaveNoMomentOfAnAttemptThatTheRunHasLeft) {
  std::string text = tiny_scene;
  text.replace(text.find("[solver]"), 8,
               "[material.snow]\nhardening = 30\n[solver]\ntime_step = \"fixed\"\ndt = 2.4e-3\n"
               "on_divergence = \"retry\"");
  text.replace(text.find("[0, -2, 0]"), 10, "[0, -4, 0]");
  // Every step of the first attempts is told.
  std::atomic<view::session::Session*> watched = nullptr;
  view::session::Session session(scene_of(text), {}, [&] {
    view::session::Session* const it = watched.load();
    if (!it || it->latest()->returns > 1) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(31));
    it->taken(it->latest()->number);
  });
  watched = &session;
  session.next_frame();
  const auto live = rest_at(session, 1);
  EXPECT_EQ(live->returns, 2u);
  // A third attempt may be shorter than the pause between samples; a frame always samples its end.
  ASSERT_GE(live->samples->size(), 2u);
  for (const view::session::RunSample& sample : *live->samples) {
    EXPECT_LT(sample.max_speed, 20) << sample.time << " s: attempts broke a rule with more";
    if (sample.time > 0 && sample.time < 1 / 24.0) {
      EXPECT_LT(sample.dt, 0.61e-3) << sample.time;
    }
  }
}

/// The run may be between two frames: the one that it passed last is kept, too.
TEST(Session, TheFrameBeforeAStepIsShownAndContinuedFrom) {
  const TemporaryFolder folder;
  view::session::Workbench bench = bench_for(folder, tiny_scene);
  view::session::Session& session = bench.session();
  session.next_frame();
  const auto whole = rest_at(session, 1);
  session.next_step();
  view::panels::ViewerState state{.bench = bench};
  state.live = wait_for(session, [](const view::session::LiveFrame& live) {
    return !live.is_running && !live.is_frame_end;
  });
  const std::size_t steps = state.live->steps;
  view::panels::show_frame(state, 1);
  state.live =
      wait_for(session, [](const view::session::LiveFrame& live) { return live.is_older; });
  EXPECT_EQ(state.live->state_hash, whole->state_hash);
  view::panels::show_frame(state, 2);
  EXPECT_EQ(
      wait_for(session, [](const view::session::LiveFrame& live) { return !live.is_older; })->steps,
      steps);
  view::panels::show_frame(state, 1);
  wait_for(session, [](const view::session::LiveFrame& live) { return live.is_older; });
  session.continue_from_here();
  const auto forked =
      wait_for(session, [](const view::session::LiveFrame& live) { return !live.is_older; });
  EXPECT_EQ(forked->steps, whole->steps);
  EXPECT_GT(forked->returns, whole->returns);
  EXPECT_EQ(forked->returned_to, whole->snapshot.time);
}

}  // namespace
