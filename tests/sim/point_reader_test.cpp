// Particles from PLY and CSV files, also from files that are none.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "sim/files/point_reader.h"
#include "sim/seeding/seeding.h"
#include "sim/shapes/placed_points.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

const std::string csv = "x,y,z,vx,vy,vz,mass,volume\n1,2,3,4,5,6,0.5,0.25\n-1,0,1e-3,0,0,0,2,1\n";

std::string point_error(const std::string& bytes) {
  try {
    sim::files::parse_points(bytes, "p");
  } catch (const ShapeError& error) {
    return error.what();
  }
  return "no error";
}

/// Two points as a binary PLY, with a property and elements that say nothing.
std::string binary_ply(bool is_little) {
  std::string bytes = std::string("ply\nformat binary_") + (is_little ? "little" : "big") +
                      "_endian 1.0\ncomment snow\nelement camera 1\nproperty short zoom\n"
                      "element vertex 2\nproperty double x\nproperty float y\nproperty int z\n"
                      "property uchar red\nproperty double mass\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](std::uint64_t bits, int size) {
    for (int k = 0; k < size; ++k)
      bytes += static_cast<char>(bits >> (8 * (is_little ? k : size - 1 - k)));
  };
  put(7, 2);
  for (const double x : {0.1, -2.5}) {
    put(std::bit_cast<std::uint64_t>(x), 8);
    put(std::bit_cast<std::uint32_t>(static_cast<float>(3 * x)), 4);
    put(static_cast<std::uint32_t>(-4), 4);
    put(255, 1);
    put(std::bit_cast<std::uint64_t>(0.125), 8);
  }
  return bytes + std::string("\x01\x00\x00\x00\x00", 5);
}

TEST(PointReader, PointReaderReadsEveryColumnOfACsv) {
  const sim::files::PointCloud cloud = sim::files::parse_points(csv, "p");
  ASSERT_EQ(cloud.x.size(), 2u);
  EXPECT_EQ(cloud.x[1], Vec3d(-1, 0, 1e-3));
  EXPECT_EQ(cloud.v[0], Vec3d(4, 5, 6));
  EXPECT_EQ(cloud.m, (std::vector<double>{0.5, 2}));
  EXPECT_EQ(cloud.V, (std::vector<double>{0.25, 1}));
}

TEST(PointReader, PointReaderFindsColumnsByNameInAnyOrderAndPassesOverOthers) {
  const sim::files::PointCloud cloud = sim::files::parse_points(
      "\xEF\xBB\xBF# from elsewhere\r\n\r\n\"Pz\"; color ;\"P.y\";Position_X\r\n"
      "3; red ;2;+1\r\n\r\n# half way\r\n6;;5;4",
      "p");
  ASSERT_EQ(cloud.x.size(), 2u);
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
  EXPECT_EQ(cloud.x[1], Vec3d(4, 5, 6));
  EXPECT_TRUE(cloud.v.empty() && cloud.m.empty() && cloud.V.empty());
  EXPECT_EQ(sim::files::parse_points("Points:0\tPoints:1\tPoints:2\n1\t2\t3\n", "p").x[0],
            Vec3d(1, 2, 3));
}

TEST(PointReader, PointReaderTakesQuotedFieldsOfACsvAsTheyAre) {
  const sim::files::PointCloud cloud =
      sim::files::parse_points("name;x;\"y\";z\n\"a;b \"\"c\"\"\";\"1\";2;3\n\"\";4;5;6\n", "p");
  ASSERT_EQ(cloud.x.size(), 2u);
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
  EXPECT_EQ(cloud.x[1], Vec3d(4, 5, 6));
}

