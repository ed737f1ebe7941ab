/// The atomic writer: whole files or none, whatever the disk does.

#include "app/output/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

using test::file_count;
using test::read_text;
using test::TemporaryFolder;

/// Exit code of a child process that may not write files of more than `bytes`.
int run_with_file_limit(rlim_t bytes, const std::function<int()>& child) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    app::output::ignore_write_signals();
    ::_exit(child());
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(AtomicFile, AtomicFileReplacesAFileAndLeavesNoTemporary) {
  const TemporaryFolder folder;
  app::output::write_file(folder / "a.txt", std::string_view("old"));
  app::output::write_file(folder / "a.txt", std::string_view("new"),
                          app::output::Durability::synced);
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(AtomicFile, AtomicFileOnAFullDiskKeepsTheOldFileAndSaysWhy) {
  const TemporaryFolder folder;
  app::output::write_file(folder / "a.bin", std::string_view("old"));
  const int code = run_with_file_limit(64 * 1024, [&] {
    try {
      app::output::write_file(folder / "a.bin", std::vector<std::uint8_t>(1 << 20));
    } catch (const IoError& error) {
      const std::string message = error.what();
      const bool is_complete = message.find("a.bin") != std::string::npos &&
                               message.find("1048576 bytes") != std::string::npos &&
                               message.find("File too large") != std::string::npos;
      return is_complete && error.code == exit_io ? 6 : 1;
    }
    return 0;
  });
  EXPECT_EQ(code, 6);
  EXPECT_EQ(read_text(folder / "a.bin"), "old");
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(AtomicFile, AtomicFileFailsInFoldersThatCannotHoldIt) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  EXPECT_THROW(app::output::write_file(folder.path() / "file" / "a.txt", std::string_view("x")),
               IoError);
  EXPECT_THROW(app::output::make_folder(folder.path() / "file" / "sub"), IoError);
  EXPECT_THROW(app::output::write_file("/proc/neve-cannot-write-here", std::string_view("x")),
               IoError);
}

TEST(AtomicFile, AtomicFileOverwritesATemporaryThatAKilledProcessLeft) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.txt";
  folder.write(app::output::temporary_name(file).filename().string(), "half");
  app::output::write_file(file, std::string_view("whole"));
  EXPECT_EQ(read_text(file), "whole");
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(ReadFile, ReaderRefusesFoldersMissingFilesAndTooLargeOnes) {
  const TemporaryFolder folder;
  folder.write("a", "12345");
  EXPECT_THROW(app::output::read_file(folder.path()), IoError);
  EXPECT_THROW(app::output::read_file(folder / "missing"), IoError);
  EXPECT_THROW(app::output::read_file(folder / "a", 4), IoError);
  EXPECT_EQ(app::output::read_file(folder / "a", 5).size(), 5u);
}

}  // namespace
}  // namespace neve::app
