#pragma once
/// The exports of a run: read between two steps, made into files by a worker.

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/exports/encode.h"
#include "app/exports/series.h"
#include "app/output/file_hash.h"
#include "app/scene/live_change.h"
#include "app/setup/seed_scene.h"
#include "app/support/json.h"

namespace neve::app::exports {

class Exporter {
 public:
  using Work = std::function<std::vector<output::WrittenFile>()>;

  /// @param folder    of all exports; each writes into one of its own in it
  /// @param seeded    outlives it
  /// @param changes   made while the run ran, and to come
  Exporter(const scene::Scene& scene, std::filesystem::path folder,
           const setup::SeededScene& seeded, const std::vector<scene::LiveChange>& changes = {});

  /// Names of the files that a frame has, below the folder.
  std::vector<std::string> files_of(int frame) const;

  /// Reads the state. @return writes its files; to be called once each, in order, by any thread,
  /// while this object lives
  /// @param colliders  of the scene, followed to this moment
  /// @param number     of the files
  /// @param is_frame   only exports whose `every` divides the frame, counted from 0
  std::vector<Work> add(const std::vector<scene::Collider>& colliders,
                        const sim::Simulation& simulation, int number, bool is_frame);

  /// Says what the files lack, once; "" for nothing.
  std::string take_warning();

  /// Notes where things are at a frame without a file, for stages, which have them at every frame.
  /// @param is_frame  only exports whose `every` does not divide it
  void add_between(const std::vector<scene::Collider>& colliders, const sim::Simulation& simulation,
                   int number, bool is_frame);
  bool has_stage() const;
  /// True if a stage does not have the places of a frame yet, which the scene alone does not say.
  bool lacks_places(int frame) const;

  /// Writes the series, as they are in the end. @return their files @throws IoError
  std::vector<output::WrittenFile> finish() const;

  /// Takes the files of a run that is resumed from the list of its run.json.
  void resume(const Json& list, int last_number);

  /// Lists exports for run.json and export.json. @param below  put in front of paths: "exports/"
  Json to_json(const std::string& below) const;

 private:
  /// An export and the files that it has written so far.
  struct Job {
    scene::Export spec;
    Table columns;                ///< without rows
    std::vector<Sample> samples;  ///< one per file
    std::vector<Sample> between;  ///< frames of a stage where the scene alone says too little
  };
  Work work(Job& job, std::shared_ptr<const State> state,
            const std::vector<scene::Collider>& colliders, int number);
  static bool is_stage(const Job& job);
  std::map<std::string, sim::Vec3d> followed(const sim::ParticleArrays& particles, double time,
                                             const std::vector<scene::Collider>& colliders) const;
  void note_shapes(const std::vector<scene::Collider>& colliders, Sample& sample);
  std::size_t shape_of(const scene::Collider& collider);
  void take_later_shapes(const Json& list);

  scene::Scene scene_;
  /// Colliders of the scene, then those that came later, and all with another shape.
  std::vector<scene::Collider> colliders_;
  Json later_shapes_ = Json::array();  ///< how to make all but the first ones of the scene
  std::filesystem::path folder_;
  const setup::SeededScene& seeded_;
  Origins origins_;
  Carried carried_;
  std::vector<Job> jobs_;
  std::set<std::string> follows_;  ///< what cameras follow
  bool moves_otherwise_;           ///< something is elsewhere than the scene alone says
  std::string warning_;
  bool is_told_ = false;  ///< the warning
};

}  // namespace neve::app::exports
