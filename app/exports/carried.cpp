#include "app/exports/columns.h"

#include <algorithm>

namespace neve::app::exports {

namespace {

using sim::files::PointColumn;

std::vector<std::string> carried_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Export& e : scene.exports)
    for (const std::string& name : e.carried)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace

Carried::Carried(const scene::Scene& scene, const std::vector<std::size_t>& body_end) {
  const std::vector<std::string> names = carried_names(scene);
  if (names.empty()) return;
  for (std::size_t b = 0; b < body_end.size(); ++b) {
    const auto* points = std::get_if<sim::shapes::Points>(&scene.bodies[b].shape.form);
    if (!points) continue;
    const std::size_t first = b > 0 ? body_end[b - 1] : 0;
    for (const PointColumn& column : sim::shapes::placed_columns(*points, names))
      add(column, first, body_end.back());
  }
}

void Carried::add(const PointColumn& column, std::size_t first, std::size_t ids) {
  auto known = std::ranges::find(columns_, column.name, &PointColumn::name);
  if (known == columns_.end())
    known = columns_.insert(known, {column.name, column.type, std::vector<double>(ids)});
  // Files may disagree: doubles hold the numbers of both.
  if (known->type != column.type) known->type = PointColumn::Type::real64;
  const std::size_t count = std::min(column.value.size(), ids - first);
  std::copy_n(column.value.begin(), count,
              known->value.begin() + static_cast<std::ptrdiff_t>(first));
}

const PointColumn* Carried::find(const std::string& name) const {
  for (const PointColumn& column : columns_)
    if (column.name == name) return &column;
  return nullptr;
}

}  // namespace neve::app::exports
