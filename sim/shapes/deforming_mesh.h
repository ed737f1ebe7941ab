#pragma once
/// A closed mesh that deforms: files of one topology, and the mesh between them.

#include <memory>
#include <string>
#include <vector>

#include "sim/shapes/mesh_surface.h"

namespace neve::sim::shapes {

/// All files of a sequence, in metres about their origin. Vertices move on straight lines from file
/// to file; before the first and after the last they rest. Topology is that of the first file.
class DeformingMesh {
 public:
  /// @throws ShapeError for files that are missing, cannot be read, are no closed mesh or have
  ///         another topology, and for too many
  explicit DeformingMesh(const MeshSequence& sequence);

  /// A moment in one of the intervals between two files.
  struct Moment {
    std::size_t interval = 0;
    double part = 0;     ///< 0: at its first file, 1: at its second
    bool moves = false;  ///< false before the first file and after the last
  };
  /// @param time  s, of the scene where the mesh was never delayed
  Moment moment(double time) const;

  std::size_t intervals() const { return vertices_.size() - 1; }
  SolidMesh mesh(std::size_t interval, double part) const;
  SolidMesh mesh_at(double time) const;

  /// Velocity of a place of the surface between two files, m/s.
  /// @param triangle  that the place is on
  /// @param point     in the mesh of that moment
  Vec3d velocity(std::size_t interval, const SolidMesh& mesh, std::uint32_t triangle,
                 const Vec3d& point) const;

  /// Speed of the fastest vertex at any time from one to another, or ever, m/s.
  double fastest(double from, double to) const;
  double fastest() const;

  /// Returns the longest way of a vertex in an interval, m.
  double longest_way(std::size_t interval) const { return fastest_[interval] / rate_; }

  Bounds bounds(std::size_t interval) const;  ///< of all that is between two files
  Bounds bounds() const;                      ///< of all files
  double furthest() const;                    ///< m, of any vertex of any file from the origin
  /// Returns the thickness, m: twice the volume over the surface, which for a plate is its
  /// thickness; of the file where it is least, which is named.
  double thickness() const { return thickness_; }
  const std::string& thinnest_file() const { return thinnest_; }
  std::size_t bytes() const;
  const MeshReading& reading() const { return reading_; }  ///< of the first file

 private:
  void add(std::vector<Vec3d> vertices, const std::string& file);
  void measure_speeds();

  double rate_, start_;
  MeshReading reading_;  ///< of the first file
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::vector<Vec3d>> vertices_;  ///< m, of each file
  std::vector<double> volume_;                ///< m3, of each file
  std::vector<Bounds> bounds_;                ///< of each file
  std::vector<double> fastest_;               ///< m/s, of each interval
  double thickness_ = INFINITY;
  std::string thinnest_;
};

/// Returns the mesh, which is read once: later calls return the same one while it is in use or was
/// used lately, unless the first file, the last or their folder was written since. Threads may call
/// at the same time.
/// @throws ShapeError
std::shared_ptr<const DeformingMesh> deforming_mesh(const MeshSequence& sequence);

/// Returns the surface at a time, of the last few times that were asked for.
/// @throws ShapeError
std::shared_ptr<const MeshSurface> surface_at(const MeshSequence& sequence, double time);

}  // namespace neve::sim::shapes
