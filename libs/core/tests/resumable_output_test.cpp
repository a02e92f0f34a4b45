#include <priormap/core/resumable_output.hpp>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

class ResumableOutputTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  ResumableDirectory begin() const { return {folder_ / "out", Overwrite::refuse, "marker"}; }
  /// A program that is killed after it kept `checkpoint`: a child, for nothing of it may run on.
  void interrupted_run(const std::string& checkpoint) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ResumableDirectory output = begin();
      std::ofstream(output.temporary_path() / "half") << "half";
      output.keep("older");
      output.keep(checkpoint);
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
  }
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_ = fs::temp_directory_path() / ("priormap_resumable_" + std::to_string(::getpid()));
};

TEST_F(ResumableOutputTest, LeavesNothingButTheDirectory) {
  {
    ResumableDirectory output = begin();
    output.keep("state");
    std::ofstream(output.temporary_path() / "marker") << "whole";
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    output.commit();
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/marker"));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ResumableOutputTest, WithoutCheckpointNothingStays) {
  { ResumableDirectory output = begin(); }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(ResumableOutputTest, GoesOnFromTheLastCheckpoint) {
  const std::string state("state\0\n\xff", 8);
  interrupted_run(state);
  ResumableDirectory output = begin();
  EXPECT_EQ(output.checkpoint(), state);
  EXPECT_TRUE(fs::is_empty(output.temporary_path()));
  output.commit();
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ResumableOutputTest, ACheckpointOutlivesAFailure) {
  { begin().keep("state"); }
  { ResumableDirectory fails_before_it_keeps_one = begin(); }
  EXPECT_EQ(begin().checkpoint(), "state");
  begin().discard_checkpoint();
  EXPECT_EQ(entries(), 0u);
}

TEST_F(ResumableOutputTest, WhatCannotBeKeptIsAnIoError) {
  fs::create_directories(folder_ / ".out.unfinished/checkpoint/in the way");
  EXPECT_THROW(begin().keep("state"), IoError);
}

TEST_F(ResumableOutputTest, ATornCheckpointIsNone) {
  interrupted_run("a long state");
  const fs::path file = folder_ / ".out.unfinished/checkpoint";
  const auto size = fs::file_size(file);
  fs::resize_file(file, size - 1);
  EXPECT_EQ(begin().checkpoint(), std::nullopt);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::app) << 'x';
  EXPECT_EQ(fs::file_size(file), size);
  EXPECT_EQ(begin().checkpoint(), std::nullopt);
  fs::resize_file(file, 5);
  EXPECT_EQ(begin().checkpoint(), std::nullopt);
  EXPECT_EQ(begin().checkpoint_file(), file);
  EXPECT_TRUE(fs::exists(file)) << "which tells it from none";
}

TEST_F(ResumableOutputTest, OneProgramAtATime) {
  ResumableDirectory output = begin();
  output.keep("state");
  EXPECT_THROW(begin(), IoError);
  EXPECT_EQ(output.checkpoint(), "state");
  EXPECT_TRUE(fs::exists(output.temporary_path()));
}

TEST_F(ResumableOutputTest, AnInterruptionBySignalKeepsTheCheckpointAlone) {
  ResumableDirectory output = begin();
  discard_pending_outputs();
  EXPECT_EQ(entries(), 0u);
  ResumableDirectory again = begin();
  again.keep("state");
  discard_pending_outputs();
  EXPECT_FALSE(fs::exists(again.temporary_path()));
  EXPECT_EQ(again.checkpoint(), "state");
}

}  // namespace
}  // namespace priormap
