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
  options.bbox = {179, -18, -179, -17};
  EXPECT_NO_THROW(options.validate()) << "across the antimeridian";
  for (const std::vector<double>& bad : {std::vector<double>{7, 43, 8}, {8, 43, 7, 44}, {7, 44, 8, 44}, {7, 43, 8, HUGE_VAL}}) {
    options.bbox = bad;
    EXPECT_THROW(options.validate(), UsageError);
  }
}

TEST(PriorOptions, a_licence_that_spdx_does_not_know_is_told_of) {
  const auto warning = [](const std::string& license) {
    std::string told;
    Events events;
    events.warning = [&](const std::string& text) { told = text; };
    PriorOptions options;
    options.license = license;
    options.validate(events);
    return told;
  };
  for (const char* good : {"", "ODbL-1.0", "CC-BY-4.0", "CC-BY-SA-3.0-DE", "CC0-1.0", "DL-DE-BY-2.0", "OGL-UK-3.0", "etalab-2.0", "LicenseRef-Survey", "ODbL-1.0 AND CC-BY-4.0", "(MIT OR Apache-2.0)"})
    EXPECT_EQ(warning(good), "") << good;
  for (const char* bad : {"GPL99", "CC-BY", "CC-BY-9.0", "ODbL-1.0 XOR MIT", "free"}) EXPECT_NE(warning(bad).find("no SPDX identifier"), std::string::npos) << bad;
  EXPECT_NE(warning("odbl-1.0").find("ODbL-1.0 is one"), std::string::npos);
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
