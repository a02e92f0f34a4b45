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
