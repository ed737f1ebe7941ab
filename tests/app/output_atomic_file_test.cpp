/// The atomic writer: whole files or none, whatever the disk does.

#include "app/output/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include "app/output/folder_lock.h"
#include "app/output/temporary.h"
#include "app/support/machine.h"
#include "tests/support/child.h"
#include "tests/support/killed.h"
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

TEST(AtomicFile, FilesThatBelongTogetherAreAllWrittenOrNone) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> small(10, 'a'), large(100, 'b');
  const auto write = [&](const char* second) {
    app::output::write_together({{folder / "a.json", small}, {folder / second, large}});
  };
  const auto fails = [&](const char* second) {
    try {
      write(second);
    } catch (const app::IoError&) {
      return 0;
    }
    return 1;
  };
  EXPECT_EQ(run_with_file_limit(50, [&] { return fails("b.png"); }), 0);
  EXPECT_EQ(file_count(folder.path()), 0u);
  std::filesystem::create_directory(folder / "folder.png");
  EXPECT_EQ(fails("folder.png"), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
  write("b.png");
  EXPECT_EQ(read_text(folder / "a.json"), std::string(10, 'a'));
  EXPECT_EQ(read_text(folder / "b.png"), std::string(100, 'b'));
  EXPECT_EQ(run_with_file_limit(50, [&] { return fails("b.png"); }), 0);
  EXPECT_EQ(read_text(folder / "b.png"), std::string(100, 'b'));
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

TEST(AtomicFile, AtomicFileNeverReplacesALinkAFolderOrADevice) {
  const TemporaryFolder folder;
  const std::filesystem::path other = folder.write("other", "mine");
  std::filesystem::create_symlink(other, folder / "link");
  std::filesystem::create_symlink(folder / "nothing", folder / "dangling");
  std::filesystem::create_directory(folder / "sub");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const char* name : {"link", "dangling", "sub", "pipe"})
    EXPECT_THROW(app::output::write_file(folder / name, std::string_view("x")), IoError) << name;
  EXPECT_EQ(read_text(other), "mine");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_EQ(file_count(folder.path()), 5u);
}

TEST(Temporary, TemporaryFilesOfDeadProcessesAreRemovedAndOthersStay) {
  const TemporaryFolder folder;
  test::leave_unfinished({folder.path()});
  const std::filesystem::path living = app::output::temporary_name(folder / "b.txt");
  folder.write(living.filename().string(), "half");
  for (const char* name :
       {".a.tmp", ".a.host.x.00000000.tmp", "notes.tmp", ".a.elsewhere.1.2.0123abcd.tmp"})
    folder.write(name, "x");
  EXPECT_EQ(file_count(folder.path()), 6u);
  app::output::remove_abandoned(folder.path());
  EXPECT_EQ(file_count(folder.path()), 5u);
  EXPECT_TRUE(std::filesystem::exists(living));
  // A process of another machine cannot be asked: after a day it is gone.
  std::filesystem::last_write_time(
      folder / ".a.elsewhere.1.2.0123abcd.tmp",
      std::filesystem::file_time_type::clock::now() - std::chrono::hours(25));
  app::output::remove_abandoned(folder.path());
  EXPECT_EQ(file_count(folder.path()), 4u);
}

/// A killed process keeps its number until it is waited for, which the first process of a machine
/// may be slow to do.
TEST(Temporary, WhatAProcessLeftThatNobodyHasWaitedForIsRemoved) {
  const TemporaryFolder folder;
  const pid_t dead = test::end_unfinished({folder.path()});
  ASSERT_TRUE(test::is_gone_soon(dead));
  ASSERT_EQ(::kill(dead, 0), 0);
  ASSERT_EQ(file_count(folder.path()), 1u);
  app::output::remove_abandoned(folder.path());
  EXPECT_EQ(file_count(folder.path()), 0u);
  test::wait_for(dead);
}

/// A temporary name of this process, as one with another start would have it.
std::string named_with_start(const std::filesystem::path& file, const std::string& other) {
  const std::string mine = app::output::temporary_name(file).filename().string();
  const std::string process = '.' + std::to_string(::getpid()) + '.';
  const std::size_t start = mine.find(process) + process.size();
  return std::string(mine).replace(start, mine.find('.', start) - start, other);
}

/// A temporary folder may hold links to the pictures of a movie, which must stay.
TEST(Temporary, AnAbandonedFolderIsRemovedWithoutWhatItsLinksLeadTo) {
  const TemporaryFolder folder;
  folder.write("picture.png", "mine");
  for (const std::string& name :
       {named_with_start(folder / "movie.mp4.pictures", "1"), std::string(".mine.tmp")}) {
    std::filesystem::create_directory(folder / name);
    std::filesystem::create_symlink(folder / "picture.png", folder / name / "0000.png");
  }
  app::output::remove_abandoned(folder.path());
  EXPECT_EQ(file_count(folder.path()), 2u) << "the picture and the folder with a name of its own";
  EXPECT_EQ(read_text(folder / "picture.png"), "mine");
}

/// Numbers of processes are given again: this one has that of another that began before it.
TEST(Temporary, WhatAProcessLeftWhoseNumberAnotherHasIsRemoved) {
  const TemporaryFolder folder;
  const std::string mine = app::output::temporary_name(folder / "a").filename().string(),
                    others = named_with_start(folder / "a", "1"),
                    unknown = named_with_start(folder / "a", "0");
  for (const std::string& name : {mine, others, unknown}) folder.write(name, "half");
  app::output::remove_abandoned(folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder / mine));
  EXPECT_FALSE(std::filesystem::exists(folder / others));
  EXPECT_TRUE(std::filesystem::exists(folder / unknown))
      << "the system did not tell its process when it began, and it may still write";
}

