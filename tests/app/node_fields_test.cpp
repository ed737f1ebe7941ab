/// Pictures of the grid: fields of nodes, planes through them, wires around them.

#include "app/picture/node_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/picture/field_sampler.h"
#include "app/picture/frame_builder.h"
#include "app/picture/legends.h"
#include "app/picture/slice.h"
#include "app/picture/wires.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"

namespace neve::app {
namespace {

using sim::Vec3d;

constexpr const char* thrown_ball = R"(
[camera]
eye = [0, 0.5, 2]
target = [0, 0.5, 0]
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.15 } }
velocity = [1, -2, 0.5]
)";

app::scene::Scene read_thrown(const std::string& more,
                              const std::vector<app::scene::Override>& overrides = {}) {
  return app::scene::read_scene_text(thrown_ball + more, "ball.toml", {}, overrides);
}

struct FieldMoment {
  app::scene::Scene scene;
  app::picture::Snapshot snapshot;
};

FieldMoment moment_of(const std::string& views) {
  FieldMoment moment{read_thrown(views), {}};
  const sim::ParticleArrays particles = app::setup::seed_scene(moment.scene).particles;
  app::setup::resolve(moment.scene, particles.x.size());
  const sim::Simulation simulation(moment.scene.solver, moment.scene.materials,
                                   app::scene::sim_colliders(moment.scene), particles, 1);
  moment.snapshot = app::picture::take_snapshot(moment.scene, moment.scene.views, simulation, 0);
  return moment;
}

constexpr const char* all_fields = R"(
[[view]]
name = "a"
layers = ["arrows", "heatmap", "legend"]
slice = { field = "force", scalar = "J_P", every = 1 }
[[view]]
name = "b"
layers = ["arrows", "heatmap"]
slice = { field = "v_star", scalar = "pressure" }
[[view]]
name = "c"
layers = ["arrows", "heatmap"]
slice = { field = "velocity", scalar = "speed" }
)";

TEST(NodeFields, NodeFieldsAreSampledOnlyWhenAViewShowsThem) {
  EXPECT_FALSE(app::picture::field_needs(read_thrown("").views).is_needed);
  EXPECT_EQ(moment_of("").snapshot.fields.lattice, nullptr);
  const app::picture::FieldNeeds needs = app::picture::field_needs(read_thrown(all_fields).views);
  EXPECT_EQ(needs.vectors,
            (std::set{app::scene::VectorField::force, app::scene::VectorField::v_star,
                      app::scene::VectorField::velocity}));
  EXPECT_EQ(needs.scalars,
            (std::set{app::scene::ScalarField::J_P, app::scene::ScalarField::pressure,
                      app::scene::ScalarField::speed}));
}

TEST(NodeFields, NodeFieldsOfABallThatFliesAreThoseOfItsParticles) {
  const FieldMoment moment = moment_of(all_fields);
  const app::picture::FieldSamples& fields = moment.snapshot.fields;
  ASSERT_NE(fields.lattice, nullptr);
  ASSERT_EQ(fields.density.size(), 64 * fields.lattice->block.size());
  double mass = 0, largest = 0;
  const double h = moment.scene.solver.cell_size;
  const double dt = 1e-3;  // no step is longer: gravity changes v_star by at most this much
  for (std::size_t n = 0; n < fields.density.size(); ++n) {
    mass += static_cast<double>(fields.density[n]) * h * h * h;
    largest = std::max(largest, static_cast<double>(fields.density[n]));
    if (!(fields.density[n] > 0)) continue;
    // All particles have one velocity, J_P 1 and no stress: so has every node.
    EXPECT_NEAR(fields.scalars.at(app::scene::ScalarField::speed)[n], std::sqrt(5.25), 1e-4);
    EXPECT_NEAR(fields.scalars.at(app::scene::ScalarField::J_P)[n], 1, 1e-5);
    EXPECT_NEAR(fields.scalars.at(app::scene::ScalarField::pressure)[n], 0, 1);
    EXPECT_NEAR(fields.vectors.at(app::scene::VectorField::velocity)[n].y, -2, 1e-4);
    EXPECT_NEAR(fields.vectors.at(app::scene::VectorField::v_star)[n].y, -2, 9.81 * dt + 1e-4);
  }
  // Feather-light nodes hold less than 1e-4 of a cell's mass each: nothing to speak of.
  const double whole = 400 * 4.0 / 3 * 3.14159265 * 0.15 * 0.15 * 0.15;
  EXPECT_NEAR(mass, whole, 0.01 * whole);
  EXPECT_GT(largest, 380);
}

