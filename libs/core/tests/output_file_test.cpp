#include <priormap/core/output_file.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include <priormap/core/error.hpp>

using priormap::IoError;
using priormap::OutputFile;

TEST(OutputFileTest, WritesSmallAndLargeBlocksInOrderAndSeeks) {
  const auto file = std::filesystem::temp_directory_path() / ("priormap_output_" + std::to_string(::getpid()));
  std::string expected;
  {
    OutputFile out(file);
    for (int i = 0; i < 20000; ++i) {
      const std::string text = std::to_string(i) + (i == 5000 ? std::string(200000, 'x') : "");
      out << text << '\n';
      expected += text + '\n';
    }
    EXPECT_EQ(out.tellp(), static_cast<std::streamoff>(expected.size()));
    out.seekp(0);
    out << "A";
    out.seekp(0, std::ios::end);
    out << "Z";
    out.close();
  }
  expected[0] = 'A';
  expected += "Z";
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), expected);
  std::filesystem::remove(file);
}

TEST(OutputFileTest, FullDiskIsAnErrorThatNamesTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  OutputFile buffered("/dev/full");
  buffered << "x";
  try {
    buffered.close();
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: cannot be written: No space left"), std::string::npos) << error.what();
  }
  OutputFile large("/dev/full");
  const std::string block(1 << 20, 'x');
  EXPECT_THROW(large.write(block.data(), static_cast<std::streamsize>(block.size())), IoError);
}

TEST(OutputFileTest, UncreatableFileIsAnIoError) { EXPECT_THROW(OutputFile("/nonexistent/a"), IoError); }