TEST(PointReader, PointReaderReadsThePastOfTheSnow) {
  const std::string F = "F_E_xx,F_E_xy,F_E_xz,F_E_yx,F_E_yy,F_E_yz,F_E_zx,F_E_zy,F_E_zz";
  const sim::files::PointCloud cloud = sim::files::parse_points(
      "x_x,x_y,x_z,volume,V0,J_P,stiffness,threshold,C_zx,C_zy,C_zz,C_xx,C_xy,C_xz,C_yx,C_yy,C_"
      "yz," +
          F + "\n1,2,3,9,8,0.9,2,0.5,7,8,9,1,2,3,4,5,6,1,2,0,0,1,0,0,0,1\n",
      "p");
  ASSERT_EQ(cloud.x.size(), 1u);
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
  EXPECT_EQ(cloud.V, std::vector<double>{8}) << "the volume before deformation";
  EXPECT_EQ(cloud.J_P, std::vector<double>{0.9});
  EXPECT_EQ(cloud.stiffness, std::vector<double>{2});
  EXPECT_EQ(cloud.threshold, std::vector<double>{0.5});
  Mat3d deformation, affine;
  deformation << 1, 2, 0, 0, 1, 0, 0, 0, 1;
  affine << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  EXPECT_EQ(cloud.F_E[0], deformation);
  EXPECT_EQ(cloud.C[0], affine);
  const auto expect = [](const std::string& bytes, const std::string& part) {
    EXPECT_NE(point_error(bytes).find(part), std::string::npos) << point_error(bytes);
  };
  expect("x,y,z,F_E_xx\n1,2,3,4\n", "p:1: a part of F_E only; expected nine columns, F_E_xx to");
  expect("x,y,z,J_P\n1,2,3,0\n", "p:2: J_P = 0; expected a number from 1e-6 to 1e6");
  expect("x,y,z," + F + "\n1,2,3,1,0,0,0,1,0,0,0,-1\n", "p:2: det F_E = -1");
}

TEST(PointReader, PointReaderReadsAsciiPly) {
  const sim::files::PointCloud cloud = sim::files::parse_points(
      "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty float y\r\n"
      "property float z\r\nproperty float vol\r\nend_header\r\n1 2 3 0.5\r\n4 5 6 0.25",
      "p");
  ASSERT_EQ(cloud.x.size(), 2u);
  EXPECT_EQ(cloud.x[1], Vec3d(4, 5, 6));
  EXPECT_EQ(cloud.V, (std::vector<double>{0.5, 0.25}));
}

TEST(PointReader, RemarksBeforeTheFirstElementOfAPlyArePassedOver) {
  const sim::files::PointCloud cloud = sim::files::parse_points(
      "ply\nformat ascii 1.0\nCreated by Blender3D 247, source file: x\n\nelement vertex 1\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n",
      "p");
  ASSERT_EQ(cloud.x.size(), 1u);
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
}

/// The file is one that neve exports with --up z --scale 100 of a point at (1, 2, 3) m; other
/// programs' words about axes mean nothing.
TEST(PointReader, PointReaderTurnsAndScalesBackWhatNeveHasTurnedAndScaled) {
  const auto read = [](const std::string& comments) {
    std::string text = "ply\nformat ascii 1.0\n" + comments + "element vertex 1\n";
    for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "m", "V0", "F_E_xx", "F_E_xy",
                             "F_E_xz", "F_E_yx", "F_E_yy", "F_E_yz", "F_E_zx", "F_E_zy", "F_E_zz"})
      text += std::string("property double ") + name + "\n";
    return text +
           "end_header\n100 -300 200 400 -600 500 7 0.25 1 -0.3 0.2 -0.1 3 -0.4 0.5 -0.6 2\n";
  };
  const std::string neve = "comment neve 0.2.0\ncomment time 0 s, frame 0\n";
  const sim::files::PointCloud cloud =
      sim::files::parse_points(read(neve + "comment up z, units per metre 100\n"), "p");
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
  EXPECT_EQ(cloud.v[0], Vec3d(4, 5, 6));
  EXPECT_EQ(cloud.m[0], 7);
  EXPECT_EQ(cloud.V[0], 0.25);
  Mat3d F_E;
  F_E << 1, 0.2, 0.3, 0.5, 2, 0.6, 0.1, 0.4, 3;
  EXPECT_EQ(cloud.F_E[0], F_E);
  for (const std::string& comments :
       {std::string("comment up z, units per metre 100\n"), neve,
        neve + "comment up y, units per metre 1\n", std::string("comment made by hand, z up\n")})
    EXPECT_EQ(sim::files::parse_points(read(comments), "p").x[0], Vec3d(100, -300, 200));
  for (const char* axes : {"up x, units per metre 1", "up z, units per metre 0",
                           "up z, units per metre", "up z", "up z, units per metre nan"})
    EXPECT_EQ(point_error(read(neve + "comment " + axes + "\n")),
              "p:5: the comment on the axes of a file of neve cannot be read; expected up y, "
              "units per metre 1, or none");
}

