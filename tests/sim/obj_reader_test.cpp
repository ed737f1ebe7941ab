#include "sim/files/obj_reader.h"

#include <gtest/gtest.h>

#include <clocale>
#include <filesystem>
#include <fstream>

#include "sim/base/hash.h"
#include "sim/files/mesh_reader.h"
#include "sim/shapes/mesh.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

constexpr const char* tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::string message_of(const std::string& text) {
  try {
    sim::files::parse_obj(text, "m.obj");
  } catch (const ShapeError& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::string& text, const std::string& part) {
  const std::string message = message_of(text);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(ObjReader, ObjReaderAcceptsAllFormsOfIndices) {
  const sim::files::PolygonMesh mesh = sim::files::parse_obj(
      "v 0 0 0 1\nvt 0 0\nvn 0 0 1\nv +1 .0 0\nv 0 1e0 0 0.5 0.5 0.5\nf 1/1 2/1/1 3//1\nf -3 -2 -1",
      "m");
  ASSERT_EQ(mesh.polygons.size(), 2u);
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(mesh.polygons[1].line, 7u);
  EXPECT_EQ(mesh.vertices[1], Vec3d(1, 0, 0));
}

TEST(ObjReader, ObjReaderIgnoresUnknownStatements) {
  const std::string noise =
      "# v 1\nmtllib x\no a\ng b\ns off\nusemtl c\nvp 1\nl 1 2\np 1\n\n  \t\n";
  EXPECT_EQ(sim::files::parse_obj(noise + tetrahedron + noise, "m").polygons.size(), 4u);
}

TEST(ObjReader, ObjReaderReadsWindowsLinesAndContinuedLines) {
  const sim::files::PolygonMesh mesh = sim::files::parse_obj(
      "# a \\\r\nv x\r\nv 0 \\\r\n0 0\r\nv 1 0 0\nv 0 1 0\nf 1 \\\n 2\\\n 3\r\nf 1 2 9\n"
      "v 0 0 1\nv 0 0 1\nv 0 0 1\nv 0 0 1\nv 0 0 1\nv 0 0 1\n",
      "m");
  EXPECT_EQ(mesh.vertices.size(), 9u);  // the comment swallowed one, a face may look ahead
  EXPECT_EQ(mesh.polygons[1].line, 10u);
}

TEST(ObjReader, ObjReaderDoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  EXPECT_EQ(sim::files::parse_obj("v 0.5 0 0\nf 1 1 1", "m").vertices[0].x(), 0.5);
  std::setlocale(LC_ALL, before.c_str());
}

TEST(ObjReader, ObjReaderNamesTheLineOfBadNumbers) {
  expect_message("v 0 0 0\nv 1 abc 2\n", "m.obj:2: the coordinate \"abc\"");
  expect_message("v 0 nan 0\n", "m.obj:1: the coordinate \"nan\"");
  expect_message("v 0 inf 0\n", "not a finite number");
  expect_message("v 0 1e999 0\n", "not a finite number");
  expect_message("v 0 1,5 0\n", "\"1,5\"");
  expect_message("v 0 1\n", "less than three coordinates");
  expect_message("v 0 1 \x1b[31m\n", "\"?[31m\"");
}

TEST(ObjReader, ObjReaderNamesTheLineOfBadIndices) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* index : {"0", "-4", "x", "99999999999999", "99999999999999999999", "1.5", "/1"})
    expect_message(vertices + "f 1 2 " + index + "\n", "m.obj:4: the face names");
  expect_message(vertices + "f 1 2 4", "m.obj:4: the face names vertex 4; the file has 3");
  expect_message(vertices + "f 1 2 4294967295", "the file has 3");
  expect_message(vertices + "f 1 2\n", "m.obj:4: a face of 2 corners");
  expect_message(vertices + "f\n", "a face of 0 corners");
}

TEST(ObjReader, FilesWithoutFacesAreErrors) {
  for (const std::string& text : {std::string(), std::string("\n"), std::string("v 1 2 3"),
                                  std::string("\0\1\2garbage\xff\n\0", 12)})
    expect_message(text, "m.obj: no faces");
}

TEST(ObjReader, FilesThatCannotBeReadAreErrors) {
  const neve::test::TemporaryFolder folder;
  EXPECT_THROW(sim::files::read_mesh(folder.path().string()), ShapeError);
  EXPECT_THROW(sim::files::read_mesh((folder / "neve no such file.obj").string()), ShapeError);
  EXPECT_THROW(sim::files::read_mesh("/dev/zero"), ShapeError);
  EXPECT_THROW(sim::files::read_mesh(""), ShapeError);
  const std::string large = (folder / "large.obj").string();
  std::ofstream(large).flush();
  std::filesystem::resize_file(large, (256u << 20) + 1);
  EXPECT_THROW(sim::files::read_mesh(large), ShapeError);
}

TEST(ObjReader, AnObjThatNeveHasTurnedAndScaledIsTurnedAndScaledBack) {
  const auto vertex = [](const std::string& comments) {
    return sim::files::parse_obj(
               comments + "v 100 -300 200\nv 0 0 0\nv 100 0 0\nf 1 2 3\n# made up\n", "m")
        .vertices.front();
  };
  EXPECT_EQ(vertex("# neve 0.2.0, time 0 s\n# up z, units per metre 100\n"), Vec3d(1, 2, 3));
  EXPECT_EQ(vertex("# neve 0.2.0, time 0 s\r\n# up y, units per metre 100\r\n"), Vec3d(1, -3, 2));
  for (const char* other : {"# up z, units per metre 100\n", "# Blender, up z\n# up z\n",
                            "# neve 0.2.0, time 0 s, units per metre 100\n", "# neve 0.2.0\n"})
    EXPECT_EQ(vertex(other), Vec3d(100, -300, 200)) << other;
  expect_message(
      "# neve 0.2.0\n# up z, units per metre 0\n" + std::string(tetrahedron),
      "m.obj:2: the comment on the axes of a file of neve cannot be read; expected up y, "
      "units per metre 1, or none");
}

/// Breaks a text in a few places.
std::string mutated(std::string text, std::uint64_t& state) {
  const auto draw = [&](std::size_t below) {
    state = mix64(state);
    return static_cast<std::size_t>(state % below);
  };
  constexpr std::string_view letters = "0123456789-+/. \n\\\rvfe#,";
  for (std::size_t n = 1 + draw(5); n > 0; --n) {
    if (text.empty()) text.push_back('f');
    const std::size_t at = draw(text.size());
    switch (draw(4)) {
      case 0:
        text[at] = letters[draw(letters.size())];
        break;
      case 1:
        text.erase(at, draw(12));
        break;
      case 2:
        text.insert(at, text.substr(draw(text.size()), draw(30)));
        break;
      default:
        text[at] = static_cast<char>(draw(256));
        break;
    }
  }
  return text;
}

TEST(ObjReader, MutatedFilesAreReadOrRefused) {
  std::uint64_t state = 1;
  std::size_t closed = 0, refused = 0;
  for (int k = 0; k < 6000; ++k) {
    try {
      const auto solid = sim::shapes::make_mesh_solid(
          sim::shapes::solid_mesh(sim::files::parse_obj(mutated(tetrahedron, state), "m"), "m"));
      EXPECT_GT(solid->volume(), 0);
      const Vec3d inner = solid->inner_point();
      EXPECT_TRUE(solid->contains(inner));
      ++closed;
    } catch (const ShapeError&) {
      ++refused;
    }
  }
  EXPECT_GT(closed, 60u);  // both ways were walked
  EXPECT_GT(refused, 1500u);
}

}  // namespace
}  // namespace neve::sim
