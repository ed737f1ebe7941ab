/// Pictures of strangers: opening one is as safe as opening a photograph.

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <functional>

#include "app/output/atomic_file.h"
#include "app/record/run_json.h"
#include "render/image/image.h"
#include "render/image/png_chunks.h"
#include "tests/support/costly_cli.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class StrangerPictures : public CostlyCli {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        neve({"render", "scene.toml", "--frames", "0-1", "--out", "run", "--no-movie", "--quiet"})
            .exit_code,
        0);
  }
  /// A picture of the run with other texts, in a folder of its own.
  std::string picture_with(const render::PngText& texts, const std::string& name = "odd.png") {
    const auto bytes = app::output::read_file(folder / "run/particles/0001.png");
    render::PngText all = render::read_png_text(bytes);
    for (const auto& [key, value] : texts) all["neve:" + key] = value;
    fs::create_directories((folder / ("post/" + name)).parent_path());
    app::output::write_file(folder / ("post/" + name),
                            render::encode_png(render::decode_png(bytes), all));
    return "post/" + name;
  }
  /// Expects an end within 5 s and 500 MB, and no internal error.
  void expect_ends(const std::string& arguments) {
    const Cost cost = cost_of(arguments);
    EXPECT_LT(cost.seconds, 5) << arguments;
    EXPECT_LT(cost.memory, 500e6) << arguments;
    EXPECT_NE(cost.exit_code, 1) << arguments << "\n" << read_text(folder / "said");
    EXPECT_NE(cost.exit_code, -1) << arguments << ": a signal";
  }
  /// Expects a refusal that asks for --yes, as nobody can be asked.
  /// @param command  with PICTURE in the place of the picture
  void expect_asks(std::string command, const std::string& picture, const std::string& reason) {
    while (contains(command, "PICTURE")) command.replace(command.find("PICTURE"), 7, picture);
    const Cost cost = cost_of(command + " </dev/null");
    const std::string said = read_text(folder / "said");
    EXPECT_EQ(cost.exit_code, 8) << command << "\n" << said;
    EXPECT_TRUE(contains(said, "--yes") && contains(said, reason)) << command << "\n" << said;
    EXPECT_LT(cost.seconds, 5) << command;
    EXPECT_LT(cost.memory, 500e6) << command;
  }
  void expect_all_end(const std::string& picture) {
    for (const char* command :
         {"info ", "render ", "strip ", "export --format csv ", "dump ", "check "})
      expect_ends(command + picture);
  }
  std::string scene_text() { return json_of("run/run.json")["scene"].get<std::string>(); }
};

TEST_F(StrangerPictures, FilesOfTheKernelAndHugeOnesAreNotHashed) {
  expect_all_end(picture_with({{"files", R"({"/x/proc/self/pagemap": "0"})"}}));
  expect_all_end(picture_with({{"files", R"({"/proc/self/pagemap": "0"})"}}));
  const int sparse = ::open((folder / "huge.obj").c_str(), O_WRONLY | O_CREAT, 0644);
  ASSERT_EQ(::ftruncate(sparse, off_t{1} << 38), 0);
  ::close(sparse);
  expect_all_end(picture_with({{"files", R"({"/x/huge.obj": "0"})"}}));
}

