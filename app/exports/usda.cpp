#include "app/exports/usda.h"

#include <cctype>

#include "app/exports/axes.h"
#include "app/scene/read.h"
#include "app/support/version.h"

namespace neve::app::exports {

std::string usd_tuple(const sim::Vec3d& v) {
  std::string text = "(";
  for (int a = 0; a < 3; ++a) {
    append_text(static_cast<float>(v[a]), text);
    text += a < 2 ? ", " : ")";
  }
  return text;
}

std::string usd_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    // A line break would end the string.
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + "\"";
}

std::string usd_name(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    plain += is_plain ? c : '_';
  }
  const bool has_digit = !plain.empty() && std::isdigit(static_cast<unsigned char>(plain[0]));
  return plain.empty() || has_digit ? "n" + plain : plain;
}

std::string usd_header(const scene::Scene& scene, const scene::Export& spec, double first,
                       double last) {
  const std::string fps = usd_number(scene.fps);
  return "#usda 1.0\n(\n    defaultPrim = \"neve\"\n    doc = " +
         usd_string("neve " + std::string(version) + ": " + scene.title) +
         "\n    metersPerUnit = " + usd_number(1 / spec.scale) + "\n    upAxis = \"" +
         (spec.up == scene::UpAxis::z ? "Z" : "Y") + "\"\n    timeCodesPerSecond = " + fps +
         "\n    framesPerSecond = " + fps + "\n    startTimeCode = " + usd_number(first) +
         "\n    endTimeCode = " + usd_number(last) + "\n)\n\n";
}

std::string usd_world(const scene::Scene& scene, const scene::Export& spec) {
  const std::optional<sim::Vec3d> offset = scene::world_offset(scene);
  if (!offset) return {};
  const sim::Vec3d moved = Axes(spec).scaled(*offset);
  return "    double3 xformOp:translate = (" + usd_number(moved.x()) + ", " +
         usd_number(moved.y()) + ", " + usd_number(moved.z()) +
         ")\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n";
}

}  // namespace neve::app::exports
