#include "sim/files/mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "sim/base/hash.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/triangulate.h"
#include "sim/types/errors.h"
#include "tests/support/meshes.h"

namespace neve::sim {
namespace {

template <class T>
void put(std::string& bytes, T value, bool is_little = true) {
  char text[sizeof value];
  std::memcpy(text, &value, sizeof value);
  if (!is_little) std::reverse(text, text + sizeof value);
  bytes.append(text, sizeof value);
}

files::PolygonMesh box() {
  return files::parse_mesh(neve::test::box_obj({1, 2, 3}), "box.obj");
}

/// Calls for each triangle of the box, with three corners.
template <class Use>
void for_triangles(const Use& use) {
  const files::PolygonMesh mesh = box();
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.corners[k]]; };
    const std::size_t first = mesh.polygons[p].first;
    use(at(first), at(first + 1), at(first + 2));
    use(at(first), at(first + 2), at(first + 3));
  }
}

std::string ascii_stl() {
  std::string text = "solid box\n";
  for_triangles([&](const auto&... corners) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const Vec3d& x : {corners...})
      text += "  vertex " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " +
              std::to_string(x[2]) + "\n";
    text += " endloop\nendfacet\n";
  });
  return text + "endsolid box\n";
}

std::string binary_stl() {
  // Many programs write this word in front of binary files too.
  std::string bytes = "solid of a program that does not know better";
  bytes.resize(80, ' ');
  put(bytes, std::uint32_t{12});
  for_triangles([&](const auto&... corners) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0f);
    for (const Vec3d& x : {corners...})
      for (const double value : x) put(bytes, static_cast<float>(value));
    put(bytes, std::uint16_t{0});
  });
  return bytes;
}

std::string ply(const std::string& format) {
  const files::PolygonMesh mesh = box();
  std::string bytes =
      "ply\nformat " + format +
      " 1.0\ncomment made\nelement vertex 8\nproperty double x\nproperty uchar red\n"
      "property double y\nproperty double z\nelement face 6\nproperty uchar part\n"
      "property list uchar int vertex_indices\nproperty list uchar float uv\n"
      "end_header\n";
  const bool is_text = format == "ascii", is_little = format == "binary_little_endian";
  const auto number = [&](auto value) {
    if (is_text)
      bytes += std::to_string(value) + (bytes.size() % 7 == 0 ? "\n" : " ");
    else
      put(bytes, value, is_little);
  };
  for (const Vec3d& x : mesh.vertices) {
    number(x[0]);
    number(std::uint8_t{200});
    number(x[1]);
    number(x[2]);
  }
  for (std::size_t p = 0; p < 6; ++p) {
    number(std::uint8_t{1});
    number(std::uint8_t{4});
    for (std::size_t c = 0; c < 4; ++c) number(static_cast<std::int32_t>(mesh.corners[4 * p + c]));
    number(std::uint8_t{2});
    number(0.5f);
    number(0.25f);
  }
  return bytes;
}

std::string mesh_message(const std::string& bytes, const std::string& name = "m") {
  try {
    files::parse_mesh(bytes, name);
  } catch (const ShapeError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshReader, EveryFormatGivesTheSameSolid) {
  for (const std::string& bytes : {ascii_stl(), binary_stl(), ply("ascii"),
                                   ply("binary_little_endian"), ply("binary_big_endian")}) {
    const shapes::SolidMesh mesh =
        shapes::solid_mesh(files::parse_mesh(bytes, "m"), bytes.substr(0, 40));
    EXPECT_DOUBLE_EQ(mesh.volume, 6);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(shapes::bounds_of(mesh).max, Vec3d(0.5, 1, 1.5));
  }
}

TEST(MeshReader, StlOfOtherProgramsIsRead) {
  const auto triangles = [](const std::string& bytes, const std::string& name) {
    return files::parse_mesh(bytes, name).polygons.size();
  };
  std::string upper = ascii_stl();
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(triangles(upper, "m.stl"), 12u);
  EXPECT_EQ(triangles("\r\n  \t" + upper, "m"), 12u);
  EXPECT_EQ(triangles(binary_stl() + "a trailer", "M.STL"), 12u);
  std::string no_count = binary_stl();
  no_count.replace(80, 4, std::string(4, '\0'));
  EXPECT_EQ(triangles(no_count, "m.stl"), 12u);
  // Only the name says that such bytes are an STL.
  EXPECT_NE(mesh_message(no_count, "m.obj"), "no error");
}

TEST(MeshReader, StripsOfAPlyAreTriangles) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0 1 0 0 0 1 0 0 0 1\n";
  // A tetrahedron as one strip that turns round its corners, and as two.
  for (const char* strip : {"6 0 2 1 3 0 2\n", "10 0 2 1 3 -1 1 3 0 2 -1\n"}) {
    const shapes::SolidMesh mesh = shapes::solid_mesh(files::parse_mesh(head + strip, "m"), "m");
    EXPECT_EQ(mesh.triangles.size(), 4u) << strip;
    EXPECT_DOUBLE_EQ(mesh.volume, 1.0 / 6) << strip;
    EXPECT_EQ(mesh.reading.turned_faces, 0u) << strip;
  }
}