TEST_F(StrangerPictures, LongPathsAndManyNamesEndAtOnce) {
  std::string path, many;
  for (int k = 0; k < 60'000; ++k) path += "a/";
  for (int k = 0; k < 60'000; ++k) many += (k ? ",\"" : "\"") + std::to_string(k) + "\":\"0\"";
  expect_all_end(picture_with({{"files", "{\"" + path + "b\":\"0\"}"}}));
  expect_all_end(picture_with({{"files", "{" + many + "}"}}));
}

TEST_F(StrangerPictures, NumbersThatNoPersonMeansAreRefused) {
  for (const auto& [key, value] : {std::pair{"frame", "2147483647"},
                                   {"frame", "-2147483647"},
                                   {"coarsen", "inf"},
                                   {"coarsen", "nan"},
                                   {"coarsen", "1e300"},
                                   {"shutter", "1e9"},
                                   {"strip", R"({"times":[0,0.01],"columns":1e99,"width":1920})"},
                                   {"strip", R"({"times":[0,0.01],"columns":1,"width":1e99})"}}) {
    const auto info = neve({"info", picture_with({{key, value}})});
    EXPECT_EQ(info.exit_code, 3) << key << " " << value << "\n" << info.errors;
  }
  // A scene with handles has a frame -1, this one has not.
  const auto made_again = neve({"render", picture_with({{"frame", "-1"}}), "--yes"});
  EXPECT_EQ(made_again.exit_code, 3) << made_again.errors;
  expect_all_end(picture_with({{"strip", R"({"times":[0,0.01],"columns":1,"width":16384})"}}));
}

/// A project in a folder that is called like the quoted name of its mesh.
TEST_F(StrangerPictures, ANameThatIsFoundInItsReplacementIsReplacedOnce) {
  const std::string mesh =
      "v 0 0 0\nv .2 0 0\nv 0 .2 0\nv 0 0 .2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::string odd = "post/x\"m.obj\"\\\n[solver]/";
  folder.write(odd + "m.obj", mesh);
  folder.write("m.toml",
               "frames = 0\nsolver.cell_size = 0.02\n[[body]]\nshape = { mesh = { file = "
               "\"m.obj\", center = [0, 0.1, 0] } }\n[output]\nsize = [160, 90]\n");
  folder.write("m.obj", mesh);
  ASSERT_EQ(neve({"render", "m.toml", "--out", "m", "--quiet"}).exit_code, 0);
  fs::copy_file(folder / "m/snow/0000.png", folder / (odd + "0000.png"));
  fs::remove(folder / "m.obj");
  const auto again = neve({"render", odd + "0000.png", "--out", "again"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(hashes("again"), hashes("m"));
  EXPECT_EQ(neve({"info", "again/snow/0000.png"}).exit_code, 0);
  EXPECT_EQ(neve({"render", "again/snow/0000.png", "--out", "third"}).exit_code, 0)
      << "the name of the folder is text, not TOML";
}

TEST_F(StrangerPictures, NoFileIsReadThatThePictureHasNoHashOf) {
  folder.write("secret.csv", "x,y,z\nroot:hidden,0,0\n");
  const std::string secret = (folder / "secret.csv").string();
  std::string scene = scene_text();
  const std::size_t shape = scene.find("shape = { sphere");
  scene.replace(shape, scene.find('\n', shape) - shape,
                "shape = { points = { file = \"" + secret + "\" } }");
  const auto points = neve({"render", picture_with({{"scene", scene}}), "--out", "again"});
  EXPECT_EQ(points.exit_code, 3) << points.errors;
  EXPECT_TRUE(contains(points.errors, "of which it has no hash")) << points.errors;
  EXPECT_FALSE(contains(points.errors + points.output, "hidden"));
  app::output::write_file(
      folder / "photo.png",
      render::encode_png({160, 90, 3, std::vector<std::uint8_t>(160 * 90 * 3, 90)}));
  const std::string plate = picture_with({{"plate", (folder / "photo.png").string()}});
  const auto drawn = neve({"render", plate, "--out", "again"});
  EXPECT_EQ(drawn.exit_code, 3) << drawn.errors;
  EXPECT_TRUE(contains(drawn.errors, "photo.png, of which it has no hash")) << drawn.errors;
  EXPECT_EQ(neve({"render", plate, "--plate", "photo.png", "--out", "again"}).exit_code, 0)
      << "whoever names it may have it";
}

TEST_F(StrangerPictures, WhatTakesLongIsSaidAndAskedFor) {
  const std::string late = picture_with({{"frame", "100000"}});
  const auto info = neve({"info", late});
  EXPECT_TRUE(contains(info.output, "again       about ")) << info.output;
  EXPECT_TRUE(contains(info.output, "100000 frames")) << info.output;
  const std::string frames = picture_with({}, "short.png");
  EXPECT_EQ(neve({"render", frames, "--out", "again"}).exit_code, 0) << "a short one asks nothing";
  const Cost agreed = cost_of("render " + late + " --yes --dry-run");
  EXPECT_EQ(agreed.exit_code, 0) << read_text(folder / "said");
  // A picture in the folder of its run is the user's own.
  fs::copy_file(folder / late, folder / "run/particles/late.png");
  EXPECT_EQ(cost_of("render run/particles/late.png --out late & sleep 2; kill -INT $!; wait $!; "
                    "test $? = 75 -o $? = 130")
                .exit_code,
            0)
      << read_text(folder / "said");
}

/// Every command that opens a picture has the one flag that agrees, and asks.
TEST_F(StrangerPictures, EveryCommandThatOpensOneAsks) {
  const app::Json help = app::parse_json(std::string_view(neve({"help", "--json"}).output));
  int openers = 0;
  std::string text;
  const std::function<void(const app::Json&)> visit = [&](const app::Json& json) {
    if (json.is_object() && json.contains("options")) {
      bool opens = false, agrees = false;
      for (const app::Json& option : json["options"]) {
        const std::string all = app::to_text(option, -1);
        for (const char* words : {"made by neve", "A PNG, or the folder", "or a picture)"})
          opens = opens || contains(all, words);
        agrees = agrees || contains(all, "--yes");
      }
      EXPECT_TRUE(agrees || !opens) << app::to_text(json["command"]);
      openers += opens;
    }
    if (json.is_structured())
      for (const app::Json& part : json) visit(part);
  };
  visit(help);
  EXPECT_GE(openers, 7);

  const std::string late = picture_with({{"frame", "100000"}});
  for (const char* command :
       {"render PICTURE", "render PICTURE --from 900s", "strip PICTURE",
        "export PICTURE --format csv", "compare PICTURE PICTURE --out c --mode beside",
        "sweep PICTURE --from 900s -p material.snow.hardening=5,7 --frames 100010"})
    expect_asks(command, late, " frames, ");
  std::string scene = scene_text();
  const std::size_t cell = scene.find("cell_size = 0.04");
  ASSERT_NE(cell, std::string::npos);
  const std::string large =
      picture_with({{"scene", scene.replace(cell, 16, "cell_size = 0.002")}}, "large.png");
  for (const char* command : {"render PICTURE", "view PICTURE --frames 1 --web", "check PICTURE",
                              "dump PICTURE", "strip PICTURE", "export PICTURE --format csv"})
    expect_asks(command, large, "of memory");
}

/// A picture asks once for all such files; not in its own folder, nor in that of its run.
TEST_F(StrangerPictures, FilesElsewhereAreReadAfterAWord) {
  folder.write("project/m.obj",
               "v 0 0 0\nv .2 0 0\nv 0 .2 0\nv 0 0 .2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write("project/m.toml",
               "frames = 0\nsolver.cell_size = 0.02\n[[body]]\nshape = { mesh = { file = "
               "\"m.obj\", center = [0, 0.1, 0] } }\n[output]\nsize = [160, 90]\n");
  ASSERT_EQ(neve({"render", "project/m.toml", "--out", "project/m", "--quiet"}).exit_code, 0);
  EXPECT_EQ(neve({"dump", "project/m/snow/0000.png", "--json"}).exit_code, 0)
      << "in the folder of its run";
  fs::create_directories(folder / "mail");
  fs::copy_file(folder / "project/m/snow/0000.png", folder / "mail/m.png");
  for (const char* command : {"render PICTURE", "view PICTURE --frames 1 --web", "check PICTURE",
                              "dump PICTURE", "strip PICTURE", "export PICTURE --format csv",
                              "compare PICTURE PICTURE --out c --mode beside"})
    expect_asks(command, "mail/m.png", "outside of its folder");
  EXPECT_EQ(neve({"dump", "mail/m.png", "--json", "--yes"}).exit_code, 0);
  const auto info = neve({"info", "mail/m.png"});
  EXPECT_TRUE(contains(info.output, "project/m.obj (")) << info.output;
  fs::copy_file(folder / "project/m.obj", folder / "mail/m.obj");
  EXPECT_EQ(neve({"dump", "mail/m.png", "--json"}).exit_code, 0) << "beside the picture";
}

/// Words of a file that is no mesh and no look are in no message.
TEST_F(StrangerPictures, NeitherALookNorAChangeReadsAFileWithoutItsHash) {
  folder.write("secret.txt", "v root:hidden 1\n");
  const std::string secret = (folder / "secret.txt").string();
  const auto change = [&](const std::string& address, const std::string& value) {
    return std::pair<std::string, std::string>(
        "changes",
        app::to_text(app::Json::array({{{"step", 0}, {"address", address}, {"value", value}}}),
                     -1));
  };
  for (const auto& [key, value] :
       {std::pair<std::string, std::string>("lut", secret),
        change("collider.floor.shape", "{ mesh = { file = \"" + secret + "\" } }"),
        change("collider.floor.shape.mesh.file", secret),
        change("collider.floor.shape",
               "{ mesh_sequence = { files = \"" + secret + "%d\", last = 3 } }")}) {
    const auto result = neve({"render", picture_with({{key, value}}), "--out", "again"});
    EXPECT_EQ(result.exit_code, 3) << value << result.errors;
    EXPECT_TRUE(contains(result.errors, "of which it has no hash")) << value << result.errors;
    EXPECT_FALSE(contains(result.errors + result.output, "hidden")) << result.errors;
  }
}

/// Returns packed zeros, made in little memory: that of a test counts for its children.
std::vector<std::uint8_t> packed_zeros(std::size_t size) {
  std::vector<std::uint8_t> packed, zeros(1 << 20), out(1 << 20);
  z_stream stream{};
  deflateInit(&stream, 9);
  while (true) {
    stream.next_in = zeros.data();
    stream.avail_in = static_cast<uInt>(std::min(size, zeros.size()));
    size -= stream.avail_in;
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = deflate(&stream, size > 0 ? Z_NO_FLUSH : Z_FINISH);
    packed.insert(packed.end(), out.data(), stream.next_out);
    if (result == Z_STREAM_END) break;
  }
  deflateEnd(&stream);
  return packed;
}

void add_zeros(std::size_t size, const std::string& header, std::vector<std::uint8_t>& png) {
  const std::vector<std::uint8_t> packed = packed_zeros(size);
  const auto add = [&](const std::string& type, const std::vector<std::uint8_t>& data) {
    const auto put = [&](std::uint32_t number) {
      for (const int shift : {24, 16, 8, 0}) png.push_back(std::uint8_t(number >> shift));
    };
    put(static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = png.size();
    png.insert(png.end(), type.begin(), type.end());
    png.insert(png.end(), data.begin(), data.end());
    put(static_cast<std::uint32_t>(
        crc32_z(crc32_z(0, nullptr, 0), png.data() + begin, png.size() - begin)));
  };
  png.assign({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
  add("IHDR", {header.begin(), header.end()});
  if (header[9] == 3) add("PLTE", std::vector<std::uint8_t>(6));
  if (header[9] == 3) add("tRNS", {0, 1});
  add("IDAT", packed);
  add("IEND", {});
}

TEST_F(StrangerPictures, PicturesThatUnpackToMuchMoreAreRefusedByTheirHeader) {
  std::vector<std::uint8_t> palette, idat;
  add_zeros((2048 + 1) * 16384, std::string("\0\0\x40\0\0\0\x40\0\1\3\0\0\0", 13), palette);
  add_zeros(std::size_t{300} << 20, std::string("\0\0\0\x60\0\0\0\x40\x08\2\0\0\0", 13), idat);
  app::output::write_file(folder / "palette.png", palette);
  app::output::write_file(folder / "idat.png", idat);
  for (const char* command :
       {"compare palette.png palette.png", "render scene.toml --frames 0 --plate palette.png",
        "render scene.toml --frames 0 --reference palette.png"}) {
    const Cost cost = cost_of(std::string(command) + " --max-memory 400MB");
    EXPECT_TRUE(cost.exit_code == 8 || cost.exit_code == 2)
        << command << cost.exit_code << read_text(folder / "said");
    EXPECT_LT(cost.memory, 440e6) << command;
  }
  const Cost cost = cost_of("compare idat.png idat.png");
  EXPECT_EQ(cost.exit_code, 3);
  EXPECT_LT(cost.memory, 200e6);
  EXPECT_TRUE(contains(read_text(folder / "said"), "unpack to more than its pixels"));
}

/// The texts of a picture are those of a scene with defaults written out: longer than a file may
/// be.
TEST_F(StrangerPictures, PicturesOfLongScenesAreReadAgain) {
  std::string text = "frames = 0\nsolver.cell_size = 0.04\n[output]\nsize = [160, 90]\n";
  for (int k = 0; k < 6000; ++k)
    text += "[[body]]\nshape = { box = { center = [" + std::to_string(k % 80) + ", 0, " +
            std::to_string(k / 80) + "], size = [0.04, 0.04, 0.04] } }\n";
  folder.write("long.toml", text);
  ASSERT_EQ(neve({"render", "long.toml", "--out", "long", "--quiet"}).exit_code, 0);
  const auto again = neve({"dump", "long/snow/0000.png", "--at", "0", "--json"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
}

}  // namespace
}  // namespace neve::test
