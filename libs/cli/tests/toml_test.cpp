#include "toml.hpp"

#include <gtest/gtest.h>

#include <priormap/core/error.hpp>

using priormap::UsageError;
using priormap::cli::parse_toml;
using priormap::cli::toml_string;

TEST(TomlTest, ReadsScalarsArraysAndComments) {
  const auto entries = parse_toml(
      "# heading\r\n"
      "spacing = 0.5  # metres\n"
      "source-crs = \"http://www.opengis.net/gml/srs/epsg.xml#25832\"\n"
      "path = 'C:\\data'\n"
      "bbox = [ -0.1, 51.5,\n  1_000, +2, ] # box\n"
      "\"quoted key\" = true\n"
      "text = \"a\\tb\\\"c\\u00e9\"");
  ASSERT_EQ(entries.size(), 6u);
  EXPECT_EQ(entries[0].values, std::vector<std::string>{"0.5"});
  EXPECT_EQ(entries[1].values, std::vector<std::string>{"http://www.opengis.net/gml/srs/epsg.xml#25832"});
  EXPECT_EQ(entries[2].values, std::vector<std::string>{"C:\\data"});
  EXPECT_EQ(entries[3].values, (std::vector<std::string>{"-0.1", "51.5", "1000", "2"}));
  EXPECT_EQ(entries[4].key, "quoted key");
  EXPECT_EQ(entries[5].line, 8);
  EXPECT_EQ(entries[5].values, std::vector<std::string>{"a\tb\"c\xc3\xa9"});
}

TEST(TomlTest, AnyTextSurvivesTheRoundTrip) {
  const std::string text = "EPSG \"x\" \\ ' # [1,2]\n\t\x01\x7f \xc3\xa9";
  EXPECT_EQ(parse_toml("k = " + toml_string(text)).front().values.front(), text);
}

TEST(TomlTest, FaultsNameTheLine) {
  for (const char* bad : {"a = 1\nb", "a = 1\n= 2", "a = 1\n[section]", "a = 1\na = 2", "a = 1\nb = word", "a = 1\nb = \"x",
                          "a = 1\nb = [1, 2", "a = 1\nb = 1 2", "a = 1\nb = \"\\q\"", "a = 1\nb ="}) {
    try {
      parse_toml(bad);
      ADD_FAILURE() << bad;
    } catch (const UsageError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("line 2: ")) << error.what();
    }
  }
}
