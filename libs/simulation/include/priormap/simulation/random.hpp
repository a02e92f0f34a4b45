#pragma once
#include <cstdint>
#include <initializer_list>

namespace priormap {

/// Random numbers of one named stream: they depend on the seed and the stream's name alone, so that a tree's numbers do not
/// move when a car is added, nor with the number of threads. SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  Random(std::uint64_t seed, std::initializer_list<std::uint64_t> stream);

  std::uint64_t next();
  double uniform();                                ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  double normal();                                 ///< mean 0, variance 1
  /// Mean 0, variance 1, bounded by 3.46: sum of four uniforms (Irwin-Hall). For the millions of a scan.
  float quick_normal();

 private:
  std::uint64_t state_;
};

}  // namespace priormap
