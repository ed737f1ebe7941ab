#pragma once
/// Reading of reference vectors: step_*.json, traj_*/ and unit.json of one folder, NEVE_ORACLE_DIR
/// or the set that comes with the sources.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/laws/cam_clay.h"
#include "sim/laws/list.h"
#include "sim/simulation.h"

namespace oracle {

using neve::sim::Mat3d;
using neve::sim::Vec3d;
using neve::sim::Vec3i;
using Json = nlohmann::json;
namespace fs = std::filesystem;

inline fs::path folder() {
  const char* chosen = std::getenv("NEVE_ORACLE_DIR");
  return chosen && *chosen ? fs::path(chosen) : fs::path(NEVE_ORACLE_DEFAULT);
}

inline Json read_json(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return Json::parse(file);
}

/// Entries of the folder whose names start with `prefix` (and end with `suffix`), sorted.
inline std::vector<fs::path> entries(const std::string& prefix, const std::string& suffix) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder())) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with(prefix) && file.ends_with(suffix)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline Vec3d vec3(const Json& j) {
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}
inline Mat3d mat3(const Json& j) {
  Mat3d m;
  for (int a = 0; a < 3; ++a) m.row(a) = vec3(j[static_cast<std::size_t>(a)]).transpose();
  return m;
}
template <class Convert>
auto list(const Json& j, Convert convert) {
  std::vector<decltype(convert(j))> out;
  for (const Json& item : j) out.push_back(convert(item));
  return out;
}

inline neve::sim::shapes::Collider collider(const Json& j) {
  using namespace neve::sim;
  shapes::Collider c;
  c.name = j["shape"].get<std::string>();
  const Vec3d point = vec3(j["point"]);
  if (c.name == "half_space") {
    c.shape.form = shapes::Plane{point, vec3(j["normal"])};
  } else if (c.name == "sphere") {
    c.shape.form = shapes::Sphere{point, j["radius"].get<double>()};
  } else {
    c.shape.form = shapes::Box{point, 2 * vec3(j["half"])};
    const Vec3d zyx = mat3(j["rotation"]).eulerAngles(2, 1, 0) * (180.0 / EIGEN_PI);
    c.shape.rotation = Vec3d(zyx[2], zyx[1], zyx[0]);
  }
  c.contact = j["mode"] == "sticky" ? shapes::Contact::sticky : shapes::Contact::separate;
  c.friction = j["friction"].get<double>();
  c.velocity = vec3(j["velocity"]);
  c.angular_velocity = vec3(j["omega"]);
  return c;
}

/// False for a law, or a flow rule, that is not here.
inline bool is_known(const Json& material) {
  if (!material.contains("model")) return true;
  const std::string model = material["model"];
  if (model == "cam_clay")
    return (material["flow"] == "radial" || material["flow"] == "isochoric") &&
           material["plastic"].get<bool>();
  if (model == "sand")
    return material["volume_correction"].get<bool>() && material["plastic"].get<bool>();
  return model == "corotated" || model == "neo_hookean";
}

/// The reference starts from alpha0, and neve from the pressure that belongs to it.
inline neve::sim::Material cam_clay_material(const Json& j) {
  namespace cam_clay = neve::sim::laws::cam_clay;
  neve::sim::Material m;
  m.model = neve::sim::laws::model::cam_clay;
  m.youngs_modulus = j["E"].get<double>();
  m.poisson_ratio = j["nu"].get<double>();
  m.friction_angle = neve::sim::laws::friction_angle(j["M"].get<double>());
  m.own[cam_clay::flow] = j["flow"] == "isochoric" ? cam_clay::isochoric : cam_clay::radial;
  m.own[cam_clay::cohesion] = j["beta"].get<double>();
  m.own[cam_clay::consolidation_hardening] = j["xi"].get<double>();
  m.consolidation_pressure =
      neve::sim::bulk_modulus(m) *
      (j["small"].get<double>() +
       std::sinh(-m.own[cam_clay::consolidation_hardening] * j["alpha0"].get<double>()));
  m.min_J_P = 1e-9, m.max_J_P = 1e9;  // the reference bounds nothing
  return m;
}

inline neve::sim::Material sand_material(const Json& j) {
  neve::sim::Material m;
  m.model = neve::sim::laws::model::sand;
  m.youngs_modulus = j["E"].get<double>();
  m.poisson_ratio = j["nu"].get<double>();
  m.friction_angle = j["friction_angle"].get<double>();
  m.max_J_P = 1e9;
  return m;
}

inline neve::sim::Material material(const Json& j) {
  using namespace neve::sim;
  if (j["model"] == "sand") return sand_material(j);
  if (j["model"] == "cam_clay") return cam_clay_material(j);
  Material m;
  const bool is_plastic = j["plastic"].get<bool>();
  m.model = j["model"] == "neo_hookean" ? laws::model::neo_hookean
            : is_plastic                ? laws::model::snow
                                        : laws::model::corotated;
  m.youngs_modulus = j["E"].get<double>();
  m.poisson_ratio = j["nu"].get<double>();
  m.hardening = j["xi"].get<double>();
  m.critical_compression = j["theta_c"].get<double>();
  m.critical_stretch = j["theta_s"].get<double>();
  m.yields = m.model == laws::model::neo_hookean && is_plastic;
  return m;
}

