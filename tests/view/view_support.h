#pragma once
/// Sessions and workbenches on a small scene, without a screen.

#include <chrono>
#include <functional>
#include <thread>

#include "app/view/session/workbench.h"
#include "tests/cli/run_neve.h"

namespace neve::test {

/// Waits for a frame that is as wanted, and takes every one on the way.
inline std::shared_ptr<const app::view::session::LiveFrame> wait_for(
    app::view::session::Session& session,
    const std::function<bool(const app::view::session::LiveFrame&)>& is_wanted) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::shared_ptr<const app::view::session::LiveFrame> live = session.latest();
  while (std::chrono::steady_clock::now() < end) {
    live = session.latest();
    if (is_wanted(*live)) return live;
    session.taken(live->number);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ADD_FAILURE() << "never came: frame " << live->frame << ", step " << live->steps << ", error "
                << live->error;
  return live;
}

inline std::shared_ptr<const app::view::session::LiveFrame> rest_at(
    app::view::session::Session& session, int frame) {
  return wait_for(session, [&](const app::view::session::LiveFrame& live) {
    return !live.is_running && live.frame == frame && live.is_frame_end;
  });
}

/// A workbench for a scene file in a folder.
inline app::view::session::Workbench bench_for(const TemporaryFolder& folder,
                                               const std::string& text, double coarsening = 1) {
  app::view::session::WorkbenchOptions options;
  options.folder = folder / "out";
  return app::view::session::Workbench(
      app::view::session::open_document(folder.write("scene.toml", text), {}, coarsening).document,
      options, {});
}

}  // namespace neve::test