TEST(FieldSampler, FieldSamplerReproducesLinearFieldsInside) {
  FieldMoment moment = moment_of(all_fields);
  app::picture::FieldSamples& fields = moment.snapshot.fields;
  const float h = fields.lattice->spacing;
  std::vector<float>& values = fields.scalars.at(app::scene::ScalarField::J_P);
  const auto linear = [](const Vec3d& x) { return 3 + 2 * x.x() - x.y() + 5 * x.z(); };
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Vec3i b = fields.lattice->block[n / 64];
    const int k = static_cast<int>(n % 64);
    values[n] = static_cast<float>(linear(
        static_cast<double>(h) * Vec3d(4 * b.x + k / 16, 4 * b.y + k / 4 % 4, 4 * b.z + k % 4)));
  }
  const app::picture::FieldSampler sampler(fields);
  for (const Vec3d& x : {Vec3d(0.013, 0.51, -0.07), Vec3d(-0.061, 0.44, 0.033), Vec3d(0, 0.5, 0)}) {
    const auto stencil = sampler.at(x);
    ASSERT_TRUE(stencil);
    EXPECT_NEAR(stencil->cover, 1, 1e-5);
    EXPECT_NEAR(app::picture::FieldSampler::mean(*stencil, values), linear(x), 1e-4);
  }
  EXPECT_FALSE(sampler.at({5, 5, 5}));
  EXPECT_FALSE(sampler.at({std::nan(""), 0, 0}));
}

double spacing_of(const FieldMoment& moment) {
  return moment.scene.solver.cell_size / 2;
}

render::Frame frame_of_slice(const FieldMoment& moment, std::size_t view,
                             const app::picture::SlicePlane& plane) {
  render::Frame frame;
  app::picture::add_slice(moment.scene, moment.scene.views[view], moment.snapshot, plane,
                          {1000, spacing_of(moment)}, frame);
  return frame;
}

TEST(Slice, ArrowsLieOnNodesAndHaveTheirVelocity) {
  const FieldMoment moment = moment_of(all_fields);
  const app::scene::SliceStyle& slice = moment.scene.views[2].slice;
  const app::picture::SlicePlane plane = app::picture::slice_plane(slice, 0);
  EXPECT_TRUE(plane.across.isApprox(Vec3d(1, 0, 0)));
  EXPECT_TRUE(plane.up.isApprox(Vec3d(0, 1, 0)));
  const render::Frame frame = frame_of_slice(moment, 2, plane);
  ASSERT_EQ(frame.arrows.size(), 1u);
  const render::Arrows& arrows = frame.arrows[0];
  ASSERT_GT(arrows.position.size(), 20u);
  const float h = moment.snapshot.fields.lattice->spacing;
  for (std::size_t k = 0; k < arrows.position.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const float cells = arrows.position[k][axis] / h;
      EXPECT_NEAR(cells, std::round(cells), 1e-3);
    }
    EXPECT_NEAR(arrows.vector[k].x, 1, 1e-4);
  }
  ASSERT_EQ(frame.heat_maps.size(), 1u);
  EXPECT_NE(frame.footnote.find("z = 0 m"), std::string::npos) << frame.footnote;
}

