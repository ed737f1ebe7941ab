#include "app/exports/columns.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/exports/surface_table.h"
#include "app/scene/names.h"

namespace neve::app::exports {

namespace {

using scene::ExportAttribute;
using sim::Mat3d;
using sim::Vec3d;

/// Everything that a number of a particle follows from.
struct ColumnSource {
  const scene::Scene& scene;
  const Origins& origins;
  const State& state;
  Axes axes;
  const std::vector<std::size_t>& rows;  ///< indices of the particles that are written
  bool is_dust = false;                  ///< instead of snow

  double J(std::size_t p) const {
    return state.particles.F_E[p].determinant() * state.particles.J_P[p];
  }
};

template <class Value>
void append(const Value& value, std::vector<double>& numbers) {
  if constexpr (std::is_same_v<Value, Vec3d>) {
    numbers.insert(numbers.end(), value.data(), value.data() + 3);
  } else if constexpr (std::is_same_v<Value, Mat3d>) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) numbers.push_back(value(a, b));
  } else {
    numbers.push_back(value);
  }
}

/// @param value  of a particle by its index: a number, a vector or a tensor
template <class Value>
std::vector<double> values_of(const ColumnSource& source, const Value& value) {
  std::vector<double> numbers;
  numbers.reserve(source.rows.size());
  for (const std::size_t p : source.rows) append(value(p), numbers);
  return numbers;
}

enum class NumberKind { of_state, computed, whole };

Numbers converted(std::vector<double> values, NumberKind kind, bool is_single) {
  if (kind == NumberKind::whole) return std::vector<std::int32_t>(values.begin(), values.end());
  if (kind == NumberKind::computed || !is_single) return values;
  std::vector<float> numbers;
  numbers.reserve(values.size());
  for (const double value : values) numbers.push_back(static_cast<float>(value));
  return numbers;
}

struct ColumnForm {
  const char* unit;
  int components;
  NumberKind kind;
};

ColumnForm form_of(ExportAttribute attribute) {
  using enum NumberKind;
  switch (attribute) {
    case ExportAttribute::x:
      return {"m", 3, computed};
    case ExportAttribute::v:
      return {"m/s", 3, of_state};
    case ExportAttribute::m:
      return {"kg", 1, of_state};
    case ExportAttribute::V0:
      return {"m3", 1, of_state};
    case ExportAttribute::density:
      return {"kg/m3", 1, computed};
    case ExportAttribute::J_E:
      return {"", 1, computed};
    case ExportAttribute::J_P:
      return {"", 1, of_state};
    case ExportAttribute::F_E:
      return {"", 9, of_state};
    case ExportAttribute::stress:
      return {"Pa", 9, computed};
    case ExportAttribute::kirchhoff:
      return {"Pa", 9, of_state};
    case ExportAttribute::C:
      return {"1/s", 9, of_state};
    case ExportAttribute::radius:
      return {"m", 1, computed};
    case ExportAttribute::age:
      return {"s", 1, computed};
    default:  // id, material, body
      return {"", 1, whole};
  }
}

std::vector<double> tensors_of(const ColumnSource& s, const std::vector<Mat3d>& list) {
  return values_of(s, [&](std::size_t p) { return s.axes.tensor(list[p]); });
}

/// Radius of the ball that the particle fills undeformed, m.
double radius_of(double V0) {
  return std::cbrt(3 * V0 / (4 * std::numbers::pi));
}

std::vector<double> values_of(ExportAttribute attribute, const ColumnSource& s) {
  const sim::ParticleArrays& a = s.state.particles;
  const auto each = [&](const auto& value) { return values_of(s, value); };
  switch (attribute) {
    case ExportAttribute::id:
      return each([&](std::size_t p) { return double(a.id_of(p)); });
    case ExportAttribute::x:
      return each([&](std::size_t p) { return s.axes.placed(a.x[p]); });
    case ExportAttribute::v:
      return each([&](std::size_t p) { return s.axes.scaled(a.v[p]); });
    case ExportAttribute::m:
      return each([&](std::size_t p) { return a.m[p]; });
    case ExportAttribute::V0:
      return each([&](std::size_t p) { return a.V0[p]; });
    case ExportAttribute::density:
      return each([&](std::size_t p) { return a.m[p] / a.V0[p] / s.J(p); });
    case ExportAttribute::J_E:
      return each([&](std::size_t p) { return a.F_E[p].determinant(); });
    case ExportAttribute::J_P:
      return each([&](std::size_t p) { return a.J_P[p]; });
    case ExportAttribute::F_E:
      return tensors_of(s, a.F_E);
    case ExportAttribute::stress:
      return each(
          [&](std::size_t p) { return Mat3d(s.axes.tensor(s.state.kirchhoff[p]) / s.J(p)); });
    case ExportAttribute::kirchhoff:
      return tensors_of(s, s.state.kirchhoff);
    case ExportAttribute::C:
      return tensors_of(s, a.C);
    case ExportAttribute::material:
      return each([&](std::size_t p) { return double(a.material[p]); });
    case ExportAttribute::body:
      return each([&](std::size_t p) { return double(s.origins.body_of(a.id_of(p))); });
    case ExportAttribute::radius:
      return each([&](std::size_t p) { return s.axes.scale() * radius_of(a.V0[p]); });
    case ExportAttribute::age:
      if (s.is_dust) return each([&](std::size_t p) { return s.state.dust.age[p]; });
      return each([&](std::size_t p) {
        const std::uint32_t id = a.id_of(p);
        const bool is_known = s.state.waiting.empty() || !s.origins.is_born(id);
        return is_known ? s.state.time - s.origins.birth_of(id) : NAN;
      });
  }
  return {};
}

