#include "app/run/identity.h"

#include "app/record/picture_files.h"
#include "app/scene/read.h"
#include "app/support/version.h"

namespace neve::app::run {

std::string simulation_text(const scene::Scene& scene) {
  // All of it but what only pictures, exports and the length of a run read.
  const scene::Scene plain;
  scene::Scene simulated = scene;
  simulated.title.clear();
  simulated.frames = plain.frames;
  simulated.first_frame = plain.first_frame;
  simulated.handles = plain.handles;
  simulated.shot = plain.shot;
  simulated.burn_in = plain.burn_in;
  simulated.limits = plain.limits;
  simulated.camera = plain.camera;
  simulated.light = plain.light;
  simulated.views = plain.views;
  simulated.mosaics = plain.mosaics;
  simulated.exports = plain.exports;
  simulated.size = plain.size;
  simulated.background = plain.background;
  for (scene::Collider& collider : simulated.colliders) collider.style = scene::Collider{}.style;
  return scene::write_scene(simulated);
}

std::string surroundings_of(const scene::Scene& scene) {
  std::string text = std::string("\nversion ") + version + "\nsources " + build().sources;
  for (const auto& [file, hash] : record::hash_files(scene)) text += "\n" + file + " " + hash;
  return text;
}

std::string identity_of_states(const RenderJob& job, const std::string& simd) {
  return record::hash_of(simulation_text(job.scene) + to_text(scene::to_json(job.changes)) +
                         surroundings_of(job.scene) + simd);
}

std::string identity_of(record::PictureRecord picture) {
  picture.frame = 0;
  picture.view.clear();
  picture.state_hash.clear();
  picture.build.clear();
  return record::hash_of(to_text(to_json(picture)));
}

}  // namespace neve::app::run
