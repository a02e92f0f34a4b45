#include <gtest/gtest.h>

#include <priormap/core/error.hpp>
#include <priormap/mapping/read_ahead.hpp>
#include <priormap/mapping/scan_source.hpp>

namespace priormap {
namespace {

class Numbers : public ScanSource {
 public:
  explicit Numbers(std::size_t bad = 1000) : bad_(bad) {}
  std::size_t size() const override { return 50; }
  Scan read(std::size_t index) const override {
    if (index == bad_) throw FormatError("scan " + std::to_string(index));
    Scan scan;
    scan.index = index;
    return scan;
  }
  double stamp_s(std::size_t index) const override { return static_cast<double>(index); }
  std::filesystem::path file(std::size_t) const override { return {}; }
  const ScanSourceInfo& info() const override { return info_; }

 private:
  std::size_t bad_;
  ScanSourceInfo info_;
};

std::function<Scan(std::size_t)> reading(const Numbers& source) {
  return [&](std::size_t index) { return source.read(index); };
}

TEST(ReadAhead, GivesEachScanOnceInOrder) {
  const Numbers source;
  ReadAhead<Scan> scans(reading(source), 3, 40, 2);
  for (std::size_t i = 3; i < 40; ++i) EXPECT_EQ(scans.next()->index, i);
  EXPECT_FALSE(scans.next());
}

TEST(ReadAhead, HandsOnWhatReadingThrewAfterTheScansBefore) {
  const Numbers source(2);
  ReadAhead<Scan> scans(reading(source), 0, 50);
  EXPECT_EQ(scans.next()->index, 0u);
  EXPECT_EQ(scans.next()->index, 1u);
  EXPECT_THROW(scans.next(), FormatError);
}

TEST(ReadAhead, CanBeLeftInTheMiddle) {
  const Numbers source;
  ReadAhead<Scan> scans(reading(source), 0, 50, 1);
  EXPECT_TRUE(scans.next());
}

}  // namespace
}  // namespace priormap