TEST(Slice, ItsPlaceHasTheDigitsThatItsCellsNeed) {
  FieldMoment moment = moment_of(all_fields);
  app::scene::SliceStyle slice = moment.scene.views[2].slice;
  const auto footnote = [&](double cell, Vec3d point, Vec3d normal) {
    moment.scene.solver.cell_size = cell;
    slice.point = point;
    slice.normal = normal;
    render::Frame frame;
    app::picture::add_slice(moment.scene, moment.scene.views[2], moment.snapshot,
                            app::picture::slice_plane(slice, 0), {1000, 0.01}, frame);
    return frame.footnote;
  };
  EXPECT_EQ(footnote(0.0004, {0, 0.5, 0.0004}, {0, 0, 1}).substr(0, 12), "z = 0.0004 m");
  EXPECT_EQ(footnote(0.02, {0, 0.5, 0.02}, {0, 0, 1}).substr(0, 10), "z = 0.02 m");
  EXPECT_EQ(footnote(0.0004, {0.0004, 0.5, 0.0012}, {1, 0.1, 0}).substr(0, 35),
            "plane through (0.0004, 0.5, 0.0012)");
  EXPECT_EQ(footnote(0.02, {0.0212, 0.5, 0}, {1, 0.1, 0}).substr(0, 28),
            "plane through (0.02, 0.5, 0)");
}

TEST(Slice, SliceMarksPointsWithoutSnow) {
  const FieldMoment moment = moment_of(all_fields);
  app::scene::SliceStyle slice = moment.scene.views[2].slice;
  slice.point = Vec3d(0, 0, 5);
  const render::Frame frame = frame_of_slice(moment, 2, app::picture::slice_plane(slice, 0));
  EXPECT_TRUE(frame.heat_maps.empty());
  EXPECT_NE(frame.footnote.find("no snow here"), std::string::npos) << frame.footnote;
}

/// A plane that follows snow has no place without it; another is somewhere else than its point.
TEST(Slice, RingsAreAroundParticlesBesideThePlaneThatIsDrawn) {
  std::string text = thrown_ball;
  text.replace(text.find("[0, 0.5, 0], radius"), 11, "[0, 0.5, 0.4]");
  text +=
      "[[view]]\nname = \"a\"\nlayers = [\"heatmap\"]\nslice = { follow = \"ball\" }\n"
      "[[view]]\nname = \"b\"\nlayers = [\"heatmap\"]\n"
      "slice = { follow = \"ball\", point = [0, 0, 0] }\n"
      "[[view]]\nname = \"c\"\nlayers = [\"heatmap\"]\nslice = { point = [0, 0, 0.4] }\n";
  app::scene::Scene scene = app::scene::read_scene_text(text, "ball.toml");
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  app::setup::resolve(scene, seeded.particles.x.size());
  const sim::Simulation simulation(scene.solver, scene.materials, {}, seeded.particles, 1);
  const app::picture::Snapshot snapshot =
      app::picture::take_snapshot(scene, scene.views, simulation, 0);
  const auto nearest_to = [&](const Vec3d& place) {
    const std::vector<Vec3d>& x = snapshot.particles.x;
    const auto found = std::min_element(x.begin(), x.end(), [&](const Vec3d& a, const Vec3d& b) {
      return (a - place).squaredNorm() < (b - place).squaredNorm();
    });
    return snapshot.particles.id_of(static_cast<std::size_t>(found - x.begin()));
  };
  sim::Divergence divergence;
  divergence.culprits = {nearest_to({0, 0.5, 0.4}), nearest_to({0, 0.5, 0.26})};
  const app::picture::FrameBuilder builder(scene, seeded);
  for (const app::scene::View& view : scene.views) {
    const render::Frame frame = builder.build_incident(view, snapshot, divergence, {});
    ASSERT_EQ(frame.marks.size(), 1u) << view.name;
    EXPECT_NEAR(frame.marks[0].z, 0.4f, 0.03f) << view.name;
  }
}

