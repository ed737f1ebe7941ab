#pragma once
/// Places of the things of a USD stage at its times. USD interpolates a matrix element by element,
/// which shrinks what turns: a path is a translation and a quaternion, and turns by little from one
/// of its places to the next.

#include <functional>
#include <string>
#include <vector>

#include "app/exports/axes.h"
#include "app/exports/series.h"

namespace neve::app::exports {

/// Place and attitude in the axes of the simulation.
struct Place {
  double time = 0;  ///< s
  sim::Mat3d rotation = sim::Mat3d::Identity();
  sim::Vec3d point{0, 0, 0};  ///< m
};

/// Every frame from the first file to the last one, and every file. Frames that are in neither list
/// are put in where the scene alone says where its colliders are.
/// @param between  frames without a file whose places were read, by time
std::vector<Sample> stage_samples(const scene::Scene& scene, const std::vector<Sample>& files,
                                  const std::vector<Sample>& between);

/// The path of a collider: its places at all samples, and more between two of them where it turns
/// by more than an eighth of a turn. Before and after its time it is where it is first and last.
/// @param samples  at least one of them has it
std::vector<Place> collider_path(const scene::Scene& scene, const std::string& collider,
                                 const std::vector<Sample>& samples);

/// The same of a thing whose place follows from the time alone.
std::vector<Place> path_of(const std::vector<Sample>& samples,
                           const std::function<Place(double time)>& place_at);

/// "name = value", or "name.timeSamples = { ... }" where values differ.
/// @param declared  type and name, indented @param values  one or more, with their times in s
std::string usd_property(const scene::Scene& scene, const std::string& declared,
                         const std::vector<std::pair<double, std::string>>& values);

/// The operations that place a prim: translate and orient.
std::string usd_placed(const scene::Scene& scene, const Axes& axes, const std::vector<Place>& path);

}  // namespace neve::app::exports
