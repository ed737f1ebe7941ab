#include "app/output/checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/output/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

namespace fs = std::filesystem;

app::output::Checkpoint checkpoint(int frame, std::size_t steps) {
  app::output::Checkpoint c;
  c.identity = "abc";
  c.simd = "avx2";
  c.frame = frame;
  c.steps = steps;
  c.progress = {{"steps", 7}};
  for (std::size_t k = 0; k < 1000; ++k) c.state.push_back(static_cast<std::uint8_t>(k * steps));
  return c;
}

std::vector<fs::path> files(const test::TemporaryFolder& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder / "checkpoint")) all.push_back(entry);
  std::sort(all.begin(), all.end());
  return all;
}

TEST(CheckpointFile, CheckpointFileComesBackWholeAndOnlyTwoAreKept) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(app::output::find_checkpoint(folder.path()).checkpoint);
  for (const auto& [frame, steps] : {std::pair{1, 10u}, {2, 20u}, {10, 90u}, {10, 99u}})
    app::output::write_checkpoint(folder.path(), checkpoint(frame, steps));
  EXPECT_EQ(files(folder).size(), 2u);
  const app::output::FoundCheckpoint found = app::output::find_checkpoint(folder.path());
  ASSERT_TRUE(found.checkpoint);
  EXPECT_TRUE(found.damaged.empty());
  EXPECT_EQ(found.checkpoint->frame, 10);
  EXPECT_EQ(found.checkpoint->steps, 99u);
  EXPECT_EQ(found.checkpoint->identity, "abc");
  EXPECT_EQ(found.checkpoint->simd, "avx2");
  EXPECT_EQ(found.checkpoint->progress["steps"], 7);
  EXPECT_EQ(found.checkpoint->state, checkpoint(10, 99).state);
}

/// Lists of very long runs were written, and taken for damage when they were read.
TEST(CheckpointFile, OneWithVeryLongListsIsRead) {
  app::output::Checkpoint c = checkpoint(1, 10);
  c.progress = {{"list", std::string(70'000'000, 'x')}};
  EXPECT_EQ(app::output::parse_checkpoint(app::output::encode_checkpoint(c)).state, c.state);
}

TEST(CheckpointFile, ADamagedOneIsNamedAndTheOlderOneTaken) {
  const test::TemporaryFolder folder;
  app::output::write_checkpoint(folder.path(), checkpoint(1, 10));
  app::output::write_checkpoint(folder.path(), checkpoint(2, 20));
  const fs::path newest = files(folder).back();
  const std::vector<std::uint8_t> good = app::output::read_file(newest);
  const auto expect_older = [&](const std::vector<std::uint8_t>& bytes) {
    app::output::write_file(newest, bytes);
    const app::output::FoundCheckpoint found = app::output::find_checkpoint(folder.path());
    ASSERT_TRUE(found.checkpoint);
    EXPECT_EQ(found.checkpoint->frame, 1);
    ASSERT_EQ(found.damaged.size(), 1u);
    EXPECT_NE(found.damaged[0].find("000002-"), std::string::npos) << found.damaged[0];
  };
  expect_older({});
  expect_older({good.begin(), good.begin() + 20});
  expect_older({good.begin(), good.end() - 1});
  // Any bit of it.
  for (std::size_t at = 0; at < good.size(); at += 37) {
    std::vector<std::uint8_t> bytes = good;
    bytes[at] ^= 0x10;
    expect_older(bytes);
  }
}

TEST(CheckpointFile, RemovalLeavesOtherFiles) {
  const test::TemporaryFolder folder;
  app::output::write_checkpoint(folder.path(), checkpoint(1, 10));
  folder.write("checkpoint/notes.txt", "mine");
  app::output::remove_checkpoints(folder.path());
  EXPECT_EQ(files(folder), std::vector<fs::path>{folder / "checkpoint/notes.txt"});
}

}  // namespace
}  // namespace neve::app
