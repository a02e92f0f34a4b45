#include <priormap/core/process.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

TEST(PeakMemoryTest, GrowsByWhatIsTouchedAndDoesNotFall) {
  const auto before = priormap::peak_memory_bytes();
  if (before == 0) GTEST_SKIP() << "no /proc";
  { std::vector<char> block(64 << 20, 1); EXPECT_EQ(block.back(), 1); }
  EXPECT_GE(priormap::peak_memory_bytes(), before + (50u << 20));
}

TEST(BuildIdTest, IsTheOneThatReadelfFinds) {
  FILE* const readelf = ::popen(("readelf -n /proc/" + std::to_string(::getpid()) + "/exe 2>/dev/null").c_str(), "r");
  ASSERT_NE(readelf, nullptr);
  std::string notes;
  for (std::array<char, 256> line; std::fgets(line.data(), line.size(), readelf);) notes += line.data();
  ::pclose(readelf);
  const auto at = notes.find("Build ID: ");
  if (at == std::string::npos) GTEST_SKIP() << "no readelf, or linked without a build ID";
  EXPECT_EQ(priormap::build_id(), notes.substr(at + 10, notes.find('\n', at) - at - 10));
}
