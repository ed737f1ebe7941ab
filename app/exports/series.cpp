#include "app/exports/series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/exports/bytes.h"
#include "app/scene/names.h"

namespace neve::app::exports {

const PlacedShape* Sample::find(const std::string& collider) const {
  const auto found = std::ranges::find(colliders, collider, &PlacedShape::collider);
  return found == colliders.end() ? nullptr : &*found;
}

const PlacedShape* Sample::find(const std::string& collider, std::size_t shape) const {
  const PlacedShape* const found = find(collider);
  return found && found->shape == shape ? found : nullptr;
}

double time_in_frames(const scene::Scene& scene, double time) {
  constexpr double rounding = 1e-6;
  const double frames = time * scene.fps, whole = std::round(frames);
  return (std::abs(frames - whole) <= rounding ? whole : frames) + scene::number_of(scene, 0);
}

std::string file_name(const scene::Export& spec, int number) {
  return fmt::format("{:04}.{}", number, scene::name(spec.format));
}

std::string series_name(const scene::Export& spec) {
  switch (spec.format) {
    case scene::ExportFormat::vtp:
    case scene::ExportFormat::vti:
      return scene::folder_of(spec) + ".pvd";
    case scene::ExportFormat::usda:
      return scene::folder_of(spec) + ".usda";
    default:
      return {};
  }
}

std::string encode_pvd(const scene::Export& spec, const std::vector<Sample>& samples) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const Sample& sample : samples) {
    text += "<DataSet timestep=\"";
    append_text(sample.time, text);
    text += "\" part=\"0\" file=\"" + scene::folder_of(spec) + "/" +
            file_name(spec, sample.number) + "\"/>\n";
  }
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace neve::app::exports
