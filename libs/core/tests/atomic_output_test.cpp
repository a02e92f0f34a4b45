#include <priormap/core/atomic_output.hpp>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <priormap/core/error.hpp>

namespace fs = std::filesystem;
using priormap::AtomicDirectory;
using priormap::AtomicFile;
using priormap::IoError;
using priormap::Overwrite;

namespace {

class AtomicOutputTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_ = fs::temp_directory_path() / ("priormap_atomic_" + std::to_string(::getpid()));
};

TEST_F(AtomicOutputTest, FileAppearsOnlyWhenCommitted) {
  const fs::path target = folder_ / "new/sub/a.txt";
  AtomicFile file(target, Overwrite::refuse);
  write(file.temporary_path(), "whole");
  EXPECT_FALSE(fs::exists(target));
  EXPECT_EQ(file.temporary_path().extension(), ".txt");
  file.commit();
  EXPECT_EQ(read(target), "whole");
  EXPECT_FALSE(fs::exists(file.temporary_path()));
}

TEST_F(AtomicOutputTest, FileWithoutCommitLeavesNothing) {
  { AtomicFile file(folder_ / "a.txt", Overwrite::refuse); }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(AtomicOutputTest, ExistingFileIsKeptUnlessOverwritten) {
  write(folder_ / "a.txt", "old");
  EXPECT_THROW(AtomicFile(folder_ / "a.txt", Overwrite::refuse), IoError);
  AtomicFile file(folder_ / "a.txt", Overwrite::allow);
  write(file.temporary_path(), "new");
  EXPECT_EQ(read(folder_ / "a.txt"), "old");
  file.commit();
  EXPECT_EQ(read(folder_ / "a.txt"), "new");
}

TEST_F(AtomicOutputTest, FileThatAppearsMeanwhileIsNotReplaced) {
  AtomicFile file(folder_ / "a.txt", Overwrite::refuse);
  write(folder_ / "a.txt", "other");
  EXPECT_THROW(file.commit(), IoError);
  EXPECT_EQ(read(folder_ / "a.txt"), "other");
}

TEST_F(AtomicOutputTest, DevicesAndFoldersAreNoFileTargets) {
  EXPECT_THROW(AtomicFile("/dev/null", Overwrite::allow), IoError);
  EXPECT_THROW(AtomicFile(folder_, Overwrite::allow), IoError);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicOutputTest, UncreatableParentNamesTheFolder) {
  write(folder_ / "plain", "");
  try {
    AtomicFile(folder_ / "plain/a.txt", Overwrite::refuse);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("plain"), std::string::npos);
  }
}

TEST_F(AtomicOutputTest, DirectoryAppearsOnlyWhenCommitted) {
  const fs::path target = folder_ / "deep/prior";
  {
    AtomicDirectory directory(fs::path(target) / "", Overwrite::refuse, "prior.json");
    write(directory.temporary_path() / "prior.json", "{}");
    EXPECT_FALSE(fs::exists(target));
    directory.commit();
  }
  EXPECT_EQ(read(target / "prior.json"), "{}");
  EXPECT_THROW(AtomicDirectory(target, Overwrite::refuse, "prior.json"), IoError);
}

TEST_F(AtomicOutputTest, DirectoryIsReplacedWhole) {
  const fs::path target = folder_ / "prior";
  fs::create_directories(target / "tiles");
  write(target / "prior.json", "old");
  write(target / "tiles/stale.las", "");
  {
    AtomicDirectory directory(target, Overwrite::allow, "prior.json");
    write(directory.temporary_path() / "prior.json", "new");
    EXPECT_EQ(read(target / "prior.json"), "old");
    directory.commit();
  }
  EXPECT_EQ(read(target / "prior.json"), "new");
  EXPECT_FALSE(fs::exists(target / "tiles"));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicOutputTest, StrangersFolderIsNeverReplaced) {
  fs::create_directories(folder_ / "home");
  write(folder_ / "home/letter.txt", "dear");
  EXPECT_THROW(AtomicDirectory(folder_ / "home", Overwrite::allow, "prior.json"), IoError);
  EXPECT_EQ(read(folder_ / "home/letter.txt"), "dear");
  EXPECT_EQ(entries(), 1u);
}

/// A process that begins outputs and holds them until it is killed.
class Maker {
 public:
  explicit Maker(const std::function<void()>& begin) {
    int ready[2];
    if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) {
      begin();
      [[maybe_unused]] const auto told = ::write(ready[1], "x", 1);
      for (;;) ::pause();
    }
    char byte;
    if (::read(ready[0], &byte, 1) != 1) throw std::runtime_error("the child failed");
    ::close(ready[0]), ::close(ready[1]);
  }
  ~Maker() { kill(); }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  pid_t child_;
};

TEST_F(AtomicOutputTest, WhatAKilledProgramLeftGoesWithTheNextOfTheSameTarget) {
  const fs::path of_file = folder_ / "file", of_directory = folder_ / "directory", of_others = folder_ / "others";
  const auto left = [](const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); };
  const auto begin_all = [&] {
    static const AtomicFile file(of_file / "a.txt", Overwrite::refuse);
    static const AtomicDirectory directory(of_directory / "prior", Overwrite::refuse, "marker");
    static const AtomicDirectory other(of_others / "prior", Overwrite::refuse, "marker");
    write(directory.temporary_path() / "tile", "half");
  };
  Maker killed(begin_all), living(begin_all);
  killed.kill();
  fs::create_directory(of_directory / ".tmp-mine-prior");
  EXPECT_EQ(left(of_file), 2);
  EXPECT_EQ(left(of_directory), 3);
  { AtomicFile file(of_file / "a.txt", Overwrite::refuse); }
  { AtomicDirectory directory(of_directory / "prior", Overwrite::refuse, "marker"); }
  { AtomicDirectory directory(of_others / "another-prior", Overwrite::refuse, "marker"); }
  EXPECT_EQ(left(of_file), 1) << "that of the program that lives";
  EXPECT_EQ(left(of_directory), 2) << "and that of a stranger";
  EXPECT_EQ(left(of_others), 2) << "of another target";
}

TEST_F(AtomicOutputTest, ProgramsThatMakeTheSameAtOnceDoNotDisturbEachOther) {
  const fs::path target = folder_ / "shared/prior";
  constexpr int programs = 8, rounds = 50;
  std::vector<pid_t> children;
  for (int program = 0; program < programs; ++program) {
    const pid_t child = ::fork();
    if (child != 0) {
      children.push_back(child);
      continue;
    }
    for (int round = 0; round < rounds; ++round) {
      const pid_t maker = ::fork();   // a new process: each lists the folder anew
      if (maker == 0) {
        try {
          AtomicDirectory output(target, Overwrite::allow, "marker");
          write(output.temporary_path() / "marker", "whole");
          if (round % 5 == 0) ::raise(SIGKILL);
          ::_exit(read(output.temporary_path() / "marker") == "whole" ? 0 : 1);   // leaves it behind as well
        } catch (const std::exception&) {
          ::_exit(1);
        }
      }
      int status = 0;
      ::waitpid(maker, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) != 0) ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t child : children) {
    int status = 1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  { AtomicDirectory last(target, Overwrite::allow, "marker"); }
  EXPECT_TRUE(fs::is_empty(target.parent_path()));
}

TEST_F(AtomicOutputTest, InterruptionRemovesWhatIsNotCommitted) {
  AtomicDirectory directory(folder_ / "prior", Overwrite::refuse, "prior.json");
  AtomicFile file(folder_ / "a.txt", Overwrite::refuse);
  write(directory.temporary_path() / "x", "");
  priormap::discard_pending_outputs();
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