TEST(PointReader, ACsvThatNeveHasTurnedAndScaledIsTurnedAndScaledBack) {
  const auto read = [](const std::string& text) { return sim::files::parse_points(text, "p"); };
  const sim::files::PointCloud cloud = read(
      "x,y,z,vx,vy,vz,m,up_z_units_per_metre\n100,-300,200,400,-600,500,7,100\n1,-3,2,0,0,0,7,1\n");
  EXPECT_EQ(cloud.x[0], Vec3d(1, 2, 3));
  EXPECT_EQ(cloud.v[0], Vec3d(4, 5, 6));
  EXPECT_EQ(cloud.m[0], 7);
  EXPECT_EQ(cloud.x[1], Vec3d(1, 2, 3));
  EXPECT_EQ(read("x,y,z,up_y_units_per_metre\n100,-300,200,100\n").x[0], Vec3d(1, -3, 2));
  EXPECT_EQ(read("x,y,z,up\n100,-300,200,100\n").x[0], Vec3d(100, -300, 200));
  // No attribute that an export would carry along, beside its own.
  EXPECT_EQ(sim::files::further_csv_columns("x,y,z,wet,up_z_units_per_metre\n", "p"),
            std::vector<std::string>{"wet"});
  for (const char* value : {"0", "-1", "1e7", "nan"})
    EXPECT_EQ(point_error(std::string("x,y,z,up_z_units_per_metre\n0,0,0,") + value + "\n"),
              "p:2: the column up_z_units_per_metre of a file of neve cannot be read; expected 1 "
              "where a unit is a metre");
}

TEST(PointReader, PointReaderReadsBinaryPlyOfBothByteOrders) {
  for (const bool is_little : {true, false}) {
    const sim::files::PointCloud cloud = sim::files::parse_points(binary_ply(is_little), "p");
    ASSERT_EQ(cloud.x.size(), 2u);
    EXPECT_EQ(cloud.x[0], Vec3d(0.1, static_cast<double>(0.3f), -4));
    EXPECT_EQ(cloud.x[1], Vec3d(-2.5, -7.5, -4));
    EXPECT_EQ(cloud.m, (std::vector<double>{0.125, 0.125}));
  }
}

TEST(PointReader, PointReaderNamesThePlaceAndKindOfAnError) {
  const auto expect = [](const std::string& bytes, const std::string& part) {
    EXPECT_NE(point_error(bytes).find(part), std::string::npos) << point_error(bytes);
  };
  expect("", "p: it has no header line");
  expect("x,y,z\n", "p: it has no points");
  expect("x,y\n1,2\n", "p:1: no column z");
  expect("x,y,z,vx\n1,2,3,4\n", "p:1: a velocity without column vy");
  expect("x,y,z,X\n1,2,3,4\n", "p:1: two columns are the point's x");
  expect("x,y,z\n1,2\n", "p:2: 2 fields; the header has 3");
  expect("x,y,z\n1,2,3\n1,2,3,4\n", "p:3: more fields than the header's 3");
  expect("a b c\n1 2 3\n", "no column x among \"a\", \"b\", \"c\"");
  EXPECT_THROW(sim::files::parse_points("x,y,z\n1,2,3\n", "cloud.ply"), ShapeError);
  expect("1,2,3\n4,5,6\n", "p:1: the first line has numbers");
  expect("x,y,z\n1,\"2,3\n", "p:2: 2 fields");
  expect("x,y,z\n1,snow,3\n", "p:2: \"snow\" is not a number, in column \"y\"");
  expect("x,y,z\n1,nan,3\n", "p:2: y = nan; expected a finite number");
  expect("x,y,z\n1,2,inf\n", "p:2: z = inf");
  expect("x,y,z\n1,2,2e8\n", "p:2: z = 2e+08; expected a finite number, at most 1e8");
  expect("x,y,z,m\n1,2,3,-1\n", "p:2: mass = -1; expected a number from 1e-30 to 1e12");
  // Single precision ends at 1e-38.
  expect("x,y,z,volume\n1,2,3,1e-300\n", "p:2: volume = 1e-300; expected a number from 1e-30");
  expect("x,y,z,m\n1,2,3,0\n", "p:2: mass = 0");
  expect("x,y,z,volume\n1,2,3,nan\n", "p:2: volume = nan");
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  expect("ply\n", "without end_header");
  expect(ply + "1\nproprty float x\n", "p:4: \"proprty\" is not a keyword");
  expect("ply\nformat zip 1.0\n", "p:2: the format \"zip\"");
  expect("ply\nend_header\n", "names no format");
  expect("ply\nformat ascii 1.0\nend_header\n", "no element vertex");
  expect(ply + "-1\n", "p:3: \"-1\" is not a number of elements");
  expect(ply + "1\nproperty half x\n", "p:4: \"half\" is not a type");
  expect(ply + "2\n" + xyz + "end_header\n1 2 3 \n", "truncated");
  expect(ply + "1\n" + xyz + "end_header\n1 2      \n", "p:8: 2 numbers");
  expect(ply + "1\n" + xyz + "end_header\n1 2 3 4\n", "p:8: more numbers than the header's 3");
  expect(ply + "1\n" + xyz + "end_header\n1 2 snow\n",
         "p:8: \"snow\" is not a number, in property \"z\"");
  expect(ply + "1\n" + xyz + "property list uchar int a\nend_header\n1 2 3   \n",
         "p:9: 3 numbers; the header has 4");
  expect(ply + "1\n" + xyz + "property list uchar int a\nend_header\n1 2 3 9 1\n",
         "p:9: a list is longer than its line");
  expect(ply + "1\nproperty float x\nproperty float y\nend_header\n1 2\n", "p:3: no column z");
  expect(ply + "1\n" + xyz + "end_header\n1 2 3\n\n4 5 6\n",
         "p:10: more data than the 1 of \"vertex\" that the header promises");
  const std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz +
                             "end_header\n" + std::string(24, '\0');
  expect(binary, "p: more data than the 1 of \"vertex\"");
  EXPECT_EQ(point_error(binary.substr(0, binary.size() - 11)), "no error")
      << "some writers end with a byte or two of their own";
  // A second one of the same name would leave its columns without values.
  expect(ply + "1\nproperty float x\nproperty float y\nelement vertex 1\nproperty float z\n",
         "p:6: a second element \"vertex\"");
}