TEST(MeshReader, APlyThatNeveHasTurnedAndScaledIsTurnedAndScaledBack) {
  const auto vertex = [](const std::string& comments) {
    return files::parse_mesh(
               "ply\nformat ascii 1.0\n" + comments +
                   "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "100 -300 200\n0 0 0\n100 0 0\n3 0 1 2\n",
               "m")
        .vertices.front();
  };
  EXPECT_EQ(vertex("comment neve 0.2.0\ncomment up z, units per metre 100\n"), Vec3d(1, 2, 3));
  EXPECT_EQ(vertex("comment up z, units per metre 100\n"), Vec3d(100, -300, 200));
}

TEST(MeshReader, NamesOfAPlyMayBeCapitals) {
  std::string capitals = ply("ascii");
  for (const char* const axis : {"double x", "double y", "double z"})
    capitals[capitals.find(axis) + 7] -= 'a' - 'A';
  const files::PolygonMesh mesh = files::parse_mesh(capitals, "m.ply");
  EXPECT_EQ(mesh.vertices, files::parse_mesh(ply("ascii"), "m.ply").vertices);
}

TEST(MeshReader, FacesOfAPlyMayHaveIndices) {
  const auto with_list = [](const std::string& name) {
    std::string bytes = ply("ascii");
    return bytes.replace(bytes.find("vertex_indices"), std::string("vertex_indices").size(), name);
  };
  EXPECT_EQ(files::parse_mesh(with_list("indices"), "m.ply").corners,
            files::parse_mesh(ply("ascii"), "m.ply").corners);
  const std::string message = mesh_message(with_list("corners_of_it"), "m.ply");
  EXPECT_NE(message.find("its faces have no list of their vertices"), std::string::npos) << message;
}

TEST(MeshReader, AByteOrderMarkShiftsNoIndex) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
      "f 1 4 3\n";
  EXPECT_EQ(files::parse_mesh("\xEF\xBB\xBF" + text, "m.obj").vertices.size(), 5u);
  EXPECT_EQ(files::parse_mesh("\xEF\xBB\xBF" + ply("ascii"), "m.ply").polygons.size(), 6u);
  EXPECT_EQ(files::parse_mesh("\xEF\xBB\xBF" + ascii_stl(), "m.stl").polygons.size(), 12u);
  EXPECT_NE(mesh_message("\xFF\xFEv", "m.obj").find("UTF-16"), std::string::npos);
}