TEST(Legends, TwoLayersOfOneQuantityShareALegend) {
  app::scene::View view;
  view.layers = {app::scene::Layer::particles, app::scene::Layer::smoke, app::scene::Layer::legend};
  view.particles.color_by = app::scene::ColorBy::J_P;
  view.smoke.field = app::scene::ScalarField::J_P;
  view.particles.range = view.smoke.range = app::scene::Range{0.8, 1.2};
  view.smoke.colormap = view.particles.colormap;
  EXPECT_EQ(app::picture::legends_of({}, view).size(), 1u);
  view.smoke.range = app::scene::Range{0.5, 2};
  EXPECT_EQ(app::picture::legends_of({}, view).size(), 2u);
}

/// A colour at an end of the bar stood for any value beyond it without a word.
TEST(Legends, SayWhereValuesOfTheirPictureLieBeyondTheirRange) {
  app::scene::View view;
  view.layers = {app::scene::Layer::particles, app::scene::Layer::heatmap,
                 app::scene::Layer::arrows};
  view.particles.color_by = app::scene::ColorBy::J_P;
  view.particles.range = app::scene::Range{0.8, 1.2};
  view.slice.scalar_range = app::scene::Range{0, 400};
  view.slice.range = app::scene::Range{0, 5};
  render::Frame frame;
  frame.points.value = {0.8f, 1.2004f};  // is on the bar, to a pixel
  frame.heat_maps.emplace_back().value = {100, NAN, 500};
  frame.heat_maps[0].cover = {1, 1, 0.2f};
  frame.arrows.emplace_back().vector = {{3, 0, 3}};
  const auto told = [&] {
    std::string ends;
    for (const render::Legend& legend : app::picture::legends_of({}, view, frame))
      ends += std::string(legend.has_lower_values ? "<" : ".") +
              (legend.has_higher_values ? ">" : ".") + " ";
    return ends;
  };
  EXPECT_EQ(told(), ".. .. .. ");
  frame.points.value = {0.7f, 1.2f};
  frame.heat_maps[0].cover = {1, 1, 0.6f};
  frame.arrows[0].vector = {{3, 4, 3}};
  EXPECT_EQ(told(), "<. .> .> ");
  // Floats next to the only value of a frame are that value.
  view.particles.range = app::scene::Range{1, 1};
  frame.points.value = {0.9999998f, 1.0000002f};
  EXPECT_EQ(told(), ".. .> .> ");
}

TEST(Slice, ArrowsKeepTheirDistanceInThePicture) {
  const FieldMoment moment = moment_of(all_fields);
  const app::picture::SlicePlane plane = app::picture::slice_plane(moment.scene.views[2].slice, 0);
  const auto distance = [&](double pixels_per_metre) {
    render::Frame frame;
    app::picture::add_slice(moment.scene, moment.scene.views[2], moment.snapshot, plane,
                            {pixels_per_metre, spacing_of(moment)}, frame);
    const auto& p = frame.arrows.at(0).position;
    return static_cast<double>(length(p.at(1) - p.at(0))) * pixels_per_metre;
  };
  for (const double pixels_per_metre : {300.0, 700.0, 5000.0})
    EXPECT_GE(distance(pixels_per_metre), 39.9) << pixels_per_metre;
  // In metres arrows are no closer than nodes.
  EXPECT_GT(distance(5000), 90);
}

