#include <zlib.h>

#include <cstring>
#include <map>
#include <stdexcept>

#include "app/output/checkpoint.h"
#include "app/record/run_json.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "app/sweep/store/manifest.h"
#include "app/timeline/timeline.h"
#include "tests/fuzz/readers.h"

namespace neve::test::fuzz {

namespace {

using namespace neve::app;

/// About 40 particles of two materials, an emitter and a moving collider: every part of a state.
constexpr const char* small_scene = R"(
[solver]
cell_size = 0.06
[material.snow]
[material.ice]
model = "corotated"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.06 } }
[[body]]
name = "cube"
material = "ice"
shape = { box = { center = [0.3, 0.15, 0], size = [0.06, 0.06, 0.06] } }
[[emitter]]
name = "spout"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.05 } }
velocity = [0, -1, 0]
rate = 0.3
[[collider]]
name = "post"
shape = { cylinder = { center = [0.1, 0.1, 0], radius = 0.02, height = 0.2 } }
velocity = [0.1, 0, 0]
)";

struct SmallRun {
  scene::Scene scene = scene::read_scene_text(small_scene, "small.toml");
  timeline::Timeline timeline{
      scene, {}, std::make_shared<setup::SeededScene>(setup::seed_scene(scene)), 1};
  timeline::Moment good;
  output::Checkpoint checkpoint;

  SmallRun() {
    timeline::Made made;
    for (int frame = 0; frame <= 1; ++frame) {
      if (frame > 0) timeline.advance_frame();
      made.frames.push_back({frame,
                             frame / scene.fps,
                             timeline.here().advance,
                             0,
                             0,
                             timeline.summary(),
                             timeline.simulation().state_hash(),
                             {},
                             {},
                             {}});
    }
    good = timeline.moment();
    timeline::Moment written = good;
    written.made = made;
    checkpoint =
        timeline::to_checkpoint(std::move(written), "identity", timeline.simulation().simd());
  }
};

SmallRun& small_run() {
  static SmallRun instance;
  return instance;
}

/// The checksum of a checkpoint is its last eight bytes: made right, whatever is before it.
Bytes mended(std::span<const std::uint8_t> bytes) {
  Bytes whole(bytes.begin(), bytes.end());
  if (whole.size() < 8) return whole;
  const std::uint64_t sum = crc32_z(crc32_z(0, nullptr, 0), whole.data(), whole.size() - 8);
  std::memcpy(whole.data() + whole.size() - 8, &sum, sizeof sum);
  return whole;
}

/// A run that is resumed from it takes two steps and tells about its particles.
void resume(const timeline::Moment& moment) {
  timeline::Timeline& timeline = small_run().timeline;
  try {
    timeline.restore(moment);
  } catch (const Error&) {
    return;
  }
  timeline.advance_step();
  timeline.advance_step();
  timeline.simulation().particles();
  timeline.summary();
  timeline.restore(small_run().good);
}

}  // namespace

void read_checkpoint(std::span<const std::uint8_t> bytes) {
  output::Checkpoint checkpoint;
  try {
    checkpoint = output::parse_checkpoint(mended(bytes));
    checkpoint.file = "stranger.ckpt";
  } catch (const std::exception&) {
    return;
  }
  try {
    resume(timeline::to_moment(checkpoint));
  } catch (const Error&) {
  }
}

/// Reads run.json as --resume and neve verify do.
void read_run_json(std::span<const std::uint8_t> bytes) {
  Json json;
  try {
    json = parse_json(bytes);
  } catch (const nlohmann::json::exception&) {
    return;
  }
  record::frame_records(json);
  record::file_hashes(json);
  record::is_untouched(json);
  try {
    scene::live_changes(json.is_object() ? json.value("changes", Json::array()) : json);
  } catch (const std::runtime_error&) {
  }
}

void read_manifest(std::span<const std::uint8_t> bytes) {
  try {
    const sweep::store::Manifest manifest = sweep::store::parse_manifest(bytes, "manifest.json");
    require(manifest.first_frame() <= manifest.last_frame());
  } catch (const Error&) {
  }
}

std::vector<Bytes> checkpoints() {
  return {output::encode_checkpoint(small_run().checkpoint)};
}

std::vector<Bytes> run_records() {
  record::RunRecord record;
  record.scene = small_scene;
  record.views = {"particles"};
  for (const Json& frame : small_run().checkpoint.progress["frames"])
    record.frames.push_back(record::frame_record(frame));
  record.files = {{"particles/0000.png", "0123456789abcdef"}};
  Json changed = record::to_json(record), no_text = changed;
  changed["changes"] = "x";
  no_text["version"] = {nullptr};
  return {bytes_of(record::with_own_hash(record::to_json(record))),
          bytes_of(record::with_own_hash(changed)), bytes_of(record::with_own_hash(no_text))};
}

}  // namespace neve::test::fuzz
