#include "app/view/session/objects.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "app/scene/leaf.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/support/round_number.h"
#include "sim/types/errors.h"

namespace neve::app::view::session {

namespace {

using scene::toml::Table;
using scene::toml::Value;
using sim::Vec3d;
using sim::shapes::Bounds;
using sim::shapes::Plane;
using sim::shapes::Shape;

/// Half of the extent of a new object, in cells.
constexpr double fewest_cells = 4, max_cells = 10;

struct Kind {
  const char* list;
  const char* name;
  const char* title;
};

Kind kind_of(NewObject object) {
  constexpr Kind kinds[] = {{"body", "ball", "Body: a sphere"},
                            {"body", "block", "Body: a box"},
                            {"emitter", "emitter", "Emitter of snow"},
                            {"sink", "sink", "Sink for snow"},
                            {"collider", "sphere", "Collider: a sphere"},
                            {"collider", "box", "Collider: a box"},
                            {"collider", "floor", "Floor"}};  // in the order of NewObject
  return kinds[static_cast<std::size_t>(object)];
}

/// Every shape of a list with the name of its object.
template <class Use>
void each_shape(const scene::Scene& scene, const std::string& list, Use use) {
  const auto all = [&](const auto& items) {
    for (const auto& item : items) use(item.name, item.shape);
  };
  if (list == "body") all(scene.bodies);
  if (list == "emitter") all(scene.emitters);
  if (list == "sink") all(scene.sinks);
  if (list == "collider") all(scene.colliders);
}

std::string free_name(const scene::Scene& scene, const std::string& list, std::string wanted) {
  std::vector<std::string> taken;
  each_shape(scene, list, [&](const std::string& name, const Shape&) { taken.push_back(name); });
  const auto is_taken = [&](const std::string& name) {
    return std::find(taken.begin(), taken.end(), name) != taken.end();
  };
  if (!is_taken(wanted)) return wanted;
  // The copy of ball_2 is ball_3.
  const std::size_t tail = wanted.find_last_not_of("0123456789");
  if (tail == std::string::npos)
    wanted = list;  // it had no name
  else if (wanted[tail] == '_' && tail > 0 && tail + 1 < wanted.size())
    wanted.resize(tail);
  std::size_t number = 2;
  while (is_taken(wanted + "_" + std::to_string(number))) ++number;
  return wanted + "_" + std::to_string(number);
}

/// Returns the bounds of a shape; nothing for a plane, and for a mesh that cannot be read.
std::optional<Bounds> bounds_of(const Shape& shape) {
  if (std::holds_alternative<Plane>(shape.form)) return std::nullopt;
  try {
    return sim::shapes::bounds(shape);
  } catch (const sim::ShapeError&) {
    return std::nullopt;
  }
}

/// The way up, m, that a box has to go to be clear of a shape; 0: it is.
double rise_above(const Shape& shape, const Vec3d& at, const Vec3d& half) {
  if (const auto* plane = std::get_if<Plane>(&shape.form)) {
    const Vec3d normal = plane->normal.normalized();
    const double reach = normal.cwiseAbs().dot(half), distance = (at - plane->point).dot(normal);
    return normal.y() > 0.1 && distance < reach ? (reach - distance) / normal.y() : 0;
  }
  const std::optional<Bounds> other = bounds_of(shape);
  if (!other) return 0;
  const bool is_apart = ((at + half).array() <= other->min.array()).any() ||
                        ((at - half).array() >= other->max.array()).any();
  return is_apart ? 0 : other->max.y() + half.y() - at.y();
}

Vec3d free_place(const scene::Scene& scene, Vec3d at, const Vec3d& half) {
  constexpr int max_rises = 100;
  const Vec3d slack = half * (1 - 1e-6);  // what touches is free
  for (int k = 0; k < max_rises; ++k) {
    double rise = 0;
    for (const char* list : {"body", "emitter", "collider"})
      each_shape(scene, list, [&](const std::string&, const Shape& shape) {
        rise = std::max(rise, rise_above(shape, at, slack));
      });
    if (rise == 0) break;
    at.y() += rise;
  }
  return at;
}

std::string literal(const Vec3d& value) {
  return scene::toml::toml_literal(scene::to_value(value));
}

double lowest(const scene::Scene& scene) {
  double low = 0;
  for (const char* list : {"body", "emitter", "collider"})
    each_shape(scene, list, [&](const std::string&, const Shape& shape) {
      if (const std::optional<Bounds> bounds = bounds_of(shape))
        low = std::min(low, bounds->min.y());
    });
  return low;
}

std::string round_shape(const char* form, const Vec3d& center, double radius) {
  return std::string("{ ") + form + " = { center = " + literal(center) +
         ", radius = " + scene::toml::number_text(radius) + " } }";
}

std::string box_shape(const Vec3d& center, const Vec3d& size) {
  return "{ box = { center = " + literal(center) + ", size = " + literal(size) + " } }";
}

/// Adds to the vector at an address of a table, where it is or with its default.
void move_place(Table& table, const std::string& address, const Vec3d& place) {
  Table* inside = &table;
  const std::vector<std::string> words = scene::words_of(address);
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    scene::toml::Entry* entry = inside->find(words[k]);
    inside = entry ? std::get_if<Table>(&entry->value.data) : nullptr;
    if (!inside) return;
  }
  if (scene::toml::Entry* entry = inside->find(words.back()))
    entry->value = scene::to_value(place);
  else
    inside->entries.push_back({words.back(), {}, scene::to_value(place)});
}

/// The table of an object as the text and the edits have it.
std::optional<Table> written_object(const Document& document, const std::string& address) {
  Table root = scene::toml::parse_toml(document.text(), document.file());
  for (const scene::Override& edit : document.all_overrides())
    if (scene::object_of(edit.address) == address) scene::apply_override(root, edit, 0);
  const Value* value = scene::value_at(root, address);
  const Table* table = value ? std::get_if<Table>(&value->data) : nullptr;
  return table ? std::optional(*table) : std::nullopt;
}

/// Returns the way from an object to its copy: beside it, and for snow above what exists.
Vec3d way_of_copy(const scene::Scene& scene, const std::string& list, const Shape& shape) {
  const double cell = scene.solver.cell_size;
  if (const auto* plane = std::get_if<Plane>(&shape.form))
    return -max_cells * cell * plane->normal.normalized();
  const std::optional<Bounds> bounds = bounds_of(shape);
  if (!bounds) return Vec3d::Zero();
  const Vec3d half = 0.5 * (bounds->max - bounds->min), middle = bounds->min + half;
  const double way = round_up(2 * half.x() + cell);
  const Vec3d beside = middle + way * Vec3d::UnitX();
  const bool is_snow = list == "body" || list == "emitter";
  return is_snow ? Vec3d(free_place(scene, beside, half) - middle) : Vec3d(beside - middle);
}

void move_keyframes(Table& table, const std::vector<sim::shapes::PoseKeyframe>& keyframes,
                    const Vec3d& way) {
  scene::toml::Entry* entry = table.find("keyframes");
  auto* list = entry ? std::get_if<scene::toml::Array>(&entry->value.data) : nullptr;
  if (!list) return;
  for (std::size_t k = 0; k < std::min(list->size(), keyframes.size()); ++k)
    if (auto* frame = std::get_if<Table>(&(*list)[k].data); frame && keyframes[k].position)
      move_place(*frame, "position", *keyframes[k].position + way);
}

}  // namespace