TEST(Slice, NoArrowReachesIntoThePlaceOfAnother) {
  const FieldMoment moment = moment_of(all_fields);
  const app::picture::SlicePlane plane = app::picture::slice_plane(moment.scene.views[2].slice, 0);
  for (const double pixels_per_metre : {30.0, 700.0, 5000.0}) {
    render::Frame frame;
    app::picture::add_slice(moment.scene, moment.scene.views[2], moment.snapshot, plane,
                            {pixels_per_metre, spacing_of(moment)}, frame);
    const render::Arrows& arrows = frame.arrows.at(0);
    EXPECT_TRUE(arrows.is_centred);
    float closest = 1e30f;
    for (std::size_t a = 0; a < arrows.position.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        closest = std::min(closest, length(arrows.position[a] - arrows.position[b]));
    // Each is within half of its length from its node.
    EXPECT_LT(arrows.max_length, closest) << pixels_per_metre;
  }
}

TEST(Slice, AnyPlaneWorksAndOneThatMissesTheSnowIsEmpty) {
  const FieldMoment moment = moment_of(all_fields);
  app::scene::SliceStyle slice = moment.scene.views[2].slice;
  slice.normal = {1, 2, 3};
  const app::picture::SlicePlane tilted = app::picture::slice_plane(slice, 0);
  EXPECT_NEAR(tilted.across.dot(tilted.normal), 0, 1e-12);
  EXPECT_NEAR(tilted.up.dot(tilted.normal), 0, 1e-12);
  EXPECT_GT(tilted.up.y(), 0);
  const render::Frame frame = frame_of_slice(moment, 2, tilted);
  ASSERT_FALSE(frame.arrows.empty());
  for (const Vec3f& p : frame.arrows[0].position)
    EXPECT_NEAR((Vec3d(p.x, p.y, p.z) - tilted.point).dot(tilted.normal), 0, 1e-5);
  slice.point = Vec3d(0, 50, 0);
  const render::Frame missed = frame_of_slice(moment, 2, app::picture::slice_plane(slice, 0));
  EXPECT_TRUE(missed.arrows.empty());
  EXPECT_TRUE(missed.lines.empty());
}

TEST(Slice, SliceMovesAndFollows) {
  app::scene::SliceStyle slice;
  slice.point = Vec3d(1, 2, 3);
  slice.motion = {0, 0, 2};
  EXPECT_TRUE(app::picture::slice_plane(slice, 0.5).point.isApprox(Vec3d(1, 2, 4)));
  EXPECT_TRUE(app::picture::slice_plane(slice, 0, Vec3d(7, 8, 9)).point.isApprox(Vec3d(8, 10, 12)));
  slice.point.reset();
  EXPECT_TRUE(app::picture::slice_plane(slice, 0, Vec3d(7, 8, 9)).point.isApprox(Vec3d(7, 8, 9)));
  slice.normal = {0, -1, 0};
  const app::picture::SlicePlane level = app::picture::slice_plane(slice, 0);
  EXPECT_NEAR(level.across.norm(), 1, 1e-12);
}

TEST(Slice, SliceIsBuiltInAndSetByItsName) {
  const app::scene::Scene none = read_thrown("");
  EXPECT_EQ(none.views.size(), 1u);
  const app::scene::View slice = app::scene::find_view(none, "slice");
  EXPECT_TRUE(app::scene::has_layer(slice, app::scene::Layer::arrows));
  EXPECT_TRUE(app::scene::has_layer(slice, app::scene::Layer::heatmap))
      << "arrows alone may all be too short to be seen";
  EXPECT_FALSE(app::scene::has_layer(slice, app::scene::Layer::particles));
  const app::scene::Scene set = read_thrown("", {{"view.slice.slice.every", "3"}});
  ASSERT_EQ(set.views.size(), 2u);
  EXPECT_EQ(set.views[1].slice.every, 3);
  EXPECT_TRUE(app::scene::has_layer(set.views[1], app::scene::Layer::arrows));
  const app::scene::Scene named = read_thrown("[[view]]\nname = \"slice\"\n");
  EXPECT_EQ(named.views.at(0).layers, slice.layers);
  EXPECT_EQ(named.views.at(0).slice.scalar, app::scene::ScalarField::density);
  const app::scene::Scene own =
      read_thrown("[[view]]\nname = \"slice\"\nslice = { scalar = \"J_P\", isolines = 3 }\n");
  EXPECT_EQ(own.views.at(0).slice.scalar, app::scene::ScalarField::J_P);
}

TEST(Slice, MistakesAreLocated) {
  const auto message = [](const std::string& slice) {
    try {
      read_thrown("[[view]]\nname = \"v\"\nlayers = [\"arrows\"]\nslice = { " + slice + " }\n");
    } catch (const app::scene::toml::SceneError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message("normal = [0, 0, 0]").find("normal is zero"), std::string::npos);
  const std::string follow = message("follow = \"bal\"");
  EXPECT_NE(follow.find("ball.toml:12:"), std::string::npos) << follow;
  EXPECT_NE(follow.find("ball"), std::string::npos) << follow;
  EXPECT_NE(message("field = \"speed\"").find("velocity"), std::string::npos);
}

TEST(Wires, SharedEdgesAreDrawnOnceAndJoined) {
  render::NodeLattice lattice;
  lattice.spacing = 0.25f;
  lattice.block = {{0, 0, 0}};
  EXPECT_EQ(app::picture::block_lines(lattice, std::vector<float>(64, 1)).ends.size(), 2u * 12);
  // Two blocks side by side: 4 long edges, and 8 across at three places minus the shared 4: 12.
  lattice.block = {{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(app::picture::block_lines(lattice, std::vector<float>(128, 1)).ends.size(), 2u * 16);
  // A block without mass does not count.
  std::vector<float> density(128, 1);
  std::fill(density.begin() + 64, density.end(), 0.0f);
  EXPECT_EQ(app::picture::block_lines(lattice, density).ends.size(), 2u * 12);
  render::Lines box;
  app::picture::append_box({0, 0, 0}, {1, 2, 3}, box);
  EXPECT_EQ(box.ends.size(), 24u);
}

/// Four nodes in one block, of which one has no mass.
app::picture::FieldSamples four_nodes() {
  app::picture::FieldSamples fields;
  auto lattice = std::make_shared<render::NodeLattice>();
  lattice->spacing = 0.5f;
  lattice->block = {{-1, 0, 2}};
  fields.lattice = lattice;
  fields.density.assign(64, 0);
  std::vector<float>& speed = fields.scalars[app::scene::ScalarField::speed];
  speed.assign(64, 0);
  for (const auto& [node, value] : {std::pair{3, 2.5f}, std::pair{21, 7.0f}, std::pair{40, 0.5f}}) {
    fields.density[static_cast<std::size_t>(node)] = 1;
    speed[static_cast<std::size_t>(node)] = value;
  }
  speed[50] = 99;  // a node without mass says nothing
  return fields;
}

app::scene::View extremes_of_speed() {
  app::scene::View view;
  view.layers = {app::scene::Layer::heatmap, app::scene::Layer::extremes};
  view.slice.scalar = app::scene::ScalarField::speed;
  return view;
}

TEST(Extremes, AreMarkedWithNodeAndValue) {
  render::Frame frame;
  app::picture::mark_extremes(extremes_of_speed(), four_nodes(), 0.01, frame);
  ASSERT_EQ(frame.labels.size(), 2u);
  // Node 21 is (1, 1, 1) in its block.
  EXPECT_EQ(frame.labels[0].text, "largest speed 7 m/s, node -3 1 9");
  EXPECT_EQ(frame.labels[0].position.x, -1.5f);
  EXPECT_EQ(frame.labels[0].position.z, 4.5f);
  EXPECT_EQ(frame.labels[1].text, "smallest speed 0.5 m/s, node -2 2 8");
  ASSERT_EQ(frame.lines.size(), 1u);
  EXPECT_EQ(frame.lines[0].ends.size(), 12u) << "two crosses of three lines";
  EXPECT_TRUE(frame.footnote.empty());
}

/// A picture of the momentum named the largest speed, which was nowhere in it.
TEST(Extremes, AreOfTheFieldThatStreamlinesShow) {
  app::scene::View view;
  view.layers = {app::scene::Layer::streamlines, app::scene::Layer::extremes};
  view.slice.field = app::scene::VectorField::momentum;
  app::picture::FieldSamples fields = four_nodes();
  for (const float speed : fields.scalars[app::scene::ScalarField::speed])
    fields.vectors[app::scene::VectorField::momentum].push_back({2 * speed, 0, 0});
  render::Frame frame;
  app::picture::mark_extremes(view, fields, 0.01, frame);
  EXPECT_EQ(frame.labels.at(0).text, "largest momentum 14 kg m/s, node -3 1 9");
}

TEST(Extremes, NodesThatAreNoNumberOrCrossACellInAStepAreRed) {
  app::picture::FieldSamples fields = four_nodes();
  fields.scalars[app::scene::ScalarField::speed][40] = std::nanf("");
  render::Frame frame;
  app::picture::mark_extremes(extremes_of_speed(), fields, 0.1, frame);
  EXPECT_EQ(frame.footnote, "2 nodes are red: no number, or more than a cell in a step");
  ASSERT_EQ(frame.lines.size(), 2u);
  EXPECT_EQ(frame.lines[1].ends.size(), 12u);
  EXPECT_GT(frame.lines[1].color.x, 0.9f);
  EXPECT_LT(frame.lines[1].color.y, 0.2f);
  EXPECT_EQ(frame.labels[1].text, "smallest speed 2.5 m/s, node -4 0 11")
      << "not the one that is none";
}

TEST(Ranges, MayBeThoseOfTheFrameAndTheLegendSaysSo) {
  app::scene::View view = extremes_of_speed();
  view.slice.scalar_range = app::scene::Range{0, 3};
  EXPECT_EQ(app::picture::with_ranges_of_frame(view, four_nodes()).slice.scalar_range->max, 3);
  EXPECT_EQ(app::picture::legends_of({}, view).front().title, "speed");
  view.slice.range_from = app::scene::RangeFrom::frame;
  const app::scene::View of_frame = app::picture::with_ranges_of_frame(view, four_nodes());
  EXPECT_EQ(of_frame.slice.scalar_range->min, 0.5);
  EXPECT_EQ(of_frame.slice.scalar_range->max, 7);
  EXPECT_EQ(app::picture::legends_of({}, of_frame).front().title, "speed, this frame");
  // Equal values are a range, too.
  app::picture::FieldSamples equal = four_nodes();
  for (float& value : equal.scalars[app::scene::ScalarField::speed]) value = 2.5f;
  const app::scene::View of_equal = app::picture::with_ranges_of_frame(view, equal);
  EXPECT_EQ(of_equal.slice.scalar_range->min, 2.5);
  EXPECT_EQ(of_equal.slice.scalar_range->max, 2.5);
  const FieldMoment moment = moment_of(R"(
[[view]]
name = "arrows"
layers = ["arrows", "legend"]
slice = { field = "velocity", range_from = "frame" }
)");
  const render::Frame frame =
      frame_of_slice(moment, 0, app::picture::slice_plane(moment.scene.views[0].slice, 0));
  EXPECT_NE(frame.footnote.find("longest arrow"), std::string::npos) << frame.footnote;
  EXPECT_NE(frame.footnote.find("the largest of this frame"), std::string::npos) << frame.footnote;
}

/// Twice the mass of packed snow is brighter on the bar by more than can be overlooked.
TEST(Legends, WhiteSmokeHasOneOnWhichTwiceTheMassShows) {
  const app::scene::Scene scene = read_thrown("");
  app::scene::View view;
  view.layers = {app::scene::Layer::smoke, app::scene::Layer::legend};
  view.smoke.field = app::scene::ScalarField::mass;
  const std::vector<render::Legend> legends = app::picture::legends_of(scene, view);
  ASSERT_EQ(legends.size(), 1u);
  EXPECT_EQ(legends[0].unit, "kg/m3");
  EXPECT_EQ(legends[0].max, 800);
  const auto& colors = legends[0].colors;
  ASSERT_GT(colors.size(), 10u);
  const int none = colors.front()[0], packed = colors[colors.size() / 2][0],
            twice = colors.back()[0];
  EXPECT_GT(packed, none + 80);
  EXPECT_GT(twice, packed + 25);
  view.smoke.density_scale = 0;
  EXPECT_TRUE(app::picture::legends_of(scene, view).empty()) << "nothing is seen of it";
}

}  // namespace
}  // namespace neve::app
