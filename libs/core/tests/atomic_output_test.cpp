#include <priormap/core/atomic_output.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

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

TEST_F(AtomicOutputTest, InterruptionRemovesWhatIsNotCommitted) {
  AtomicDirectory directory(folder_ / "prior", Overwrite::refuse, "prior.json");
  AtomicFile file(folder_ / "a.txt", Overwrite::refuse);
  write(directory.temporary_path() / "x", "");
  priormap::discard_pending_outputs();
  EXPECT_EQ(entries(), 0u);
}

}  // namespace