TEST(Temporary, TemporaryNamesDifferAndFitIntoAFolder) {
  const std::filesystem::path file = std::string(255, 'x');
  EXPECT_NE(app::output::temporary_name("a/b"), app::output::temporary_name("a/b"));
  EXPECT_EQ(app::output::temporary_name("a/b").parent_path(), "a");
  EXPECT_LE(app::output::temporary_name(file).native().size(), 255u);
}

TEST(NamedFile, NamedFileFollowsLinksAndKeepsModeAndNames) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("real.toml", "old, and longer");
  ::chmod(file.c_str(), 0640);
  std::filesystem::create_symlink("real.toml", folder / "link.toml");
  app::output::write_named_file(folder / "link.toml", "new");
  EXPECT_EQ(read_text(file), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.toml"));
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0640));
  std::filesystem::create_hard_link(file, folder / "second.toml");
  app::output::write_named_file(file, "x");
  EXPECT_EQ(read_text(folder / "second.toml"), "x") << "both names still mean one file";
  std::filesystem::create_symlink("to come", folder / "ahead");
  app::output::write_named_file(folder / "ahead", "there");
  EXPECT_EQ(read_text(folder / "to come"), "there");
  EXPECT_EQ(file_count(folder.path()), 5u);
}

TEST(NamedFile, NamedFileWritesIntoPipesAndDevicesAndRefusesTheRest) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  app::output::write_named_file(folder / "pipe", "text");
  char text[8] = "";
  EXPECT_EQ(::read(reader, text, sizeof text), 4);
  EXPECT_STREQ(text, "text");
  ::close(reader);
  std::filesystem::create_symlink("/dev/null", folder / "null");
  app::output::write_named_file(folder / "null", "gone");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "null"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THROW(app::output::write_named_file(folder / "sub", "x"), IoError);
  std::filesystem::create_symlink("circle", folder / "circle");
  EXPECT_THROW(app::output::write_named_file(folder / "circle", "x"), IoError);
}

TEST(NamedFile, NamedFileOfAnOpenDescriptorIsWrittenWhereItIs) {
  const TemporaryFolder folder;
  const int fd = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(::write(fd, "before ", 7), 7);
  app::output::write_named_file("/dev/fd/" + std::to_string(fd), "after");
  ::close(fd);
  EXPECT_EQ(read_text(folder / "log"), "before after");
}

TEST(FolderLock, OneThatHasJustGotItIsNamed) {
  const TemporaryFolder folder;
  folder.write(".lock", "");
  const int file = ::open((folder / ".lock").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(file, LOCK_EX | LOCK_NB), 0);
  std::thread holder([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    folder.write(".lock", "neve render, process 1 on snow\n");
  });
  try {
    const app::output::FolderLock second(folder.path(), "neve view");
    ADD_FAILURE() << "the folder is locked";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("is in use by neve render, process 1"),
              std::string::npos)
        << error.what();
  }
  holder.join();
  ::close(file);
}

TEST(FolderLock, FolderLockIsHeldOnceAndSaysByWhom) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder / "out";
  {
    const app::output::FolderLock first(out, "neve render");
    try {
      const app::output::FolderLock second(out, "neve view");
      FAIL() << "two have it";
    } catch (const IoError& error) {
      const std::string message = error.what();
      EXPECT_NE(
          message.find("neve render, process " + std::to_string(::getpid()) + " on " + host_name()),
          std::string::npos)
          << message;
    }
    EXPECT_FALSE(app::output::FolderLock::try_lock(out, "x"));
  }
  EXPECT_TRUE(app::output::FolderLock::try_lock(out, "x"));
}

TEST(FolderLock, FolderLockIsSharedAmongThoseWhoShare) {
  const TemporaryFolder folder;
  using app::output::FolderLock;
  const auto first = FolderLock::try_lock(folder.path(), "a", FolderLock::Kind::shared);
  const auto second = FolderLock::try_lock(folder.path(), "b", FolderLock::Kind::shared);
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(FolderLock::try_lock(folder.path(), "c"));
}

TEST(FolderLock, FolderLockThatCannotBeIsAnErrorAndNotSomebodyElse) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / ".lock");
  EXPECT_THROW(app::output::FolderLock::try_lock(folder.path(), "x"), IoError);
  const TemporaryFolder other;
  ASSERT_EQ(::mkfifo((other / ".lock").c_str(), 0600), 0);
  EXPECT_THROW(app::output::FolderLock::try_lock(other.path(), "x"), IoError);
}

TEST(ReadFile, ReaderRefusesFoldersMissingFilesAndTooLargeOnes) {
  const TemporaryFolder folder;
  folder.write("a", "12345");
  EXPECT_THROW(app::output::read_file(folder.path()), IoError);
  EXPECT_THROW(app::output::read_file(folder / "missing"), IoError);
  EXPECT_THROW(app::output::read_file(folder / "a", 4), IoError);
  EXPECT_EQ(app::output::read_file(folder / "a", 5).size(), 5u);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(app::output::read_file(folder / "pipe"), IoError) << "it must not wait for a writer";
  EXPECT_THROW(app::output::read_file("/dev/zero"), IoError);
}

}  // namespace
}  // namespace neve::app
