#include <priormap/builder/prior_options.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

TEST(PriorOptions, a_bbox_is_four_numbers_with_extent) {
  PriorOptions options;
  EXPECT_NO_THROW(options.validate());
  options.bbox = {7, 43, 8, 44};
  EXPECT_NO_THROW(options.validate());
  for (const std::vector<double>& bad : {std::vector<double>{7, 43, 8}, {8, 43, 7, 44}, {7, 44, 8, 44}, {7, 43, 8, HUGE_VAL}}) {
    options.bbox = bad;
    EXPECT_THROW(options.validate(), UsageError);
  }
}

TEST(PriorOptions, a_date_is_a_day_of_the_calendar) {
  PriorOptions options;
  for (const char* good : {"2024-02-29", "1999-12-31"}) {
    options.date = good;
    EXPECT_NO_THROW(options.validate());
  }
  for (const char* bad : {"2023-02-29", "2023-13-01", "23-1-1", "2023-01-01T00:00", "today"}) {
    options.date = bad;
    EXPECT_THROW(options.validate(), UsageError) << bad;
  }
}

}  // namespace
}  // namespace priormap