const char* title_of(NewObject object) {
  return kind_of(object).title;
}

std::vector<std::pair<std::string, Vec3d>> places_of(const Shape& shape) {
  constexpr const char* forms[] = {"sphere",        "box",    "capsule", "cylinder",
                                   "cone",          "torus",  "plane",   "mesh",
                                   "mesh_sequence", "points", "terrain", "cover"};
  static_assert(std::size(forms) == std::variant_size_v<decltype(shape.form)>);
  const std::string form = std::string(forms[shape.form.index()]) + ".";
  using Places = std::vector<std::pair<std::string, Vec3d>>;
  return std::visit(
      [&](const auto& s) -> Places {
        if constexpr (requires { s.center; })
          return {{form + "center", s.center}};
        else if constexpr (requires { s.point; })
          return {{form + "point", s.point}};
        else
          return {{form + "a", s.a}, {form + "b", s.b}};
      },
      shape.form);
}

std::vector<std::pair<std::string, Vec3d>> places_of(const scene::Collider& collider) {
  std::vector<std::pair<std::string, Vec3d>> places;
  for (const auto& [place, value] : places_of(collider.shape))
    places.emplace_back("shape." + place, value);
  using sim::shapes::Joint;
  const sim::shapes::RigidBody& body = collider.body;
  if (body.joint == Joint::ball || body.joint == Joint::hinge)
    places.emplace_back("joint_point", body.joint_point);
  if (body.spring_stiffness > 0 || body.spring_damping > 0)
    places.emplace_back("spring_place", body.spring_place);
  return places;
}

