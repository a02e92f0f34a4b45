#include <priormap/core/state_archive.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <optional>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

struct Plain {
  int number = 0;
  std::optional<double> maybe;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
};

struct Owner {
  std::string name;
  std::vector<Plain> rows;
  void exchange(StateArchive& archive) { archive(name, rows); }
};

Owner example() {
  Owner owner{"a name", {{1, 0.5, Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3))}, {2, std::nullopt, Eigen::Isometry3d::Identity()}}};
  return owner;
}

std::string bytes_of(Owner owner, int number) {
  StateArchive archive;
  archive(owner, number);
  return archive.take();
}

TEST(StateArchive, GivesBackWhatItTook) {
  StateArchive archive(bytes_of(example(), 7));
  Owner owner;
  int number = 0;
  archive(owner, number);
  archive.expect_end();
  EXPECT_EQ(number, 7);
  EXPECT_EQ(owner.name, "a name");
  ASSERT_EQ(owner.rows.size(), 2u);
  EXPECT_EQ(owner.rows[0].maybe, 0.5);
  EXPECT_EQ(owner.rows[0].T.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(owner.rows[1].maybe);
}

std::string bytes_of(std::optional<double>& value) {
  StateArchive archive;
  archive(value);
  return archive.take();
}

/// What was in it before an optional became empty does not show.
TEST(StateArchive, NothingIsTheSameBytesWhateverWasThereBefore) {
  const auto bytes_after = [](double before) {
    std::optional<double> value = before;
    EXPECT_GT(bytes_of(value).size(), sizeof(double));
    value.reset();
    return bytes_of(value);
  };
  EXPECT_EQ(bytes_after(1), bytes_after(2));
}

TEST(StateArchive, GivesBackAnOptionalAndThatThereIsNone) {
  std::optional<std::string> text = "text", none;
  StateArchive out;
  out(text, none);
  std::optional<std::string> text_again, none_again = "another";
  StateArchive in(out.take());
  in(text_again, none_again);
  in.expect_end();
  EXPECT_EQ(text_again, text);
  EXPECT_FALSE(none_again);
}

TEST(StateArchive, RefusesWhatIsCutShortOrTooLong) {
  const std::string whole = bytes_of(example(), 7);
  for (std::size_t size = 0; size < whole.size(); size += 5) {
    StateArchive archive(whole.substr(0, size));
    Owner owner;
    int number = 0;
    EXPECT_THROW(archive(owner, number), FormatError) << size;
  }
  StateArchive archive(whole);
  Owner owner;
  archive(owner);
  EXPECT_THROW(archive.expect_end(), FormatError);
}

TEST(StateArchive, RefusesAnotherLayout) {
  StateArchive archive(bytes_of(example(), 7));
  Owner owner;
  double number = 0;
  EXPECT_THROW(archive(owner, number), FormatError);
}

}  // namespace
}  // namespace priormap