TEST(PointReader, TablesOfNumpyAndOfSpreadsheetsAreRead) {
  const auto positions = [](const std::string& text) {
    return sim::files::parse_points(text, "p").x;
  };
  const std::vector<Vec3d> expected{{0.5, 1, 2}, {-3, 0.25, 4}};
  for (const char* text :
       {"x,y,z\n0.5,1,2\n-3,0.25,4\n", "\xEF\xBB\xBFx,y,z\n0.5,1,2\n-3,0.25,4\n",
        "# x y z\n5.0e-01 1.0e+00 2.0e+00\n-3 0.25 4\n",  // savetxt(header="x y z")
        "#x,y,z\n0.5,1,2\n-3,0.25,4\n",                   // the same with delimiter=","
        "x y z\n 0.5  1 2\n-3 0.25   4\n", "x;y;z\n0,5;1;2\n-3;0,25;4\n",
        "x\ty\tz\n0,5\t1\t2\n-3\t0,25\t4\n"})
    EXPECT_EQ(positions(text), expected) << text;
  EXPECT_NE(point_error("# \n1 2 3\n").find("names of columns"), std::string::npos);
  EXPECT_NE(point_error("#\n#\n").find("no header line"), std::string::npos);
  EXPECT_NE(point_error("x,y,z\n0,5,1,2\n").find("more fields"), std::string::npos);
}

TEST(PointReader, ListsBetweenTheNumbersOfAPlyArePassedOver) {
  const std::string head =
      " 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 2\n"
      "property list uchar float weights\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  std::string bytes = "ply\nformat binary_little_endian" + head;
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(std::uint8_t{3});
  for (const int corner : {0, 1, 0}) put(corner);
  for (const int k : {0, 1}) {
    put(static_cast<std::uint8_t>(k));
    if (k == 1) put(9.0f);
    for (const float x : {1.0f, 2.0f, 3.0f}) put(x + static_cast<float>(k));
  }
  const std::vector<Vec3d> expected{{1, 2, 3}, {2, 3, 4}};
  EXPECT_EQ(sim::files::parse_points(bytes, "p").x, expected);
  EXPECT_EQ(
      sim::files::parse_points("ply\nformat ascii" + head + "3 0 1 0\n0 1 2 3\n1 9 2 3 4\n", "p").x,
      expected);
}

