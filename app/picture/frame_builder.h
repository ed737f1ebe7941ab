#pragma once
/// The only place where simulation data becomes a frame of the renderer, and double becomes float.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/health/diagnosis.h"
#include "app/picture/snapshot.h"
#include "app/picture/stage_look.h"
#include "app/setup/camera_path.h"
#include "app/setup/plan.h"
#include "app/setup/seed_scene.h"
#include "render/frame/frame.h"
#include "sim/simulation.h"

namespace neve::app::picture {

/// Inputs of a picture besides the scene.
struct PictureOptions {
  setup::Quality quality = setup::Quality::preview;
  std::vector<std::string> overrides = {};   ///< "material.snow.hardening=5", for the caption
  double coarsening = 1;                     ///< factor of --coarsen, for the caption
  std::vector<std::string> prediction = {};  ///< lines of --predict, for the caption
};

class FrameBuilder {
 public:
  /// @param scene resolved: it has cameras and ranges; its views are ignored
  /// @param scene, seeded outlive the builder
  FrameBuilder(const scene::Scene& scene, const setup::SeededScene& seeded,
               PictureOptions options = {});

  /// @param points of a frame that was built before from the same snapshot and view, except for
  /// the camera and the size: taken as they are, since they cost most to make
  render::Frame build(const scene::View& view, const Snapshot& snapshot,
                      std::optional<render::Points> points = std::nullopt) const;

  /// Extra lines of the caption of such a picture: rule, cause, evidence, remedy.
  static std::vector<std::string> incident_lines(const sim::Divergence& divergence,
                                                 const health::Diagnosis& diagnosis);

  /// The same picture with rings around the particles that broke a rule.
  render::Frame build_incident(const scene::View& view, const Snapshot& snapshot,
                               const sim::Divergence& divergence,
                               const health::Diagnosis& diagnosis,
                               std::optional<render::Points> points = std::nullopt) const;

  /// Title, frame and time, particles and steps, prediction and overrides; one line each.
  std::vector<std::string> caption(const Snapshot& snapshot) const;

  /// Frames, cells, materials and overrides, for the first picture of a film; one line each.
  std::vector<std::string> slate() const;

 private:
  void add_points(const scene::View& view, const Snapshot& snapshot,
                  const std::optional<StageLook>& look, render::Frame& frame) const;
  /// Returns the look of the stage; nothing if none is looked at.
  std::optional<StageLook> stage_look(const scene::View& view, const Snapshot& snapshot) const;
  void add_grid(const scene::View& view, const Snapshot& snapshot, render::Frame& frame) const;
  void add_bounds(const Snapshot& snapshot, render::Frame& frame) const;
  /// Particles of a body: the first and the one after the last.
  std::pair<std::size_t, std::size_t> particles_of(std::size_t body,
                                                   const Snapshot& snapshot) const;
  /// Caption, counter and slate, as the layers say.
  std::vector<std::string> words(const scene::View& view, const Snapshot& snapshot) const;

  const scene::Scene& scene_;
  const setup::SeededScene& seeded_;
  PictureOptions options_;
};

/// The place of the view's camera, or the scene's, at the time of a snapshot.
setup::CameraPlace camera_place(const scene::Scene& scene, const scene::View& view,
                                const setup::SeededScene& seeded, const Snapshot& snapshot);

/// The same as the renderer takes it.
render::Camera camera_of(const scene::Scene& scene, const scene::View& view,
                         const setup::SeededScene& seeded, const Snapshot& snapshot);

/// The plane of the view's slice, where what it follows has taken it.
SlicePlane plane_of(const scene::Scene& scene, const scene::View& view,
                    const setup::SeededScene& seeded, const Snapshot& snapshot);

}  // namespace neve::app::picture
