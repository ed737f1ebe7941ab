/// Files of an earlier run that a new one in its folder removes, and those that it never touches.

#include "app/record/earlier.h"

#include <gtest/gtest.h>

#include "app/output/atomic_file.h"
#include "app/record/picture_record.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::string listed(const std::string& file, const std::string& text) {
  return '"' + file + "\": \"" + record::hash_of(text) + '"';
}

TEST(EarlierRun, RemovesFilesWithTheBytesThatItsListHasTheHashOf) {
  const TemporaryFolder folder;
  for (const char* name : {"particles/0000.png", "particles/0001.png", "particles/notes.txt",
                           "particles.mp4", "exports/ply/0000.ply"})
    folder.write(name, name);
  folder.write("changed.png", "by a person");
  folder.write("run.json", "{\"files\": {" + listed("particles/0000.png", "particles/0000.png") +
                               "," + listed("particles.mp4", "particles.mp4") + "," +
                               listed("exports/ply/0000.ply", "exports/ply/0000.ply") + "," +
                               listed("changed.png", "by neve") + "}}");
  EXPECT_EQ(record::remove_earlier_run(folder.path()), 3u);
  EXPECT_FALSE(fs::exists(folder / "particles/0000.png"));
  EXPECT_FALSE(fs::exists(folder / "particles.mp4"));
  EXPECT_FALSE(fs::exists(folder / "exports/ply")) << "a folder that is empty goes too";
  for (const char* name : {"particles/0001.png", "particles/notes.txt", "changed.png", "run.json"})
    EXPECT_TRUE(fs::exists(folder / name)) << name;
}

/// A list that anyone can write: names without a hash, or with a wrong one.
TEST(EarlierRun, RemovesNoFileOfAPerson) {
  const TemporaryFolder folder;
  for (const char* name : {"thesis.tex", "photos/0001.png", "particles/0000.png", "particles.mp4"})
    folder.write(name, "mine");
  for (const char* list :
       {R"({"exports": [{"series": "thesis.tex", "files": [{"file": "thesis.tex"}]}]})",
        R"({"views": ["photos"], "frames": [{"frame": 1}]})",
        R"({"views": ["particles"], "frames": [{"frame": 0}]})",
        R"({"files": {"thesis.tex": "0000000000000000", "photos/0001.png": 7}})"}) {
    folder.write("run.json", list);
    EXPECT_EQ(record::remove_earlier_run(folder.path()), 0u) << list;
  }
}

TEST(EarlierRun, IsNotLedOutOfItsFolder) {
  const TemporaryFolder outer;
  outer.write("victim.png", "x");
  outer.write("real/0000.png", "x");
  const fs::path run = outer / "run";
  fs::create_directories(run);
  fs::create_directory_symlink(outer / "real", run / "link");
  outer.write("run/run.json", "{\"files\": {" + listed("../victim.png", "x") + "," +
                                  listed((outer / "victim.png").string(), "x") + "," +
                                  listed("link/0000.png", "x") + "," + listed("", "x") + "," +
                                  listed(".", "x") + "}}");
  EXPECT_EQ(record::remove_earlier_run(run), 0u);
  EXPECT_TRUE(fs::exists(outer / "victim.png"));
  EXPECT_TRUE(fs::exists(outer / "real/0000.png"));
}

TEST(EarlierRun, RemovesNothingWhenRunJsonIsMissingOrBroken) {
  const TemporaryFolder folder;
  folder.write("particles/0000.png", "x");
  EXPECT_EQ(record::remove_earlier_run(folder.path()), 0u);
  const std::string deep(100'000, '[');
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string("3"), deep,
        std::string(R"({"views": 3, "frames": "x", "files": []})"), std::string("\xff\xfe")}) {
    folder.write("run.json", text);
    EXPECT_EQ(record::remove_earlier_run(folder.path()), 0u);
  }
  EXPECT_TRUE(fs::exists(folder / "particles/0000.png"));
}

/// Whoever is killed has listed the last picture, and has not noted its hash yet.
TEST(EarlierRun, RemovesPicturesWithoutAHashThatSayTheyAreOfIt) {
  const TemporaryFolder folder;
  record::RunRecord run;
  run.views = {"particles"};
  run.frames.resize(2);
  run.frames[1].frame = 1;
  run.frames[0].state_hash = run.frames[1].state_hash = 7;
  record::write_run_json(folder.path(), run);
  fs::create_directories(folder / "particles");
  for (const int frame : {0, 1}) {
    record::PictureRecord record;
    record.scene = "frames = 1\n";
    record.view = "particles";
    record.frame = frame;
    record.state_hash = record::hash_text(frame == 0 ? 7 : 8);
    const render::Image image{2, 2, 3, std::vector<std::uint8_t>(12, 100)};
    output::write_file(folder / record::picture_name("particles", frame),
                       render::encode_png(image, record::to_png_text(record)));
  }
  EXPECT_EQ(record::remove_earlier_run(folder.path()), 1u);
  EXPECT_FALSE(fs::exists(folder / "particles/0000.png"));
  EXPECT_TRUE(fs::exists(folder / "particles/0001.png")) << "of another state";
}

}  // namespace
}  // namespace neve::app
