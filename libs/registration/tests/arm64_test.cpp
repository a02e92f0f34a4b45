#include <gtest/gtest.h>
#include <stdio.h>

#include <sstream>
#include <string>
#include <vector>

#include "street_drive.hpp"

using namespace priormap;

namespace {

/// Output of a command. @throws std::runtime_error when it fails
std::string output_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  char part[4096];
  while (const std::size_t size = fread(part, 1, sizeof part, pipe)) text.append(part, size);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return text;
}

std::vector<street::Registered> parse(const std::string& text) {
  std::vector<street::Registered> drive;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream numbers(line);
    street::Registered r{Eigen::Isometry3d::Identity(), Matrix6d::Zero()};
    for (int i = 0; i < 12; ++i) numbers >> r.T_map_scan(i / 4, i % 4);
    for (int i = 0; i < 36; ++i) numbers >> r.information(i / 6, i % 6);
    EXPECT_TRUE(numbers >> r.correspondences) << line;
    drive.push_back(r);
  }
  return drive;
}

class Arm64 : public testing::Test {
 protected:
  void SetUp() override {
    if (std::string(PRIORMAP_ARM64_REASON) != "") GTEST_SKIP() << PRIORMAP_ARM64_REASON;
  }
};

TEST_F(Arm64, RegistersADriveAsThisMachineDoes) {
  const auto here = street::register_drive();
  const auto there = parse(output_of(PRIORMAP_ARM64_RUN));
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t k = 0; k < here.size(); ++k) {
    EXPECT_LT(street::distance(here[k].T_map_scan, there[k].T_map_scan), 1e-3) << "scan " << k;
    EXPECT_LT(street::angle(here[k].T_map_scan, there[k].T_map_scan), 1e-5) << "scan " << k;
    EXPECT_LT((here[k].information - there[k].information).norm(), 0.02 * here[k].information.norm()) << "scan " << k;
    EXPECT_NEAR(here[k].correspondences, there[k].correspondences, 0.005 * here[k].correspondences) << "scan " << k;
  }
}

/// The vectors of the kernels are the compiler's own: that they became NEON's, and not loops over single floats, only the code tells.
TEST_F(Arm64, TheKernelsAreNeon) {
  const std::string code = output_of(PRIORMAP_ARM64_DISASSEMBLE);
  for (const char* instruction : {"fmul", "fadd", "fdiv", "fcmgt"}) {
    std::size_t vectors = 0;
    std::istringstream lines(code);
    for (std::string line; std::getline(lines, line);) vectors += line.find(instruction) != std::string::npos && line.find(".4s") != std::string::npos;
    EXPECT_GE(vectors, 2u) << instruction;
  }
}

}  // namespace