AddedObject new_object(const scene::Scene& scene, NewObject object, const Vec3d& near,
                       double size) {
  const Kind kind = kind_of(object);
  const double cell = scene.solver.cell_size;
  const double wanted = std::clamp(size, fewest_cells * cell, max_cells * cell);
  const double half = round_to(wanted, wanted, 2);
  const double step = std::pow(10, std::floor(std::log10(half)) - 1);
  const auto rounded = [&](const Vec3d& at) {
    return Vec3d(step * std::round(at.x() / step), step * std::ceil(at.y() / step - 1e-6),
                 step * std::round(at.z() / step));
  };
  // A cell of air keeps the snow of two bodies apart.
  Vec3d at = rounded(near);
  if (object != NewObject::sink)
    at = rounded(free_place(scene, at, Vec3d::Constant(half + 1.5 * cell)));
  AddedObject added;
  added.address = std::string(kind.list) + "." + free_name(scene, kind.list, kind.name);
  const Vec3d edges = Vec3d::Constant(2 * half);
  std::string shape, rest;
  if (object == NewObject::snow_ball || object == NewObject::sphere) {
    shape = round_shape("sphere", at, half);
  } else if (object == NewObject::floor) {
    shape = "{ plane = { point = " + literal({0, lowest(scene), 0}) + ", normal = [0, 1, 0] } }";
  } else if (object == NewObject::emitter) {
    constexpr double speed = 2, share = 0.25;  // m/s; of the density of packed snow
    const double mass = share * sim::Material{}.density * 4 * half * half * speed;
    shape = box_shape(at, {2 * half, half, 2 * half});
    rest = ", velocity = " + literal({0, -speed, 0}) +
           ", rate = " + scene::toml::number_text(round_to(mass, mass, 2));
  } else {
    shape = box_shape(at, edges);
  }
  added.value = "{ shape = " + shape + rest + " }";
  return added;
}

AddedObject thrown_ball(const scene::Scene& scene, const Throw& ball) {
  // Five digits are as exact as a hand.
  const auto rounded = [](const Vec3d& v) {
    const double size = v.cwiseAbs().maxCoeff();
    const double step = size > 0 ? std::pow(10, std::floor(std::log10(size)) - 4) : 1;
    return Vec3d(step * std::round(v.x() / step), step * std::round(v.y() / step),
                 step * std::round(v.z() / step));
  };
  return {"collider." + free_name(scene, "collider", "thrown"),
          "{ shape = " + round_shape("sphere", rounded(ball.from), ball.radius) +
              ", density = " + scene::toml::number_text(ball.density) +
              ", velocity = " + literal(rounded(ball.velocity)) + " }"};
}

AddedObject copy_of(const Document& document, const std::string& address) {
  const std::string list = address.substr(0, address.find('.'));
  const std::string name = address.substr(list.size() + 1);
  const scene::Scene& scene = *document.scene();
  std::optional<Table> table = written_object(document, address);
  const Shape* shape = nullptr;
  each_shape(scene, list, [&](const std::string& other, const Shape& its) {
    if (other == name) shape = &its;
  });
  if (!table || !shape) throw UsageError("", "there is no " + address, "select one of the list");
  const Vec3d way = way_of_copy(scene, list, *shape);
  const auto collider = std::ranges::find(scene.colliders, name, &scene::Collider::name);
  if (list != "collider") {
    for (const auto& [place, value] : places_of(*shape))
      move_place(*table, "shape." + place, value + way);
  } else {
    for (const auto& [place, value] : places_of(*collider)) move_place(*table, place, value + way);
    move_keyframes(*table, collider->keyframes, way);
  }
  std::erase_if(table->entries,
                [](const scene::toml::Entry& entry) { return entry.key == "name"; });
  return {list + "." + free_name(scene, list, name), scene::toml::toml_literal({*table})};
}

}  // namespace neve::app::view::session
