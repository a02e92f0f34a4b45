#include <priormap/core/hash.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include <priormap/core/error.hpp>

using priormap::Sha256;

// Digests of FIPS 180-4's examples.
TEST(Sha256Test, AgreesWithTheStandardsExamples) {
  Sha256 empty;
  EXPECT_EQ(empty.hex_digest(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  Sha256 abc;
  abc.update("a");
  abc.update("bc");
  EXPECT_EQ(abc.hex_digest(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256Test, FileEqualsItsBytes) {
  const auto file = std::filesystem::temp_directory_path() / ("priormap_hash_" + std::to_string(::getpid()));
  const std::string million(1000000, 'a');
  std::ofstream(file) << million;
  EXPECT_EQ(priormap::sha256_file(file), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  std::filesystem::remove(file);
}

TEST(Sha256Test, UnreadableFileIsAnIoError) {
  EXPECT_THROW(priormap::sha256_file("/nonexistent/file"), priormap::IoError);
  EXPECT_THROW(priormap::sha256_file("/"), priormap::IoError);
}