bool is_single(const scene::Scene& scene) {
  return scene.solver.precision == sim::Precision::single;
}

/// Formats that hold no attributes of points.
bool has_places_only(const scene::Export& e) {
  return e.format == scene::ExportFormat::obj || e.format == scene::ExportFormat::vdb;
}

Numbers numbers_of_type(std::vector<double> values, sim::files::PointColumn::Type type) {
  using Type = sim::files::PointColumn::Type;
  if (type == Type::int32) return converted(std::move(values), NumberKind::whole, true);
  return converted(std::move(values), NumberKind::of_state, type == Type::real32);
}

sim::files::PointColumn::Type type_of(const sim::files::PointColumn* column) {
  return column ? column->type : sim::files::PointColumn::Type::real64;
}

/// Numbers of a file's column, in the type that they have there.
Numbers carried_numbers(const ColumnSource& s, const Carried& carried, const std::string& name) {
  const sim::files::PointColumn* column = carried.find(name);
  const auto value_of = [&](std::size_t p) {
    const std::uint32_t id = s.state.particles.id_of(p);
    return column && id < column->value.size() ? column->value[id] : 0;
  };
  return numbers_of_type(values_of(s, value_of), type_of(column));
}

std::vector<ExportAttribute> attributes_of(const scene::Export& e) {
  if (has_places_only(e)) return {ExportAttribute::x};
  std::vector<ExportAttribute> list = e.attributes;
  if (e.dust) std::erase_if(list, [](ExportAttribute a) { return !scene::is_of_dust(a); });
  if (std::find(list.begin(), list.end(), ExportAttribute::x) == list.end())
    list.insert(list.begin(), ExportAttribute::x);
  return list;
}

}  // namespace

std::string component_name(const Column& column, int component) {
  static constexpr const char* axes[] = {"x", "y", "z"};
  if (column.components == 1) return column.name;
  if (column.attribute == ExportAttribute::x) return axes[component];
  if (column.components == 3) return column.name + axes[component];
  return column.name + "_" + axes[component / 3] + axes[component % 3];
}

const char* type_name(const Column& column) {
  static constexpr const char* types[] = {"float32", "float64", "int32"};
  return types[column.numbers.index()];
}

std::size_t number_size(const Column& column) {
  return column.numbers.index() == 1 ? 8 : 4;
}

const Column* Table::find(ExportAttribute attribute) const {
  for (const Column& column : columns)
    if (column.attribute == attribute) return &column;
  return nullptr;
}

const std::vector<double>& Table::places() const {
  return std::get<std::vector<double>>(find(ExportAttribute::x)->numbers);
}

Table make_table(const scene::Scene& scene, const scene::Export& e, const Origins& origins,
                 const Carried& carried, const State& state) {
  const std::vector<std::size_t> rows = origins.rows_of(e.bodies, state.particles);
  const ColumnSource source{scene, origins, state, Axes(scene, e), rows, e.dust};
  Table table = empty_table(scene, e, carried);
  table.rows = rows.size();
  for (Column& column : table.columns)
    column.numbers = column.attribute ? converted(values_of(*column.attribute, source),
                                                  form_of(*column.attribute).kind, is_single(scene))
                                      : carried_numbers(source, carried, column.name);
  if (e.surface) return surface_table(scene, e, state, rows, table);
  return table;
}

Table empty_table(const scene::Scene& scene, const scene::Export& e, const Carried& carried) {
  Table table;
  for (const ExportAttribute attribute : attributes_of(e)) {
    const ColumnForm form = form_of(attribute);
    table.columns.push_back({attribute, scene::name(attribute), form.unit, form.components,
                             converted({}, form.kind, is_single(scene))});
  }
  if (has_places_only(e)) return table;
  for (const std::string& name : e.carried)
    table.columns.push_back(
        {std::nullopt, name, "", 1, numbers_of_type({}, type_of(carried.find(name)))});
  return table;
}

}  // namespace neve::app::exports
