#include <priormap/core/diagnostics.hpp>

#include <gtest/gtest.h>

using priormap::DiagnosticCode;
using priormap::Diagnostics;

TEST(DiagnosticsTest, CountsAllAndKeepsTheFirst) {
  Diagnostics diagnostics;
  for (int i = 0; i < 30; ++i) diagnostics.add(DiagnosticCode::ring_not_closed, "way/" + std::to_string(i), "open");
  diagnostics.add(DiagnosticCode::too_few_points, "way/99", "two points");
  EXPECT_EQ(diagnostics.total(), 31u);
  EXPECT_EQ(diagnostics.counts().at(DiagnosticCode::ring_not_closed), 30u);
  const auto entries = diagnostics.entries();
  ASSERT_EQ(entries.size(), Diagnostics::max_entries + 1);
  EXPECT_EQ(entries[0].feature, "way/99");
  EXPECT_EQ(entries[1].feature, "way/0");
}

TEST(DiagnosticsTest, MergingPartsInOrderEqualsOneWhole) {
  Diagnostics whole, first, second;
  for (int i = 0; i < 40; ++i) {
    whole.add(DiagnosticCode::non_planar_polygon, std::to_string(i), "");
    (i < 15 ? first : second).add(DiagnosticCode::non_planar_polygon, std::to_string(i), "");
  }
  first.merge(second);
  EXPECT_EQ(first.counts(), whole.counts());
  ASSERT_EQ(first.entries().size(), whole.entries().size());
  for (std::size_t i = 0; i < whole.entries().size(); ++i) EXPECT_EQ(first.entries()[i].feature, whole.entries()[i].feature);
}

TEST(DiagnosticsTest, RanksMakeTheOrderInWhichFeaturesComeIndifferent) {
  Diagnostics ascending, descending;
  for (std::size_t i = 0; i < 40; ++i) {
    ascending.set_rank(i);
    ascending.add(DiagnosticCode::ring_not_closed, std::to_string(i), "");
    Diagnostics one;
    one.set_rank(39 - i);
    one.add(DiagnosticCode::ring_not_closed, std::to_string(39 - i), "");
    descending.merge(one);
  }
  ASSERT_EQ(descending.entries().size(), Diagnostics::max_entries);
  EXPECT_EQ(descending.total(), 40u);
  for (std::size_t i = 0; i < Diagnostics::max_entries; ++i) EXPECT_EQ(descending.entries()[i].feature, ascending.entries()[i].feature);
}