TEST(PointReader, PointReaderComparesWhatAFileClaimsWithItsLengthBeforeAllocating) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* count : {"1000000000000", "18446744073709551615", "4611686018427387904"}) {
      const std::string header = "ply\nformat " + std::string(format) + " 1.0\nelement vertex " +
                                 count + "\nproperty double x\nproperty double y\n" +
                                 "property double z\nend_header\n1 2 3\n";
      EXPECT_NE(point_error(header).find("truncated"), std::string::npos) << point_error(header);
    }
}

TEST(PointReader, PointReaderTakesLinesOfManyMegabytes) {
  const std::string digits(10u << 20, '1');
  EXPECT_NE(point_error("x,y,z\n1,2," + digits + "\n"), "no error");
  EXPECT_NE(point_error("x,y,z\n" + std::string(10u << 20, ',') + "\n").find("more fields than"),
            std::string::npos);
  EXPECT_NE(point_error(std::string(10u << 20, ',')).find("256"), std::string::npos);
  EXPECT_LT(point_error(digits + "\n1\n").size(), 300u);
  EXPECT_LT(point_error("ply\n" + digits).size(), 300u);
}

// Reading ends for any content of a file: with points that could be simulated, or with an error.
TEST(PointReader, PointReaderSurvivesTruncatedAndDamagedFiles) {
  const std::string ascii =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty double mass\nend_header\n1 2 3 4\n5 6 7 8\n";
  const auto check = [](const std::string& bytes) {
    try {
      const sim::files::PointCloud cloud = sim::files::parse_points(bytes, "p");
      ASSERT_FALSE(cloud.x.empty());
      for (const Vec3d& x : cloud.x) ASSERT_TRUE(x.allFinite());
      for (const double m : cloud.m) ASSERT_GT(m, 0);
      EXPECT_TRUE(cloud.m.empty() || cloud.m.size() == cloud.x.size());
    } catch (const ShapeError&) {
    }
  };
  std::mt19937 random(1);
  for (const std::string& good : {csv, ascii, binary_ply(true), binary_ply(false)}) {
    for (std::size_t length = 0; length < good.size(); ++length) check(good.substr(0, length));
    for (int trial = 0; trial < 5000; ++trial) {
      std::string bad = good;
      for (int damage = 0; damage < 1 + trial % 4; ++damage)
        bad[random() % bad.size()] = static_cast<char>(random());
      check(bad);
    }
  }
}

TEST(Points, PointsTurnAndMoveWithTheirBody) {
  const test::TemporaryFolder folder;
  sim::seeding::Body body;
  body.shape.form =
      sim::shapes::Points{.file = folder.write("p.csv", csv).string(), .center = {10, 0, 0}};
  body.shape.rotation = {0, 0, 90};  // x to y
  const sim::seeding::SeededBody seeded = sim::seeding::seed_body(body, 0, 1, 0.1);
  ASSERT_EQ(seeded.x.size(), 2u);
  // Rotations of 90 degrees are right to rounding.
  EXPECT_LT((seeded.x[0] - Vec3d(8, 1, 3)).norm(), 1e-14);
  EXPECT_LT((seeded.v[0] - Vec3d(-5, 4, 6)).norm(), 1e-14);
  EXPECT_EQ(seeded.volume, 1.25);
  const sim::seeding::SeedingPlan plan = sim::seeding::plan_seeding(body, 0.1);
  EXPECT_DOUBLE_EQ(plan.max_speed, Vec3d(4, 5, 6).norm());
  EXPECT_EQ(plan.mass, 2.5);
  EXPECT_EQ(plan.particle_count, 2u);
  EXPECT_TRUE((plan.bounds.min.array() < seeded.x[0].array()).all());
  EXPECT_TRUE((plan.bounds.max.array() > seeded.x[1].array()).all());
}

TEST(Points, PointsAreReadAgainWhenTheirFileHasChanged) {
  const test::TemporaryFolder folder;
  sim::seeding::Body body;
  const auto count = [&](const std::string& text) {
    body.shape.form = sim::shapes::Points{.file = folder.write("p.csv", text).string()};
    return sim::seeding::plan_seeding(body, 0.1).particle_count;
  };
  EXPECT_EQ(count(csv), 2u);
  EXPECT_EQ(count(csv + "5,5,5,0,0,0,1,1\n"), 3u);
  std::filesystem::remove(folder / "p.csv");
  EXPECT_THROW(sim::seeding::plan_seeding(body, 0.1), ShapeError);
}