/// Cam clay and sand, whose history the vectors call alpha.
inline bool has_alpha(const neve::sim::Material& material) {
  return material.model == neve::sim::laws::model::cam_clay ||
         material.model == neve::sim::laws::model::sand;
}
/// alpha at J_P = 1.
inline double alpha_at_rest(const neve::sim::Material& material) {
  return material.model == neve::sim::laws::model::cam_clay
             ? neve::sim::laws::cam_clay::alpha0(material)
             : 0;
}

/// F_E as far as the law knows it: these two know it up to a rotation on the right, so b.
inline Mat3d strain_of(const neve::sim::Material& material, const Mat3d& F_E) {
  return has_alpha(material) ? Mat3d(F_E * F_E.transpose()) : F_E;
}

/// A scene of the reference as settings. A node is that of the reference plus `first_node`.
struct Setup {
  neve::sim::SolverSettings settings;
  neve::sim::Material material;
  std::vector<neve::sim::shapes::Collider> colliders;
  Vec3i first_node;
  double dt = 0;
};

inline Setup setup(const Json& scene, neve::sim::Precision precision) {
  using namespace neve::sim;
  Setup s;
  s.settings.precision = precision;
  s.settings.shock_viscosity = 0;  // the reference is the paper alone
  s.settings.cell_size = scene["grid"]["h"].get<double>();
  const Vec3d origin = vec3(scene["grid"]["origin"]) / s.settings.cell_size;
  for (int a = 0; a < 3; ++a) s.first_node[a] = static_cast<int>(std::lround(origin[a]));
  s.settings.kernel = scene["kernel"] == "cubic" ? Kernel::cubic : Kernel::quadratic;
  const std::string transfer = scene["transfer"];
  s.settings.transfer = transfer == "flip"   ? Transfer::flip
                        : transfer == "apic" ? Transfer::apic
                                             : Transfer::mls;
  s.settings.flip_ratio = scene["alpha"].get<double>();
  s.settings.flip_reference_dt = scene.value("flip_reference_dt", 0.0);
  s.settings.contact_at = ContactAt::nodes;
  s.settings.advect = scene["advect"] == "pic" ? Advect::pic : Advect::particle;
  s.settings.time_step = TimeStep::fixed;
  s.settings.gravity = vec3(scene["gravity"]);
  s.dt = s.settings.dt = scene["dt"].get<double>();
  s.material = material(scene["material"]);
  for (const Json& c : scene["colliders"]) s.colliders.push_back(collider(c));
  s.settings.beta = scene["beta"].get<double>();
  s.settings.collide_after_solve = scene["collide_after_solve"].get<bool>();
  // The reference solves to 1e-14. Float gets no further than rounding.
  s.settings.solve_tolerance = precision == Precision::real64 ? 1e-13 : 1e-6;
  s.settings.solve_iterations = 1000;
  s.settings.resting_mass = scene["mass_epsilon"].get<double>();
  return s;
}

/// J_P of particles. The files choose alpha apart from F_P; here it is alpha0 + ln J_P.
inline std::vector<double> plastic_volumes(const Json& j, const neve::sim::Material& material) {
  if (!has_alpha(material))
    return list(j["FP"], [](const Json& F) { return mat3(F).determinant(); });
  const double alpha0 = alpha_at_rest(material);
  return list(j["alpha"],
              [&](const Json& alpha) { return std::exp(alpha.get<double>() - alpha0); });
}

inline neve::sim::ParticleArrays particles(const Json& j, const neve::sim::Material& material) {
  neve::sim::ParticleArrays p;
  p.x = list(j["x"], vec3);
  p.v = list(j["v"], vec3);
  p.m = j["mass"].get<std::vector<double>>();
  // Missing values of a set are the initial values of a particle.
  const auto has = [&](const char* key) { return j.contains(key) && !j[key].is_null(); };
  if (has("volume0")) p.V0 = j["volume0"].get<std::vector<double>>();
  if (has("FE")) p.F_E = list(j["FE"], mat3);
  if (has(has_alpha(material) ? "alpha" : "FP")) p.J_P = plastic_volumes(j, material);
  if (has("C")) p.C = list(j["C"], mat3);
  return p;
}

/// Columns of a CSV file by name.
inline std::map<std::string, std::vector<double>> read_csv(const fs::path& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  std::getline(file, line);
  for (std::istringstream row(line); std::getline(row, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    for (const std::string& name : names) {
      std::getline(row, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}

/// Largest absolute difference over largest absolute expected value.
class RelativeError {
 public:
  void add(double expected, double found) {
    scale_ = std::max(scale_, std::abs(expected));
    const double difference = std::abs(expected - found);
    // NaN must count as the largest difference there is.
    worst_ = difference <= worst_ ? worst_ : difference;
    if (!(difference == difference)) worst_ = HUGE_VAL;
  }
  template <class A, class B>
  void add_all(const Eigen::MatrixBase<A>& expected, const Eigen::MatrixBase<B>& found) {
    for (Eigen::Index a = 0; a < expected.rows(); ++a)
      for (Eigen::Index b = 0; b < expected.cols(); ++b) add(expected(a, b), found(a, b));
  }
  double value() const { return scale_ > 0 ? worst_ / scale_ : worst_; }
  double worst() const { return worst_; }

 private:
  double scale_ = 0, worst_ = 0;
};

}  // namespace oracle
