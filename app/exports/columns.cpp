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
  const Origins& origins;
  const State& state;
  const sim::ParticleArrays& p;  ///< of the state
  Axes axes;
  bool is_dust = false;  ///< instead of snow

  double J(std::size_t k) const { return p.F_E[k].determinant() * p.J_P[k]; }
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

enum class NumberKind { of_state, computed, whole };

Numbers converted(std::vector<double> values, NumberKind kind, bool is_single) {
  if (kind == NumberKind::whole) return std::vector<std::int32_t>(values.begin(), values.end());
  if (kind == NumberKind::computed || !is_single) return values;
  std::vector<float> numbers;
  numbers.reserve(values.size());
  for (const double value : values) numbers.push_back(static_cast<float>(value));
  return numbers;
}

using From = const ColumnSource&;
using Index = std::size_t;
using To = std::vector<double>&;

/// The column of an attribute.
struct ColumnForm {
  ExportAttribute attribute;
  const char* unit;
  int components;
  NumberKind kind;
  void (*append)(From s, Index k, To to);  ///< the numbers of a particle
};

/// s, not-a-number where an emitter that waited gave birth to it.
double age_of(From s, Index k) {
  if (s.is_dust) return s.state.dust.age[k];
  const std::uint32_t id = s.p.id_of(k);
  const bool is_known = s.state.waiting.empty() || !s.origins.is_born(id);
  return is_known ? s.state.time - s.origins.birth_of(id) : NAN;
}

/// A factor of the particle; 1 where no particle has another one.
double factor_of(const std::vector<double>& factors, Index k) {
  return factors.empty() ? 1.0 : factors[k];
}

/// Radius of the ball that the particle fills undeformed, m.
double radius_of(double V0) {
  return std::cbrt(3 * V0 / (4 * std::numbers::pi));
}

const ColumnForm& form_of(ExportAttribute attribute) {
  using enum ExportAttribute;
  using enum NumberKind;
  static constexpr ColumnForm forms[] = {
      {id, "", 1, whole, [](From s, Index k, To to) { append(double(s.p.id_of(k)), to); }},
      {x, "m", 3, computed, [](From s, Index k, To to) { append(s.axes.placed(s.p.x[k]), to); }},
      {v, "m/s", 3, of_state, [](From s, Index k, To to) { append(s.axes.scaled(s.p.v[k]), to); }},
      {m, "kg", 1, of_state, [](From s, Index k, To to) { append(s.p.m[k], to); }},
      {V0, "m3", 1, of_state, [](From s, Index k, To to) { append(s.p.V0[k], to); }},
      {density, "kg/m3", 1, computed,
       [](From s, Index k, To to) { append(s.p.m[k] / s.p.V0[k] / s.J(k), to); }},
      {J_E, "", 1, computed, [](From s, Index k, To to) { append(s.p.F_E[k].determinant(), to); }},
      {J_P, "", 1, of_state, [](From s, Index k, To to) { append(s.p.J_P[k], to); }},
      {F_E, "", 9, of_state, [](From s, Index k, To to) { append(s.axes.tensor(s.p.F_E[k]), to); }},
      {stress, "Pa", 9, computed,
       [](From s, Index k, To to) {
         append(Mat3d(s.axes.tensor(s.state.kirchhoff[k]) / s.J(k)), to);
       }},
      {kirchhoff, "Pa", 9, of_state,
       [](From s, Index k, To to) { append(s.axes.tensor(s.state.kirchhoff[k]), to); }},
      {C, "1/s", 9, of_state, [](From s, Index k, To to) { append(s.axes.tensor(s.p.C[k]), to); }},
      {stiffness, "", 1, of_state,
       [](From s, Index k, To to) { append(factor_of(s.p.stiffness, k), to); }},
      {threshold, "", 1, of_state,
       [](From s, Index k, To to) { append(factor_of(s.p.threshold, k), to); }},
      {material, "", 1, whole, [](From s, Index k, To to) { append(double(s.p.material[k]), to); }},
      {body, "", 1, whole,
       [](From s, Index k, To to) { append(double(s.origins.body_of(s.p.id_of(k))), to); }},
      {radius, "m", 1, computed,
       [](From s, Index k, To to) { append(s.axes.scale() * radius_of(s.p.V0[k]), to); }},
      {age, "s", 1, computed, [](From s, Index k, To to) { append(age_of(s, k), to); }}};
  return *std::ranges::find(forms, attribute, &ColumnForm::attribute);
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

/// Numbers of a column: of an attribute, or of a file in the type that they have there.
Numbers numbers_of(const ColumnSource& s, const Column& column, const Carried& carried,
                   const std::vector<std::size_t>& rows, bool is_single) {
  std::vector<double> values;
  values.reserve(rows.size());
  if (column.attribute) {
    const ColumnForm& form = form_of(*column.attribute);
    for (const std::size_t k : rows) form.append(s, k, values);
    return converted(std::move(values), form.kind, is_single);
  }
  const sim::files::PointColumn* file = carried.find(column.name);
  for (const std::size_t k : rows) {
    const std::uint32_t id = s.p.id_of(k);
    values.push_back(file && id < file->value.size() ? file->value[id] : 0);
  }
  return numbers_of_type(std::move(values), type_of(file));
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
  const ColumnSource source{origins, state, state.particles, Axes(scene, e), e.dust};
  Table table = empty_table(scene, e, carried);
  table.rows = rows.size();
  for (Column& column : table.columns)
    column.numbers = numbers_of(source, column, carried, rows, is_single(scene));
  if (e.surface) return surface_table(scene, e, state, rows, table);
  return table;
}

Table empty_table(const scene::Scene& scene, const scene::Export& e, const Carried& carried) {
  Table table;
  for (const ExportAttribute attribute : attributes_of(e)) {
    const ColumnForm& form = form_of(attribute);
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