TEST(MeshReader, MistakesAreNamed) {
  const auto expect = [](const std::string& bytes, const std::string& name,
                         const std::string& part) {
    EXPECT_NE(mesh_message(bytes, name).find(part), std::string::npos) << mesh_message(bytes, name);
  };
  expect("o x\n", "m.obj", "neve reads OBJ, PLY and STL");
  expect("x", "m.ply", "begin with a line \"ply\"");
  expect("x", "m.stl", "50 for each triangle");
  expect(binary_stl().substr(0, 400), "m.stl", "neither an ascii STL");
  expect("Kaydara FBX Binary", "m.FBX", "File > Export > Wavefront");
  expect("solid x\nfacet\nvertex 0 0 0\nendfacet\n", "m", "m:4: a triangle of 1 corners");
  expect("solid x\nfacet\nvertex 0 snow 0\n", "m", "m:3: the coordinate \"snow\"");
  expect("solid x\nfacet\nvertex 0 0 0\n", "m", "ends inside a triangle");
  expect(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
      "float z\nend_header\n1 2 3\n",
      "m", "points = { file");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 1 0 0 0 1 0\n";
  expect(head + "3 0 1 3\n", "m", "face 1 names vertex 3; the file has 3");
  expect(head + "3 0 1 -1\n", "m", "is not a number from 0");
  expect(head + "2 0 1\n", "m", "face 1 has 2 corners");
  expect(head + "3 0 1\n", "m", "truncated");
  expect(head + "3 0 1 2\n3 2 1 0\n", "m", "more data than the elements of the header");
  for (const char* format : {"binary_little_endian", "binary_big_endian"}) {
    expect(ply(format) + std::string(17, '\1'), "m", "more data than the elements of the header");
    EXPECT_EQ(files::parse_mesh(ply(format) + "\r\n", "m").polygons.size(), 6u)
        << "some writers end with a byte or two of their own";
  }
  expect(binary_stl() + binary_stl().substr(84, 100), "m.stl",
         "its header counts 12 triangles, and 14 are in the file");
  expect(head + "200 0 1\n", "m", "longer than the file");
  expect("ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n1\n",
         "m", "truncated: the header promises 99999999999");
  expect("ply\nformat ascii 1.0\nelement vertex 3\nproprty float x\nend_header\n", "m",
         "m:4: \"proprty\" is not a keyword");
  expect("ply\nend_header\n", "m", "names no format");
  expect("ply\nformat ascii 1.0\n", "m", "without end_header");
}

/// Whatever is missing or changed, the answer is a mesh or an error.
TEST(MeshReader, TruncatedAndForgedFilesAreErrors) {
  std::uint64_t seed = 1;
  for (const std::string& good : {binary_stl(), ascii_stl(), ply("ascii"),
                                  ply("binary_little_endian"), ply("binary_big_endian")}) {
    for (std::size_t end = 0; end < good.size(); end += 3)
      EXPECT_NE(mesh_message(good.substr(0, end), "m.ply"), "");
    for (int k = 0; k < 400; ++k) {
      std::string bytes = good;
      seed = mix64(seed, 7);
      bytes[seed % bytes.size()] = static_cast<char>(seed >> 32);
      mesh_message(bytes);
    }
  }
}

double area_of(const std::vector<Vec3d>& polygon,
               const std::vector<shapes::CornerTriple>& triangles) {
  double area = 0;
  for (const auto& [i, j, k] : triangles)
    area += 0.5 * (polygon[j] - polygon[i]).cross(polygon[k] - polygon[i]).norm();
  return area;
}

TEST(Triangulate, EarsCoverConcavePolygons) {
  // Stars: the more corners, the deeper the dents.
  const Mat3d turn = rotation_from_degrees({20, 40, 60});
  for (const int points : {3, 5, 8, 40, 200}) {
    std::vector<Vec3d> star;
    double area = 0;
    for (int k = 0; k < 2 * points; ++k) {
      const double r = k % 2 == 0 ? 1 : 0.3, a = std::numbers::pi * k / points;
      star.emplace_back(turn * Vec3d(r * std::cos(a), r * std::sin(a), 2));
      area += 0.5 * 0.3 * std::sin(std::numbers::pi / points);
    }
    EXPECT_FALSE(shapes::is_convex(star));
    const auto triangles = shapes::cut_ears(star);
    ASSERT_TRUE(triangles) << points;
    EXPECT_EQ(triangles->size(), star.size() - 2);
    // Triangles that overlap, or reach beyond the star, would have more.
    EXPECT_NEAR(area_of(star, *triangles), area, 1e-12 * points);
  }
}

TEST(Triangulate, StraightCornersAndSlitsAreTriangulated) {
  // A square with corners on its sides, and a slit to its middle and back.
  const std::vector<Vec3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0},
                                  {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  const auto triangles = shapes::cut_ears(square);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 6u);
  EXPECT_NEAR(area_of(square, *triangles), 3, 1e-14);
  const std::vector<Vec3d> slit{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0},
                                {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const auto around = shapes::cut_ears(slit);
  ASSERT_TRUE(around);
  EXPECT_NEAR(area_of(slit, *around), 4, 1e-14);
}

TEST(Triangulate, CrossingSidesAreFound) {
  EXPECT_FALSE(shapes::cut_ears({{0, 0, 0}, {2, 0, 0}, {0.5, 2, 0}, {1.5, 1, 0}}));
}

}  // namespace
}  // namespace neve::sim
