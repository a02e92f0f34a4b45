#include <priormap/evaluation/height_reference.hpp>

#include <gtest/gtest.h>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

struct Settled {
  std::string reference, estimate, warning, error;
};

Settled settle(const std::string& reference_crs, const std::string& estimate_crs, const std::string& assume_vertical = "") {
  Settled settled;
  Trajectory reference, estimate;
  reference.crs = reference_crs;
  estimate.crs = estimate_crs;
  Events events;
  events.warning = [&](const std::string& message) { settled.warning += message; };
  try {
    settle_heights({"truth.csv", reference}, {"out.csv", estimate}, assume_vertical, events);
  } catch (const Error& error) {
    settled.error = error.what();
  }
  settled.reference = reference.crs;
  settled.estimate = estimate.crs;
  return settled;
}

TEST(HeightReference, undeclared_beside_declared_heights_are_refused_or_warned_of_by_file) {
  EXPECT_EQ(settle("EPSG:25832+7837", "EPSG:25832").error,
            "out.csv: its heights are undeclared (EPSG:25832), those of truth.csv are in EPSG:25832+7837; say --assume-vertical EPSG:7837 if they are in it too");
  const Settled reverse = settle("EPSG:25832", "EPSG:25832+7837");
  EXPECT_EQ(reverse.error, "");
  EXPECT_EQ(reverse.warning, "truth.csv: its heights are undeclared (EPSG:25832), those of out.csv are in EPSG:25832+7837; both are compared as they are; "
                             "say --assume-vertical EPSG:7837 if they are in it too");
}

TEST(HeightReference, the_users_word_declares_the_undeclared_ones_alone) {
  for (const auto& [reference, estimate] : {std::pair{"EPSG:25832+7837", "EPSG:25832"}, {"EPSG:25832", "EPSG:25832+7837"}, {"EPSG:25832", "EPSG:25832"}}) {
    const Settled settled = settle(reference, estimate, "EPSG:7837");
    EXPECT_EQ(settled.error + settled.warning, "");
    EXPECT_EQ(settled.reference, "EPSG:25832+7837");
    EXPECT_EQ(settled.estimate, "EPSG:25832+7837");
  }
  EXPECT_EQ(settle("", "EPSG:25832", "EPSG:7837").reference, "") << "a metric frame has no CRS";
}

TEST(HeightReference, what_compares_alike_is_left_alone) {
  for (const auto& [reference, estimate] : {std::pair{"", "EPSG:25832"}, {"EPSG:25832+7837", ""}, {"EPSG:25832", "EPSG:25833"}, {"EPSG:25832+7837", "EPSG:25832+5773"}}) {
    const Settled settled = settle(reference, estimate);
    EXPECT_EQ(settled.error + settled.warning, "") << reference << " and " << estimate;
    EXPECT_EQ(settled.reference, reference);
    EXPECT_EQ(settled.estimate, estimate);
  }
}

TEST(HeightReference, an_assumption_without_use_or_sense_is_told) {
  EXPECT_NE(settle("EPSG:25832+7837", "EPSG:25832+7837", "EPSG:7837").warning.find("has no effect"), std::string::npos);
  EXPECT_NE(settle("EPSG:25832", "EPSG:25832", "EPSG:25832").error.find("is no vertical CRS"), std::string::npos);
}

}  // namespace
}  // namespace priormap
