#pragma once
/// Every parameter of a scene, once. Code that reads, writes, sets or lists parameters is a visitor
/// of these functions; there is no second list.
///
/// A visitor has
///   visit(key, member, unit, valid, change, help)  a parameter; its type follows from the member
///   visit.section(key, help, describe_members)     a table that is always there
///   visit.optional(key, member, help)              a table that may be absent
///   visit.named(key, items, help)                  tables by name: [material.snow]
///   visit.list(key, items, help)                   [[body]], each with a name or its number
///   visit.sequence(key, items, help)               tables in a row that have no names: keyframes
///   visit.addresses(key, table, help)              a table whose keys are addresses (sweeps)
///   visit.address_lists(key, tables, help)         [[run]], each with addresses as keys (sweeps)
///   visit.shape(key, shape, help, describe_forms)  a table with exactly one form
///   visit.form<Form>(key, shape, change, help)     one of these forms
///   visit.shorthand(key, choice, use, help)        a choice that sets several parameters after it;
///                                                  `use` does, and it is never written itself
/// Nested tables are described by calling back with a visitor for them.

#include "app/scene/presets.h"
#include "app/scene/scene.h"
#include "app/scene/valid.h"
#include "sim/laws/law.h"
#include "sim/shapes/numbered_files.h"

namespace neve::app::scene {

namespace unit {
inline constexpr const char *none = "", *metre = "m", *second = "s", *per_second = "1/s",
                            *per_metre = "1/m", *diffusivity = "m2/s", *velocity = "m/s",
                            *acceleration = "m/s2", *spin = "rad/s", *density = "kg/m3",
                            *mass_rate = "kg/s", *pascal = "Pa", *degrees = "degrees",
                            *pixels = "px", *bytes = "B", *joule = "J", *newton = "N",
                            *kilogram = "kg", *inertia = "kg m2", *stiffness = "N/m",
                            *damping = "N s/m";
}

/// Beyond these bounds, single precision and 64-bit counts stop making sense.
inline constexpr Valid position = within(1e6);
inline constexpr Valid length = above(0).at_most(1e6);
/// Sizes of a shape have no default: one that is forgotten is a mistake.
inline constexpr Valid needed_length = length.required(), needed_position = position.required();
inline constexpr Valid map_position = within(1e8);
inline constexpr Valid speed = within(1e6);
inline constexpr Valid file_number = between(0, sim::shapes::max_file_number);
inline constexpr double max_count = 0x1p53;  // JSON and double keep whole numbers up to here

/// The item that a new entry of a list starts from.
template <class T>
T fresh() {
  return T{};
}
template <>
inline sim::seeding::Body fresh<sim::seeding::Body>() {
  sim::seeding::Body body;
  body.material = sim::Material{}.name;
  return body;
}
template <>
inline sim::seeding::Emitter fresh<sim::seeding::Emitter>() {
  sim::seeding::Emitter emitter;
  emitter.material = sim::Material{}.name;
  return emitter;
}
template <>
inline View fresh<View>() {
  View view;
  view.name.clear();
  return view;
}

template <class V>
void describe(V& visit, sim::SolverSettings& s) {
  using enum Change;
  visit("cell_size", s.cell_size, unit::metre, at_least(1e-9).at_most(1e6), restart,
        "Spacing h of the grid.");
  visit("threshold_cell", s.threshold_cell, unit::metre, at_least(1e-9).at_most_or_0(1e6), live,
        "Cell for which thresholds and cohesion are meant: in others they are scaled to keep the "
        "energy of cracks; 0: any.");
  visit("kernel", s.kernel, unit::none, anything, live,
        "B-spline that carries data between particles and grid.");
  visit("transfer", s.transfer, unit::none, anything, live,
        "Transfer of velocity between particles and grid; all but flip keep the spin of small "
        "pieces.");
  visit("flip_ratio", s.flip_ratio, unit::none, between(0, 1), live,
        "The paper's alpha: share of FLIP in flip, aflip and asflip, the rest is PIC.");
  visit("flip_reference_dt", s.flip_reference_dt, unit::second, between(0, 1), live,
        "Step to which flip_ratio refers, so that damping does not depend on dt; 0: the ratio acts "
        "per step.");
  visit("advect", s.advect, unit::none, anything, live,
        "Velocity that moves particles of flip, apic and mls: their own (the paper) or the "
        "grid's, which strains them.");
  visit("separation_min", s.separation_min, unit::none, between(0, 1), live,
        "Share of its own velocity, beside the grid's, that moves compressed snow of asflip.");
  visit(
      "separation_max", s.separation_max, unit::none, between(0, 1), live,
      "Share of its own velocity that moves other snow of asflip: 1 lets it separate, 0 is aflip.");
  visit("separation_J_E", s.separation_J_E, unit::none, between(0.5, 2), live,
        "Elastic volume ratio below which snow of asflip counts as compressed.");
  visit("shock_viscosity", s.shock_viscosity, unit::none, between(0, 4), live,
        "Viscosity of snow that is being compressed: without it (0: the paper) impacts pack it too "
        "far.");
  visit(
      "contact_at", s.contact_at, unit::none, anything, live,
      "particles: snow touches colliders; nodes: the paper's contact, which leaves a gap of up to "
      "a cell.");
  visit("time_step", s.time_step, unit::none, anything, live,
        "adaptive: choose each step from the limits below; fixed: use dt.");
  visit("dt", s.dt, unit::second, between(1e-9, 1), live,
        "Length of a step if time_step is fixed.");
  visit("max_dt", s.max_dt, unit::second, between(1e-9, 1), live, "Longest adaptive step.");
  visit("cfl", s.cfl, unit::none, between(1e-3, 1e3), live,
        "Cells that snow, and a collider near snow, may cross in an adaptive step.");
  visit("acoustic_cfl", s.acoustic_cfl, unit::none, between(1e-3, 1e3), live,
        "Cells that sound may cross in an adaptive step.");
  visit("strain_limit", s.strain_limit, unit::none, between(1e-3, 1e3), live,
        "Largest |dt grad v| of an adaptive step.");
  visit("beta", s.beta, unit::none, between(0, 1), live,
        "0: explicit; up to 1: the paper's semi-implicit steps, for a longer dt (from 0.5 on no "
        "acoustic limit); they damp.");
  visit("solve_tolerance", s.solve_tolerance, unit::none, between(1e-14, 0.1), live,
        "Residual that ends the solve of a semi-implicit step, as a share of the motion within the "
        "snow.");
  visit("solve_iterations", s.solve_iterations, unit::none, between(1, 10000), live,
        "Largest number of iterations in a semi-implicit step.");
  visit("collide_after_solve", s.collide_after_solve, unit::none, anything, live,
        "Let nodes collide again after the solve, unlike the paper. Only with contact_at = "
        "\"nodes\".");
  visit("push_out", s.push_out, unit::none, anything, live,
        "Move particles deeper than 0.1 cell_size in a collider back to that depth, unlike the "
        "paper.");
  visit("gravity", s.gravity, unit::acceleration, within(1e6), live, "Acceleration of all snow.");
  visit("precision", s.precision, unit::none, anything, restart, "Arithmetic of the solver.");
  visit("on_divergence", s.on_divergence, unit::none, anything, live,
        "stop: end the run and explain; retry: repeat the frame with half the dt, at "
        "most four times; ignore: continue anyway.");
  visit("bypass", s.bypass, unit::none, anything, live,
        "Stages to skip in every step, for debugging a solver; energy is then not watched.");
}

template <class V>
void describe(V& visit, sim::DustSettings& d) {
  using enum Change;
  visit("speed", d.speed, unit::velocity, at_least(0).at_most(1e6), live,
        "Speed in still air below which snow sheds no dust; all of it from twice that on.");
  visit("strain_rate", d.strain_rate, unit::per_second, at_least(0).at_most(1e6), live,
        "Rate of strain below which snow sheds no dust; all of it from twice that on.");
  visit("min_J_P", d.min_J_P, unit::none, between(0, 20), live,
        "Plastic volume ratio below which snow is too packed to shed dust.");
  visit("settling_speed", d.settling_speed, unit::velocity, between(0, 100), live,
        "Speed at which dust sinks in still air; it gives the dust's drag too.");
  visit("buoyancy", d.buoyancy, unit::none, within(100), live,
        "Lift of dusty air, in weights of its dust; -1: it sinks by that weight.");
  visit("diffusion", d.diffusion, unit::diffusivity, between(0, 1e4), live,
        "Diffusivity of dust in air.");
  visit("turbulence", d.turbulence, unit::none, between(0, 2), live,
        "Gusts smaller than the cells of the air, as a share of its speed.");
  visit("wind", d.wind, unit::velocity, within(1000), live, "Velocity of the air far away.");
  visit("life", d.life, unit::second, at_least(1e-3).at_most_or_0(1e6), live,
        "Mean time until dust that does not settle has faded; 0: for ever.");
  visit("air_cell", d.air_cell, unit::none, between(1, 100), restart,
        "Edge of the air's cells, in cells of the snow's grid.");
  visit("particles", d.particles, unit::none, between(1, 20'000'000), live,
        "Largest number of dust particles; near it fewer are born, each of more mass.");
  visit("spray_drag", d.spray_drag, unit::per_metre, between(0, 1e4), live,
        "Drag of loose snow in the air, k in dv/dt = k |u - v| (u - v); 0: none. All else of dust "
        "changes no snow.");
}

template <class V>
void describe(V& visit, Limits& l) {
  using enum Change;
  visit("memory", l.memory, unit::bytes, between(0, max_count), restart,
        "Largest memory of a run, in bytes or as \"8GiB\"; 0: 80 % of the available memory.");
  visit("particles", l.particles, unit::none, between(1, max_count), restart,
        "Largest number of particles in a run.");
  visit("pixels", l.pixels, unit::none, between(1, max_count), restart,
        "Largest number of pixels in a picture.");
}

template <class V>
void describe(V& visit, sim::Variation& v) {
  using enum Change;
  visit("density", v.density, unit::none, between(0, 0.5), restart,
        "Relative standard deviation of the particles' density.");
  visit("youngs_modulus", v.youngs_modulus, unit::none, between(0, 2), restart,
        "Relative standard deviation of the particles' stiffness.");
  visit("thresholds", v.thresholds, unit::none, between(0, 2), restart,
        "Relative standard deviation of theta_c and theta_s, which vary together, or of the "
        "strength of a law that has others.");
  visit("size", v.size, unit::metre, at_least(1e-6).at_most_or_0(1e6), restart,
        "Size of the lumps that differ; 0: each particle differs on its own.");
}

/// A number of a law, as a parameter.
constexpr Valid valid_of(const sim::laws::Bounds& b) {
  return {b.min, b.max, b.is_min_open, b.is_max_open};
}
constexpr const char* unit_of(sim::laws::Unit u) {
  return u == sim::laws::Unit::pascal    ? unit::pascal
         : u == sim::laws::Unit::degrees ? unit::degrees
                                         : unit::none;
}

template <class V>
void describe(V& visit, sim::Material& m, const sim::laws::Parameter& p) {
  if (p.names.empty()) {
    visit(p.key, p.of(m), unit_of(p.unit), valid_of(p.bounds), Change::live, p.help);
    return;
  }
  sim::laws::OneOf name = p.name_of(m);
  visit(p.key, name, unit::none, anything, Change::live, p.help);
  p.of(m) = static_cast<double>(name.place);
}

template <class V>
void describe(V& visit, sim::Material& m) {
  visit.shorthand(
      "preset", preset_of(m), [&m](Preset preset) { use_preset(m, preset); },
      "Named kind of snow: sets the density and the numbers below it, unless they are given.");
  visit("model", m.model, unit::none, anything, Change::live, sim::laws::help_of_model());
  visit("density", m.density, unit::density, between(1e-3, 1e5), Change::restart,
        "Mass per volume at the start.");
  visit("youngs_modulus", m.youngs_modulus, unit::pascal, between(1e-3, 1e12), Change::live,
        "Stiffness of undeformed snow.");
  visit("poisson_ratio", m.poisson_ratio, unit::none, at_least(0).below(0.5), Change::live,
        "Sideways bulge under compression.");
  visit("dust", m.dust, unit::none, between(0, 10), Change::live,
        "Dust that it sheds where it breaks fast, as a share of its mass per strain; it keeps its "
        "mass.");
  for (const sim::laws::Parameter& p : sim::laws::all_parameters()) describe(visit, m, p);
  visit("min_J_P", m.min_J_P, unit::none, above(0).at_most(1), Change::live,
        "Smallest plastic volume ratio: snow packed further keeps yielding but hardens no more.");
  visit("max_J_P", m.max_J_P, unit::none, between(1, 1e6), Change::live,
        "Largest plastic volume ratio: how loose torn snow becomes before it is packed again.");
  visit("max_hardening", m.max_hardening, unit::none, between(1, 1e12), Change::live,
        "Largest factor by which packed snow stiffens: e^(xi (1 - J_P)) ends there.");
  visit.section("variation", "Unevenness of the snow.", [&](auto& v) { describe(v, m.variation); });
}

template <class V>
void describe(V& visit, sim::shapes::Sphere& s, Change change) {
  visit("center", s.center, unit::metre, position, change, "Centre.");
  visit("radius", s.radius, unit::metre, needed_length, change, "Radius.");
}

template <class V>
void describe(V& visit, sim::shapes::Box& b, Change change) {
  visit("center", b.center, unit::metre, position, change, "Centre.");
  visit("size", b.size, unit::metre, needed_length, change, "Edge lengths.");
}

template <class V>
void describe(V& visit, sim::shapes::Capsule& c, Change change) {
  visit("a", c.a, unit::metre, needed_position, change, "One end of the axis.");
  visit("b", c.b, unit::metre, needed_position, change, "The other end of the axis.");
  visit("radius", c.radius, unit::metre, needed_length, change, "Radius.");
}

template <class V>
void describe(V& visit, sim::shapes::Cylinder& c, Change change) {
  visit("center", c.center, unit::metre, position, change, "Middle of the axis, along y.");
  visit("radius", c.radius, unit::metre, needed_length, change, "Radius.");
  visit("height", c.height, unit::metre, needed_length, change, "Length of the axis.");
}

template <class V>
void describe(V& visit, sim::shapes::Cone& c, Change change) {
  visit("center", c.center, unit::metre, position, change,
        "Middle of the axis, along y; the apex is up.");
  visit("radius", c.radius, unit::metre, needed_length, change, "Radius of the base.");
  visit("height", c.height, unit::metre, needed_length, change, "Distance from base to apex.");
}

template <class V>
void describe(V& visit, sim::shapes::Torus& t, Change change) {
  visit("center", t.center, unit::metre, position, change, "Centre; the axis is y.");
  visit("major_radius", t.major_radius, unit::metre, needed_length, change,
        "Distance from the centre to the middle of the tube.");
  visit("minor_radius", t.minor_radius, unit::metre, needed_length, change, "Radius of the tube.");
}

template <class V>
void describe(V& visit, sim::shapes::Plane& p, Change change) {
  visit("point", p.point, unit::metre, position, change, "Point on the surface.");
  visit("normal", p.normal, unit::none, within(1e6), change,
        "Direction out of the solid side, of any length.");
}

/// Coordinates of the file of a mesh, of points or of a terrain.
template <class V, class Form>
void describe_coordinates(
    V& visit, Form& form, Change change,
    const char* help_of_origin =
        "Coordinates in the file that count as its origin; with coordinates = \"world\" 0 is found "
        "from the files.") {
  visit("coordinates", form.coordinates, unit::none, anything, change,
        "own; world: those of a map, as UTM, from which all such files take one offset out.");
  visit("origin", form.origin, unit::none, map_position, change, help_of_origin);
}

template <class V>
void describe(V& visit, sim::shapes::Mesh& m, Change change) {
  visit("file", m.file, unit::none, file_path, change,
        "Mesh, OBJ, PLY or STL; path relative to the scene file.");
  visit("scale", m.scale, unit::none, length, change, "Metres per unit of the file.");
  visit("center", m.center, unit::metre, position, change, "Place of the file's origin.");
  visit(
      "fill", m.fill, unit::none, anything, change,
      "Inside: closed: of all parts; even_odd: shells are hollow; winding: for open meshes; auto: "
      "as the mesh is.");
  describe_coordinates(visit, m, change);
}

template <class V>
void describe(V& visit, sim::shapes::MeshSequence& m, Change change) {
  visit(
      "files", m.files, unit::none, file_pattern, change,
      "Closed meshes of one topology: path relative to the scene file, with %d, %04d, #### or $F4 "
      "for the number.");
  visit("first", m.first, unit::none, file_number, change, "Number of the first file.");
  visit("last", m.last, unit::none, file_number.required(), change, "Number of the last file.");
  visit("rate", m.rate, unit::per_second, between(1e-3, 1e6), change,
        "Files per second; vertices move on straight lines from file to file.");
  visit("start", m.start, unit::second, within(1e6), change,
        "Time of the first file; before it and after the last file the mesh rests.");
  visit("scale", m.scale, unit::none, length, change, "Metres per unit of the files.");
  visit("center", m.center, unit::metre, position, change, "Place of the files' origin.");
}

template <class V>
void describe(V& visit, sim::shapes::Points& p, Change change) {
  visit(
      "file", p.file, unit::none, file_path, change,
      "Particles, PLY or CSV: x y z and, if wanted, vx vy vz, mass, V0, J_P, F_E, C; path relative "
      "to the scene file.");
  visit("spacing", p.spacing, unit::metre, at_least(1e-9).at_most_or_0(1e6), change,
        "Distance between neighbours in a file without volumes; each particle has spacing^3.");
  visit("thinning", p.thinning, unit::none, between(1, 1e9), change,
        "Use one point of every N, and let it represent all N.");
  visit("center", p.center, unit::metre, position, change, "Place of the file's origin.");
  describe_coordinates(visit, p, change);
}

template <class V>
void describe(V& visit, sim::shapes::Terrain& t, Change change) {
  visit("file", t.file, unit::none, file_path, change,
        "Heights of ground, ESRI ASCII grid (.asc) or grey 16-bit PNG; path relative to the scene "
        "file.");
  visit("spacing", t.spacing, unit::metre, at_least(1e-6).at_most_or_0(1e6), change,
        "Distance between the posts of a PNG; a grid says its own.");
  visit("low", t.low, unit::metre, within(1e5), change, "Height of black, of a PNG.");
  visit("high", t.high, unit::metre, within(1e5), change, "Height of white, of a PNG.");
  visit("center", t.center, unit::metre, position, change, "Place of the file's origin.");
  describe_coordinates(
      visit, t, change,
      "East, north and height in the file that count as its origin; with coordinates = \"world\" 0 "
      "is found from the files.");
}

template <class V>
void describe(V& visit, sim::shapes::Cover& c, Change change) {
  visit("on", c.on, unit::none, identifier, change,
        "Name of the collider that it lies on, a terrain or a mesh.");
  visit("depth", c.depth, unit::metre, needed_length, change,
        "Vertical distance from the ground to the surface of the snow.");
  visit("width", c.width, unit::metre, at_least(0).at_most(1e6), change,
        "Extent along x, of a rectangle.");
  visit("length", c.length, unit::metre, at_least(0).at_most(1e6), change,
        "Extent along z, of a rectangle.");
  visit("radius", c.radius, unit::metre, at_least(0).at_most(1e6), change,
        "Radius, of a disc in place of a rectangle.");
  visit("center", c.center, unit::metre, position, change,
        "Middle of the outline; its y is how far above the ground the snow lies.");
}

/// Every form can be turned.
template <class V>
void describe_rotation(V& visit, sim::shapes::Shape& shape, Change change) {
  visit("rotation", shape.rotation, unit::degrees, within(1e6), change,
        "Angles about x, y, z through the centre; x turns first.");
}

template <class V>
void describe_solid_forms(V& visit, sim::shapes::Shape& shape, Change change = Change::restart) {
  using namespace sim::shapes;
  visit.template form<Sphere>("sphere", shape, change, "A sphere.");
  visit.template form<Box>("box", shape, change, "A box.");
  visit.template form<Capsule>("capsule", shape, change, "A cylinder with round ends.");
  visit.template form<Cylinder>("cylinder", shape, change, "A cylinder.");
  visit.template form<Cone>("cone", shape, change, "A cone.");
  visit.template form<Torus>("torus", shape, change, "A torus.");
  visit.template form<Mesh>("mesh", shape, change, "The inside of a triangle mesh.");
}

template <class V>
void describe_body_forms(V& visit, sim::shapes::Shape& shape) {
  describe_solid_forms(visit, shape);
  visit.template form<sim::shapes::Points>("points", shape, Change::restart,
                                           "Particles from a file.");
  visit.template form<sim::shapes::Cover>("cover", shape, Change::restart,
                                          "Snow on a terrain, to an even depth.");
}

template <class V>
void describe_collider_forms(V& visit, sim::shapes::Shape& shape) {
  visit.template form<sim::shapes::Plane>("plane", shape, Change::live, "A half space.");
  describe_solid_forms(visit, shape, Change::live);
  visit.template form<sim::shapes::MeshSequence>(
      "mesh_sequence", shape, Change::live,
      "The inside of a triangle mesh that deforms from file to file.");
  visit.template form<sim::shapes::Terrain>("terrain", shape, Change::live,
                                            "The ground below a field of heights.");
}

/// Describes the name of an item of a list.
template <class V>
void describe_name(V& visit, std::string& name) {
  visit("name", name, unit::none, identifier, Change::restart,
        "Name in addresses; default: its number, from 1.");
}

/// Describes the time of a keyframe.
template <class V>
void describe_time(V& visit, double& time) {
  visit("time", time, unit::second, between(0, 1e6), Change::live,
        "Time of the keyframe, later than the previous one.");
}

template <class V>
void describe(V& visit, sim::seeding::Body& b) {
  using enum Change;
  describe_name(visit, b.name);
  visit("material", b.material, unit::none, identifier, restart, "Name of a material.");
  visit.shape("shape", b.shape, "Volume to fill with snow.",
              [](auto& v, sim::shapes::Shape& shape) { describe_body_forms(v, shape); });
  visit("velocity", b.velocity, unit::velocity, speed, restart, "Velocity at the start.");
  visit("angular_velocity", b.angular_velocity, unit::spin, speed, restart,
        "Spin about the shape's centre at the start.");
  visit("particles_per_cell", b.particles_per_cell, unit::none, between(0.1, 1000), restart,
        "Number of particles in a cell.");
  visit("sampling", b.sampling, unit::none, anything, restart, "Placement of the particles.");
  visit("volumes", b.volumes, unit::none, anything, restart,
        "estimated: particle volumes from the density on the grid (the paper); given: body volume "
        "/ particles.");
  visit(
      "J_P", b.J_P, unit::none, between(0.1, 100), restart,
      "Plastic volume ratio at the start; above 1: loose snow, softer, less dense by that factor.");
}

template <class V>
void describe(V& visit, sim::seeding::Emitter& e) {
  using enum Change;
  describe_name(visit, e.name);
  visit("material", e.material, unit::none, identifier, restart, "Name of a material.");
  visit.shape("shape", e.shape, "Volume in which snow appears.",
              [](auto& v, sim::shapes::Shape& shape) { describe_solid_forms(v, shape); });
  visit("velocity", e.velocity, unit::velocity, speed, restart, "Velocity of the snow.");
  visit("angular_velocity", e.angular_velocity, unit::spin, speed, restart,
        "Spin of the snow about the shape's centre.");
  visit("rate", e.rate, unit::mass_rate, between(0, 1e9), restart,
        "Mass per second; 0: fill the whole shape once, at start.");
  visit("start", e.start, unit::second, between(0, 1e6), restart, "Time at which it opens.");
  visit("end", e.end, unit::second, between(0, 1e6), restart,
        "Time at which it closes; default: never.");
  visit("particles_per_cell", e.particles_per_cell, unit::none, between(0.1, 1000), restart,
        "Number of particles in a cell of snow.");
  visit("J_P", e.J_P, unit::none, between(0.1, 100), restart,
        "Plastic volume ratio at birth; above 1: loose snow, softer, less dense by that factor.");
}

template <class V>
void describe(V& visit, sim::seeding::Sink& s) {
  using enum Change;
  describe_name(visit, s.name);
  visit.shape("shape", s.shape, "Volume in which snow is removed.",
              [](auto& v, sim::shapes::Shape& shape) { describe_solid_forms(v, shape); });
  visit("outside", s.outside, unit::none, anything, restart, "Remove the snow outside instead.");
}

/// With a mass, a collider moves by itself.
template <class V>
void describe_body_that_moves(V& visit, sim::shapes::RigidBody& b) {
  using enum Change;
  visit("density", b.density, unit::density, at_least(1e-3).at_most_or_0(1e30), restart,
        "Makes it a body that snow, gravity and other bodies move; 0: only the scene moves it.");
  visit("mass", b.mass, unit::kilogram, at_least(1e-9).at_most_or_0(1e30), restart,
        "The same by its mass, in place of a density; 0: not given.");
  visit("inertia", b.inertia, unit::inertia, at_least(0).at_most(1e40), restart,
        "Moments about the axes of the form, through the centre of mass; 0: those of the shape.");
  visit("hold", b.hold, unit::none, anything, restart,
        "Directions of the world that the body does not move along or turn about.");
  visit("joint", b.joint, unit::none, anything, restart,
        "What joins the body to the world: ball: a point; hinge: a point and an axis; slider: an "
        "axis to slide along.");
  visit("joint_point", b.joint_point, unit::metre, position, restart,
        "Place of a ball joint or a hinge.");
  visit("joint_axis", b.joint_axis, unit::none, within(1e6), restart,
        "Direction of a hinge or a slider.");
  visit("joint_stiffness", b.joint_stiffness, unit::none, at_least(0).at_most(1e15), live,
        "Spring of a hinge (N m/rad) or a slider (N/m) back to where it starts.");
  visit("joint_damping", b.joint_damping, unit::none, at_least(0).at_most(1e15), live,
        "Damper of a hinge (N m s/rad) or a slider (N s/m).");
  visit("spring_place", b.spring_place, unit::metre, position, restart,
        "Place to which a spring pulls the centre of mass.");
  visit("spring_stiffness", b.spring_stiffness, unit::stiffness, at_least(0).at_most(1e15), live,
        "Stiffness of that spring; its rest length is 0.");
  visit("spring_damping", b.spring_damping, unit::damping, at_least(0).at_most(1e15), live,
        "Damper beside that spring.");
  visit("restitution", b.restitution, unit::none, at_least(0).at_most(1), live,
        "Speed after it meets a body or a collider, over that before; of two bodies the larger.");
}

template <class V>
void describe(V& visit, Collider& c) {
  using enum Change;
  describe_name(visit, c.name);
  visit.shape("shape", c.shape, "Solid volume that snow stays out of.",
              [](auto& v, sim::shapes::Shape& shape) { describe_collider_forms(v, shape); });
  visit("contact", c.contact, unit::none, anything, live,
        "separate: snow leaves, slides with friction; slip: cannot leave, slides freely; sticky: "
        "moves along.");
  visit("friction", c.friction, unit::none, between(0, 1000), live,
        "Coulomb coefficient of separate contact.");
  visit("velocity", c.velocity, unit::velocity, speed, live,
        "Constant velocity; of a body with a mass, at the start.");
  visit("angular_velocity", c.angular_velocity, unit::spin, speed, live,
        "Constant spin about the shape's centre, of a body with a mass at the start; a plane only "
        "gets a surface velocity.");
  describe_body_that_moves(visit, c.body);
  visit.sequence("keyframes", c.keyframes,
                 "Path of the shape, from rest to rest; excludes the velocities.");
  visit(
      "style", c.style, unit::none, anything, live,
      "solid; wire: lines; ghost: see-through; holdout: hides snow, takes shadows and is not seen, "
      "for plates.");
}

template <class V>
void describe(V& visit, sim::shapes::PoseKeyframe& k) {
  using enum Change;
  describe_time(visit, k.time);
  visit("position", k.position, unit::metre, position, live,
        "Place of the shape's centre (a plane's point); default: that of the shape.");
  visit("rotation", k.rotation, unit::degrees, within(1e6), live,
        "Rotation of the shape, less than 180 degrees from the previous one; default: its own.");
}

template <class V>
void describe(V& visit, Curve& c) {
  using enum Change;
  describe_name(visit, c.name);
  visit("parameter", c.parameter, unit::none, anything, restart,
        "Address of a number or vector of the simulation that may change during a run, as "
        "\"solver.gravity\".");
  visit("interpolation", c.interpolation, unit::none, anything, live,
        "smooth: a curve without overshoot, at rest at both ends; linear; step: the value of the "
        "last keyframe.");
  visit.sequence("keyframes", c.keyframes,
                 "Values at times; each frame has the value of its middle.");
}

template <class V>
void describe(V& visit, CurveKeyframe& k) {
  using enum Change;
  describe_time(visit, k.time);
  visit("value", k.value, unit::none, anything, live, "Value of a parameter that is a number.");
  visit("vector", k.vector, unit::none, anything, live, "Value of a parameter that is a vector.");
}

template <class V>
void describe(V& visit, CameraSettings& c) {
  using enum Change;
  visit("eye", c.eye, unit::metre, position, live,
        "Place of the camera. Give eye and target together, or neither to frame everything.");
  visit("target", c.target, unit::metre, position, live, "Point that the camera looks at.");
  visit("up", c.up, unit::none, within(1e6), live, "Upward direction of the picture.");
  visit("fov", c.fov, unit::degrees, between(1, 170), live, "Vertical angle of view.");
  visit("orbit", c.orbit, unit::degrees, within(1e5), live,
        "Angle by which the eye turns around the target, about up, over the whole scene, from rest "
        "to rest.");
  visit("turntable", c.turntable, unit::second, between(1e-3, 1e6), live,
        "Time of one turn of the eye around the target, about up, at constant speed.");
  visit(
      "push_in", c.push_in, unit::none, anything, live,
      "Whether an automatic camera moves slowly from the whole fall to the snow that has settled.");
  visit("follow", c.follow, unit::none, anything, live,
        "Name of a body or collider that the camera moves along with: eye and target are relative "
        "to its centre of mass.");
  visit.sequence("keyframes", c.keyframes, "Path of eye, target and fov.");
  visit("found", c.found, unit::none, anything, live,
        "What neve found of the camera, in the scenes of runs and pictures: --set of what that "
        "follows from has it found anew.");
}

template <class V>
void describe(V& visit, CameraKeyframe& k) {
  using enum Change;
  describe_time(visit, k.time);
  visit("eye", k.eye, unit::metre, position, live,
        "Place of the camera; default: the camera's eye.");
  visit("target", k.target, unit::metre, position, live,
        "Point that the camera looks at; default: the camera's target.");
  visit("fov", k.fov, unit::degrees, between(1, 170), live,
        "Vertical angle of view; default: the camera's fov.");
}

template <class V>
void describe(V& visit, LightSettings& l) {
  using enum Change;
  visit("direction", l.direction, unit::none, within(1e6), live, "Direction towards the light.");
  visit("intensity", l.intensity, unit::none, between(0, 100), live, "Strength of the light.");
  visit("ambient", l.ambient, unit::none, between(0, 100), live, "Strength of the sky light.");
}

template <class V>
void describe(V& visit, ParticleStyle& p) {
  using enum Change;
  visit("color_by", p.color_by, unit::none, anything, live, "Quantity shown by the colour.");
  visit("colormap", p.colormap, unit::none, anything, live, "Colours of the values.");
  visit("range", p.range, unit::none, within(1e30), live,
        "Values at the ends of the colour map, or \"auto\".");
}

template <class V>
void describe(V& visit, SmokeStyle& s) {
  using enum Change;
  visit("field", s.field, unit::none, anything, live,
        "mass: white smoke; any other field colours it.");
  visit("density_scale", s.density_scale, unit::none, between(0, 1000), live,
        "Opacity; at 1, three cells of packed snow absorb 60 % of the light.");
  visit("colormap", s.colormap, unit::none, anything, live, "Colours of the values.");
  visit("range", s.range, unit::none, within(1e30), live,
        "Values at the ends of the colour map, or \"auto\".");
}

template <class V>
void describe(V& visit, SliceStyle& s) {
  using enum Change;
  visit("field", s.field, unit::none, anything, live, "Field of the arrows.");
  visit("scalar", s.scalar, unit::none, anything, live, "Field of the heat map.");
  visit("normal", s.normal, unit::none, within(1e6), live, "Normal of the plane.");
  visit("point", s.point, unit::metre, position, live,
        "Point on the plane; default: the middle of the bodies. With follow, relative to the "
        "body's centre of mass.");
  visit("follow", s.follow, unit::none, anything, live,
        "Name of a body or collider that moves the plane along.");
  visit("motion", s.motion, unit::velocity, speed, live, "Velocity of the plane.");
  visit("every", s.every, unit::none, between(0, 1000), live,
        "Nodes from one arrow to the next; 0: as close as readable.");
  visit("dense_near", s.dense_near, unit::metre, position, live,
        "Point within four cells of which every node has an arrow, a short one.");
  visit("arrow_scale", s.arrow_scale, unit::none, above(0).at_most(1000), live,
        "Factor on the length of arrows; at 1, the longest nearly reaches to the next one.");
  visit("isolines", s.isolines, unit::none, between(0, 100), live,
        "Number of bands between isolines of the heat map; 0: no lines.");
  visit("colormap", s.colormap, unit::none, anything, live, "Colours of the arrows.");
  visit("range", s.range, unit::none, within(1e30), live,
        "Magnitudes at the ends of the colour map, or \"auto\"; the longest arrow has the upper "
        "one.");
  visit("scalar_colormap", s.scalar_colormap, unit::none, anything, live,
        "Colours of the heat map.");
  visit("scalar_range", s.scalar_range, unit::none, within(1e30), live,
        "Values at the ends of the heat map's colours, or \"auto\".");
  visit("range_from", s.range_from, unit::none, anything, live,
        "scene: ranges are the same in all frames; frame: those of the frame, and the legend says "
        "so.");
}

template <class V>
void describe(V& visit, PlotRanges& p) {
  using enum Change;
  visit("energy_range", p.energy, unit::joule, within(1e30), live,
        "Ends of the axis of the energies, or \"auto\".");
  visit("speed_range", p.speed, unit::velocity, within(1e30), live,
        "Ends of the axis of the largest speed, or \"auto\".");
  visit("force_range", p.force, unit::newton, within(1e30), live,
        "Ends of the axis of the largest force on a collider, or \"auto\".");
  visit("body_height_range", p.body_height, unit::metre, within(1e30), live,
        "Ends of the axis of the heights of bodies that move by themselves, or \"auto\".");
  visit("body_speed_range", p.body_speed, unit::velocity, within(1e30), live,
        "Ends of the axis of their speeds, or \"auto\".");
  visit("dt_range", p.dt, unit::second, within(1e30), live,
        "Ends of the axis of the time step, or \"auto\".");
}

template <class V>
void describe(V& visit, ClipPlane& c) {
  using enum Change;
  visit("normal", c.normal, unit::none, within(1e6), live,
        "Direction towards the side to cut away, of any length.");
  visit("point", c.point, unit::metre, position, live,
        "Point on the plane, or \"auto\": the middle of the snow in each frame.");
}

template <class V>
void describe_size(V& visit, const char* key, auto& size, const char* help) {
  visit(key, size, unit::pixels, between(min_side, 1000000), Change::live, help);
}

template <class V>
void describe(V& visit, View& view) {
  using enum Change;
  visit("name", view.name, unit::none, identifier, restart,
        "Name of its folder, and in addresses; default: its number, from 1.");
  visit("layers", view.layers, unit::none, anything, live, "Content of the picture.");
  describe_size(visit, "size", view.size,
                "Width and height of this view; default: those of the output.");
  visit("background", view.background, unit::none, anything, live,
        "Background of this view; default: that of the output.");
  visit.section("particles", "Colours of the particles.",
                [&](auto& v) { describe(v, view.particles); });
  visit.section("smoke", "The mass on the grid, for the layer smoke.",
                [&](auto& v) { describe(v, view.smoke); });
  visit.section("slice", "A plane through the grid, for arrows and heatmap.",
                [&](auto& v) { describe(v, view.slice); });
  visit.section("plots", "The axes of the layer \"plots\".",
                [&](auto& v) { describe(v, view.plots); });
  visit.optional("clip", view.clip, "A plane that cuts bodies open in the picture.");
  visit.optional("camera", view.camera, "The camera of this view; default: that of the scene.");
}

template <class V>
void describe(V& visit, Mosaic& m) {
  using enum Change;
  visit("name", m.name, unit::none, identifier, restart,
        "Name of its folder, and in addresses; default: its number, from 1.");
  visit("views", m.views, unit::none, identifier, live, "Names of its views, row by row.");
  visit("columns", m.columns, unit::none, between(0, 64), live,
        "Number of views side by side; 0: few gaps, about the shape of the output.");
  visit("width", m.width, unit::pixels, between(64, 1000000), live,
        "Width of the whole picture; default: that of the output. The height follows.");
}

template <class V>
void describe(V& visit, Export& e) {
  using enum Change;
  visit("name", e.name, unit::none, identifier, restart,
        "Name of its folder in exports, and in addresses; default: its number, from 1, and the "
        "format as the folder.");
  visit("format", e.format, unit::none, anything, restart, "Format of the files.");
  visit("every", e.every, unit::none, between(1, 100000), restart,
        "Frames from one file to the next.");
  visit("attributes", e.attributes, unit::none, anything, restart,
        "Attributes of the particles; x is always written. vti and vdb have the grid instead.");
  visit("carried", e.carried, unit::none, identifier, restart,
        "Further columns of the bodies' point files, by name; 0 for particles of bodies without "
        "them.");
  visit("bodies", e.bodies, unit::none, identifier, restart,
        "Names of bodies and emitters whose particles are written; default: all.");
  visit("up", e.up, unit::none, anything, restart,
        "Axis that points up in the files: (x, y, z) becomes (x, -z, y) for z.");
  visit("scale", e.scale, unit::none, at_least(1e-6).at_most(1e6), restart,
        "Units per metre in the files, for lengths and velocities; all else stays in SI units.");
  visit(
      "dust", e.dust, unit::none, anything, restart,
      "Write the dust in the place of the snow: its particles (ply, vtp, bgeo, usda, npz, csv), or "
      "its density (vdb, vti).");
  visit("surface", e.surface, unit::none, anything, restart,
        "Write a closed mesh around the particles instead of the particles (ply, vtp, usda, obj), "
        "or its "
        "signed distance (vdb).");
  visit(
      "surface_cell", e.surface_cell, unit::none, between(0.2, 4), restart,
      "Cell size of the mesh, in particle spacings; half the size makes four times the triangles.");
  visit("surface_smoothing", e.surface_smoothing, unit::none, between(0.5, 3), restart,
        "Width of the kernel that makes the surface, in particle spacings; below 0.8 packed snow "
        "looks like beads.");
  visit("smallest_piece", e.smallest_piece, unit::none, between(1, 1000000), restart,
        "Number of particles in the smallest piece of the mesh; smaller pieces stay points.");
}

template <class V>
void describe(V& visit, Shot& s) {
  using enum Change;
  visit("show", s.show, unit::none, anything, live, "Name of the production.");
  visit("name", s.name, unit::none, anything, live, "Name of the shot.");
  visit("version", s.version, unit::none, anything, live, "Version, as v003.");
  visit("artist", s.artist, unit::none, anything, live, "Who made it.");
  visit("slate", s.slate, unit::none, anything, restart,
        "Write a picture before the first one, with show, shot, version, artist, range and "
        "parameters.");
  visit("time_code", s.time_code, unit::none, anything, restart,
        "Time code of first_frame in movies, HH:MM:SS:FF; default: its number, so that 1001 is "
        "00:00:41:17.");
}

template <class V>
void describe(V& visit, BurnIn& b) {
  using enum Change;
  const auto describe_place = [&](const char* key, std::string& text, const char* help) {
    visit(key, text, unit::none, anything, live, help);
  };
  describe_place("top_left", b.top_left, "Words in the upper left corner.");
  describe_place("top", b.top, "Words in the middle of the upper edge.");
  describe_place("top_right", b.top_right, "Words in the upper right corner.");
  describe_place("bottom_left", b.bottom_left, "Words in the lower left corner.");
  describe_place("bottom", b.bottom, "Words in the middle of the lower edge.");
  describe_place("bottom_right", b.bottom_right, "Words in the lower right corner.");
}

template <class V>
void describe_output(V& visit, Scene& s) {
  describe_size(visit, "size", s.size, "Width and height.");
  visit("background", s.background, unit::none, anything, Change::live,
        "Background: a gradient, or transparent (PNG with straight alpha).");
}

template <class V>
void describe(V& visit, Scene& s) {
  using enum Change;
  visit("title", s.title, unit::none, anything, live, "Title in the caption.");
  visit("frames", s.frames, unit::none, between(0, 100000), live,
        "Frames after the first one, which is the initial state where there are no handles.");
  visit("first_frame", s.first_frame, unit::none, within(1e6), restart,
        "Number of the first frame in the names of files, in run.json and in pictures, as 1001.");
  visit("handles", s.handles, unit::none, between(0, 10000), restart,
        "Frames that are simulated and drawn more, before the first frame and after the last one.");
  visit("fps", s.fps, unit::per_second, between(0.01, 1e5), restart,
        "Frames per second of simulated time.");
  visit("seed", s.seed, unit::none, between(0, max_count), restart, "Placement of the particles.");
  visit.section("solver", "Time integration.", [&](auto& v) { describe(v, s.solver); });
  visit.section("limits", "Limits of a run; a run that would exceed one is refused.",
                [&](auto& v) { describe(v, s.limits); });
  visit.named("material", s.materials, "A named material.");
  visit.section("dust", "Dust of snow that breaks fast, and the air that carries it.",
                [&](auto& v) { describe(v, s.solver.dust); });
  visit.list("body", s.bodies, "A piece of snow.");
  visit.list("emitter", s.emitters, "Adds snow during the run.");
  visit.list("sink", s.sinks, "A region that removes snow.");
  visit.list("collider", s.colliders,
             "A solid: it moves as the scene says, or with a density by itself.");
  visit.list("curve", s.curves, "Keyframes of a parameter: its values over the time of the run.");
  visit.optional("camera", s.camera, "The camera of all views; default: frames the whole scene.");
  visit.section("light", "The sun and the sky.", [&](auto& v) { describe(v, s.light); });
  visit.list("view", s.views, "One picture per frame.");
  visit.list("mosaic", s.mosaics, "Several views in one picture.");
  visit.list("export", s.exports, "Geometry for other programs, in files beside the pictures.");
  visit.section("output", "The pictures.", [&](auto& v) { describe_output(v, s); });
  visit.section("shot", "The shot in its production, for slates, movies and burn_in.",
                [&](auto& v) { describe(v, s.shot); });
  visit.section("burn_in",
                "Words over all pictures; {frame}, {shot.name}, {material.snow.hardening} and so "
                "on become values.",
                [&](auto& v) { describe(v, s.burn_in); });
}

}  // namespace neve::app::scene
