#include <priormap/core/process.hpp>

#include <gtest/gtest.h>

#include <vector>

TEST(PeakMemoryTest, GrowsByWhatIsTouchedAndDoesNotFall) {
  const auto before = priormap::peak_memory_bytes();
  if (before == 0) GTEST_SKIP() << "no /proc";
  { std::vector<char> block(64 << 20, 1); EXPECT_EQ(block.back(), 1); }
  EXPECT_GE(priormap::peak_memory_bytes(), before + (50u << 20));
}