TEST(Points, PointsWithoutVolumesNeedASpacing) {
  const sim::files::PointCloud cloud = sim::files::parse_points("x,y,z\n0,0,0\n0.1,0,0\n", "p");
  EXPECT_THROW(sim::shapes::PlacedPoints(cloud, sim::shapes::Points{}, "p"), ShapeError);
  EXPECT_NEAR(
      sim::shapes::PlacedPoints(cloud, sim::shapes::Points{.file = "", .spacing = 0.1}, "p").volume,
      2e-3, 1e-18);
}

TEST(Points, ThinnedPointsKeepMassAndVolume) {
  sim::files::PointCloud cloud;
  double mass = 0, volume = 0;
  for (int k = 1; k <= 1000; ++k) {
    cloud.x.emplace_back(k, 0, 0);
    cloud.m.push_back(k);
    cloud.V.push_back(1e-3 * k);
    mass += k;
    volume += 1e-3 * k;
  }
  for (const double thinning : {1.0, 2.0, 3.375, 8.0, 999.0, 1e9}) {
    const sim::shapes::PlacedPoints points(
        cloud, sim::shapes::Points{.file = "", .thinning = thinning}, "p");
    EXPECT_EQ(points.x.size(), std::max(1.0, std::floor(1000 / thinning)));
    double kept_mass = 0, kept_volume = 0;
    for (std::size_t p = 0; p < points.x.size(); ++p) {
      kept_mass += points.m[p];
      kept_volume += points.V[p];
    }
    // Sums of a thousand rounded numbers.
    EXPECT_NEAR(kept_mass, mass, 1e-12 * mass);
    EXPECT_NEAR(kept_volume, volume, 1e-12 * volume);
  }
}

/// A lattice keeps as many points in every part of it, in order in the file or shuffled.
TEST(PlacedPoints, ThinPointsAreAsEvenInSpaceAsTheyWere) {
  constexpr int side = 32;
  std::vector<Vec3d> lattice;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) lattice.emplace_back(x, y, z);
  std::vector<Vec3d> shuffled = lattice;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  for (const std::vector<Vec3d>& x : {lattice, shuffled})
    for (const double thinning : {2.0, 3.375, 8.0, 20.0, 64.0}) {
      SCOPED_TRACE(thinning);
      const std::vector<std::size_t> kept = sim::shapes::kept_points(x, thinning);
      EXPECT_EQ(kept.size(), static_cast<std::size_t>(std::floor(32768 / thinning)));
      EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
      // Points are counted in cubes of 8 a side, and in layers of 4 along each axis.
      int in_cube[4][4][4] = {}, in_layer[3][side / 4] = {};
      for (const std::size_t k : kept) {
        const Eigen::Vector3i cell = x[k].cast<int>();
        ++in_cube[cell[0] / 8][cell[1] / 8][cell[2] / 8];
        for (int a = 0; a < 3; ++a) ++in_layer[a][cell[a] / 4];
      }
      for (const auto& slab : in_cube)
        for (const auto& row : slab)
          for (const int count : row) EXPECT_NEAR(count, 512 / thinning, 1);
      const double whole_layer = 4 * side * side / thinning;
      for (const auto& layers : in_layer)
        for (const int count : layers) EXPECT_NEAR(count, whole_layer, 0.3 * whole_layer);
    }
}

/// Snow that was packed by half in every second point: what it was before stays, however thin.
TEST(PlacedPoints, ThinPointsKeepTheVolumeBeforePacking) {
  sim::files::PointCloud cloud;
  for (int k = 0; k < 1000; ++k) {
    cloud.x.emplace_back(k, 0, 0);
    cloud.J_P.push_back(k % 2 == 0 ? 1 : 0.5);
  }
  for (const double thinning : {2.0, 3.0, 8.0}) {
    const sim::shapes::PlacedPoints points(
        cloud, sim::shapes::Points{.file = "", .spacing = 0.1, .thinning = thinning}, "p");
    EXPECT_NEAR(points.volume, 1, 1e-12);
    EXPECT_NEAR(points.V0, 1.5, 1e-12);
    ASSERT_EQ(points.V.size(), points.x.size());
    double kept = 0;
    for (const double V : points.V) kept += V;
    EXPECT_NEAR(kept, 1.5, 1e-12);
  }
}

}  // namespace
}  // namespace neve::sim
